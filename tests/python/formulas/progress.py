"""The state of long counts: one that was interrupted goes on where it stopped, with its own seed."""

from __future__ import annotations

import hashlib
import json
import os
import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from arm3r_cpp import verify

FOLDER = Path(__file__).parents[3] / "build" / "gates"


class Progress:
    """Random draws that are counted, each with a generator of its own.

    With a name its state is kept in a file after every draw. It goes on from there if the package and the seed are
    the same; no ARM3R_SEED means the seed of the interrupted count.
    """

    def __init__(self, seed: int, name: str = "") -> None:
        self.seed, self.done = seed, 0
        self.outcomes: Counter[str] = Counter()
        self._file = FOLDER / f"{name}.json" if name else None
        self._code = _hash_of_the_package() if name else ""
        if self._file and self._file.exists():
            self._load(json.loads(self._file.read_text()))
        print(f"ARM3R_SEED={self.seed}" + (f" from draw {self.done}" if self.done else ""))

    def _load(self, state: dict[str, object]) -> None:
        is_given = "ARM3R_SEED" in os.environ
        if state["code"] == self._code and (not is_given or state["seed"] == self.seed):
            self.seed, self.done, self.outcomes = state["seed"], state["done"], Counter(state["outcomes"])  # type: ignore

    def draws(self) -> Iterator[random.Random]:
        """A generator for each draw; what the caller counted in it is kept when it asks for the next one."""
        while True:
            yield random.Random(f"{self.seed} {self.done}")
            self.done += 1
            if self._file:
                self._file.parent.mkdir(parents=True, exist_ok=True)
                state = {"seed": self.seed, "done": self.done, "outcomes": self.outcomes, "code": self._code}
                self._file.write_text(json.dumps(state))

    def finish(self) -> Counter[str]:
        """Print the counts and forget the state."""
        print(dict(self.outcomes))
        if self._file:
            self._file.unlink(missing_ok=True)
        return self.outcomes


def _hash_of_the_package() -> str:
    folder = Path(str(verify.__file__)).parent
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(folder.rglob("*.py")))).hexdigest()
