"""Compare what builds of arm3r for several platforms computed, to the last bit.

    python tests/c/compare_bits.py NATIVE.txt OTHER.txt...

Each file is what bits.c printed on a platform, which the file is named for. The first one is what the others are held
against. Prints a table in Markdown, a line for each platform. Exit code 0: all hashes are equal; 1: one differs or is
missing, which is named below the table.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Output:
    """What bits.c printed: the hashes of each scenario, of its run and, where there is one, of its batch."""

    platform: str
    build: str
    hashes: dict[str, list[str]]

    @classmethod
    def read(cls, path: Path) -> Output:
        """ValueError: the file is not the output of bits.c."""
        head, *lines = path.read_text().splitlines() or [""]
        hashes = {name: values for name, *values in map(str.split, lines)}
        if not head.startswith("# ") or not hashes or not all(len(values) in (1, 2) for values in hashes.values()):
            raise ValueError(f"{path} is not the output of bits.c")
        return cls(path.stem, head.removeprefix("# "), hashes)

    def hash_of(self, scenario: str, which: int) -> str:
        return dict(enumerate(self.hashes.get(scenario, []))).get(which, "missing")


def main(paths: list[str]) -> int:
    if len(paths) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    reference, *others = [Output.read(Path(path)) for path in paths]
    differences = {other.platform: compare(reference, other) for other in others}
    rows = [row(output, reference, differences.get(output.platform, [])) for output in (reference, *others)]
    print("| platform | runs equal | batches equal | version and compiler |", "|---|---|---|---|", *rows, sep="\n")
    for platform, lines in differences.items():
        print(*(f"{platform}: {line}" for line in lines), sep="\n", end="\n" if lines else "")
    return int(any(differences.values()))


def compare(reference: Output, other: Output) -> list[str]:
    """What differs, a line for each hash. A scenario of `other` alone counts as well."""
    lines = [
        f"{scenario}: {('run', 'batch')[which]} {other.hash_of(scenario, which)}, not {expected}"
        for scenario, values in reference.hashes.items()
        for which, expected in enumerate(values)
        if other.hash_of(scenario, which) != expected
    ]
    return lines + [f"{scenario}: not in {reference.platform}" for scenario in other.hashes.keys() - reference.hashes]


def row(output: Output, reference: Output, differences: list[str]) -> str:
    cells = []
    for which, word in enumerate(("run", "batch")):
        count = sum(len(values) > which for values in reference.hashes.values())
        different = sum(f": {word} " in line for line in differences)
        cells.append(f"{count - different} of {count}")
    return f"| {output.platform} | {' | '.join(cells)} | {output.build.replace('|', '·')} |"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
