"""MATLAB files as Octave runs them, against the numbers that `verify` reads in their text."""

from __future__ import annotations

import random
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp.user_functions.matlab.program import MatlabProgram
from arm3r_cpp.user_functions.programs import Call, ProgramError
from formulas.mutants import matlab_mutants
from formulas.programs import PROGRAMS

OCTAVE = shutil.which("octave-cli")
STUDENTS = Path(__file__).parents[1] / "formulas" / "students"
FILES = {path.name: path.read_text() for path in sorted(STUDENTS.glob("*/*.m"))}
LISTINGS = {one.name: one.text for one in PROGRAMS if one.language == "matlab"}
STATES = np.random.default_rng(3).uniform(-2.5, 2.5, (4, 9))


def by_octave(text: str, program: MatlabProgram, folder: Path) -> Any:
    """What Octave returns at the states, (states, numbers), column by column; None where it fails."""
    name = program.function
    (folder / f"{name}.m").write_text(text)
    outputs = [f"o{n}" for n in range(len(program.outputs))]
    vectors = len(program.arguments) < 3 or program.arguments == ["q", "qd", "tau"]
    lines = []
    for state in STATES:
        given = [f"[{';'.join(map(repr, map(float, state[3 * n : 3 * n + 3])))}]" if vectors else repr(float(state[n]))
                 for n in range(len(program.arguments))]  # fmt: skip
        lines.append(f"[{', '.join(outputs)}] = {name}({', '.join(given)});")
        lines.append(f"printf('%.17g ', [{'; '.join(f'{one}(:)' for one in outputs)}]); printf('\\n');")
    done = subprocess.run(
        [str(OCTAVE), "--no-gui", "--quiet", "--norc", "--eval", "\n".join([f"addpath('{folder}');", *lines])],
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    return np.array([line.split() for line in done.stdout.splitlines()], float) if done.returncode == 0 else None


def by_verify(program: MatlabProgram) -> Any:
    vectors = len(program.arguments) < 3 or program.arguments == ["q", "qd", "tau"]
    slots = tuple(tuple(range(3 * n, 3 * n + 3)) if vectors else n for n in range(len(program.arguments)))
    try:
        values = program.evaluate(Call(slots, {}), STATES)
    except ProgramError:
        return None
    return np.swapaxes(values, 1, values.ndim - 1).reshape(len(STATES), -1)


@pytest.mark.sample(4)
@pytest.mark.needs("octave")
@pytest.mark.parametrize("name", [*FILES, *LISTINGS])
def test_octave_returns_the_same(name: str, tmp_path: Path) -> None:
    text = {**FILES, **LISTINGS}[name]
    mutants = random.Random(1).sample(matlab_mutants(text), 2)
    for number, one in enumerate([text, *mutants]):
        folder = tmp_path / f"n{number}"
        folder.mkdir()
        program = MatlabProgram(one, name)
        theirs, ours = by_octave(one, program, folder), by_verify(program)
        assert (theirs is None) == (ours is None), one
        if ours is not None:
            assert np.allclose(theirs, ours, rtol=1e-12, atol=1e-12, equal_nan=True), one
