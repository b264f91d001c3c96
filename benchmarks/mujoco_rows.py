"""The rows of a MuJoCo run as CSV, as the programs here write them that stand for what one would write oneself."""

from __future__ import annotations

import csv
from collections.abc import Sequence

import numpy as np


def write(path: str, header: Sequence[str], rows: np.ndarray) -> None:
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows.tolist())
