"""Press with 20 N on a wall that comes, and say how far the number can be trusted."""

import arm3r_cpp as arm3r

scenario = arm3r.Scenario.example("force_control/hybrid_first_contact")
scenario["reference.force.value"] = 20
run = scenario.run(trust=True)
metrics = run.summary["metrics"]
print(f"final force {metrics['final_force']:.4f} N, largest {metrics['peak_force']:.3f} N")
print(f"the angles are right to 1e-6 rad up to t = {run.trust.horizon:g} s")
