"""The gain with the smallest first peak of force, of a thousand hybrid controllers, in one batch."""

import arm3r_cpp as arm3r
import numpy as np

scenario = arm3r.Scenario.example("force_control/hybrid_first_contact")
scenario["time.stop"] = 7
damping = np.linspace(30, 300, 1000)  # N s/m
batch = scenario.batch({"controller.force_damping": damping}, metrics=["first_contact_peak"], progress=False)
best = np.argmin(batch["first_contact_peak"])
print(f"force_damping {damping[best]:.0f} N s/m: a first peak of {batch['first_contact_peak'][best]:.2f} N")
