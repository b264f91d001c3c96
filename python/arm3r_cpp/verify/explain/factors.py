"""The factors by which all of a result may be wrong, and what is said of each."""

import numpy as np

FACTORS: dict[float, str] = {
    -1.0: "has the wrong sign",
    180 / np.pi: "is in degrees; it should be in radians",
    2.0: "is twice what it should be",
    0.5: "is half of what it should be",
    1e3: "is 1000 times what it should be: millimetres?",
    1e-3: "is a thousandth of what it should be",
    1e6: "is 1e6 times what it should be: millimetres?",
    np.pi / 180: "is pi/180 times what it should be: per degree?",
}
"""By factor: what follows "the result"."""
