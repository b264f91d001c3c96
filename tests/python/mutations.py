"""Files as they are after an accident: bytes, lines and numbers of them changed at random."""

from __future__ import annotations

import random

NUMBERS = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-1e300",
    "1e-320",
    "",
    "0",
    "-1",
    "..",
    "1.2.3",
    "pi/0",
    "9" * 400,
    "1_0",
    "\0",
]


def mutated(data: bytes, chance: random.Random) -> bytes:
    """With some of: bytes flipped, a part cut or doubled, lines swapped, numbers replaced, another encoding."""
    for _ in range(chance.randint(1, 4)):
        data = mutated_once(data, chance)[:300_000]
    return data


def mutated_once(data: bytes, chance: random.Random) -> bytes:
    at, to = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    lines = data.split(b"\n")
    digits = [i for i, c in enumerate(data) if chr(c).isdigit()]
    place = chance.choice(digits) if digits else 0
    match chance.randrange(6):
        case 0:
            return data[:at] + bytes([chance.randrange(256)]) + data[at + 1 :]
        case 1:
            return data[:at] + data[to:]
        case 2:
            return data[:to] + data[at:to] * chance.randint(1, 50) + data[to:]
        case 3:
            return b"\n".join(chance.sample(lines, len(lines)))
        case 4:
            return data[:place] + chance.choice(NUMBERS).encode() + data[place + 1 :]
        case _:
            return data.decode("latin-1").encode(chance.choice(["utf-16", "utf-8", "utf-8-sig", "utf-32"]))
