"""A function of a user's file: how it is read, and the law that it becomes for an arm."""

from __future__ import annotations

import builtins
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from ..errors import ControllerError, UsageError
from ..user_functions.matlab.program import MatlabProgram
from ..user_functions.python_nodes import PythonText
from ..user_functions.python_program import callable_of
from ..verify.formula import Formula, from_file, from_text, split_name
from ..verify.truth.three_r import ThreeR
from .inputs import Input, check_numbers, input_of, is_angle, numbers_of_arm
from .law import BlockLaw, Place, failure

if TYPE_CHECKING:
    from ..core.scenario import Scenario


class Block:
    """A function of a MATLAB or Python file that computes a torque.

    Attributes:
        file: as it was given.
        text: of the file.
        function: its name.
        arguments: their names, in order.
        line: of the file, where the function begins.
    """

    def __init__(self, file: str, text: str, function: str) -> None:
        """
        Raises:
            UsageError: the text cannot be read, has no such function, or an argument is not known.
        """
        self.file, self.text, self.function = file, text, function
        formula = from_text(text, file, function, folder=_folder_of(file))
        self.arguments = formula.arguments
        program = formula.program
        if isinstance(program, MatlabProgram):
            self.line = program.functions[function].line
            self._with_default: set[str] = set()
            check_numbers([name for name in self.arguments if name == "state"], f"{file}:{self.line}")
        else:
            self.line = PythonText(text, file).line(formula.name)
            self._with_default = set(formula.optional)
            if self.arguments == ["*"]:  # the file may fail before it makes a function: this says why
                self._executed()
        check_numbers(self._of_arm, f"{file}:{self.line}")

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Block:
        """The function in FILE.m, FILE.py, FILE.m:FUNCTION or FILE.py:FUNCTION; without a name the likely one.

        Raises:
            UsageError: the file cannot be read, or as above.
        """
        file, _ = split_name(os.fspath(path))
        if not file.endswith((".m", ".py")):
            raise UsageError(f"{file}: a controller is a function in a file named .m or .py", code="usage")
        formula = from_file(path)
        return cls(file, formula.text or "", formula.name)

    def __reduce__(self) -> tuple[Any, ...]:
        return Block, (self.file, self.text, self.function)

    def __str__(self) -> str:
        return f"{self.file}: {self.function}({', '.join(self.arguments)})"

    @property
    def _place(self) -> Place:
        return Place(self.file, self.line, self.function)

    @cached_property
    def _of_arm(self) -> list[str]:
        """The arguments that are numbers of the arm; those with a default keep it."""
        return [name for name in self.arguments if input_of(name) is None and name not in self._with_default]

    @property
    def is_gravity(self) -> bool:
        """Whether it depends on the joint angles alone, as a gravity torque does."""
        states = [name for name in self.arguments if input_of(name)]
        return bool(states) and all(map(is_angle, states))

    def law(self, scenario: Scenario) -> BlockLaw:
        """The law of one run of the scenario. A Python file is executed anew, so that no run knows another one.

        Raises:
            ControllerError: the file raised when it was executed.
        """
        numbers = numbers_of_arm(self._of_arm, ThreeR(scenario).values_of_quantities) if self._of_arm else {}
        given: dict[str, Input] = {name: _constant(number) for name, number in numbers.items()}
        given |= {name: found for name in self.arguments if (found := input_of(name))}
        inputs = {name: given[name] for name in self.arguments if name in given}
        formula = from_text(self.text, self.file, self.function, folder=_folder_of(self.file))
        return BlockLaw(self._place, self._caller(formula, inputs), formula.order)

    def _caller(self, formula: Formula, inputs: Mapping[str, Input]) -> Callable[[Any], Any]:
        if isinstance(formula.program, MatlabProgram):
            return _matlab(formula.program, inputs)
        function = self._executed()
        first = list(takewhile(inputs.__contains__, self.arguments))
        behind = [name for name in inputs if name not in first]

        def call(state: Any) -> Any:
            return function(*(inputs[name](state) for name in first), **{name: inputs[name](state) for name in behind})

        return call

    def _executed(self) -> Any:
        """The function, of a new execution of the file."""
        namespace = {"__name__": "__block__", "__file__": self.file, "__builtins__": builtins}
        try:
            with _importing_from(_folder_of(self.file)):
                exec(compile(self.text, self.file, "exec", dont_inherit=True), namespace)
                return callable_of(namespace, self.function)
        except (Exception, SystemExit) as error:
            raise ControllerError(failure(self._place, error), code="run.controller") from error


def _folder_of(file: str) -> str:
    return os.path.dirname(os.path.abspath(file))


def _constant(number: float) -> Input:
    return lambda state: number


def _matlab(program: MatlabProgram, inputs: Mapping[str, Input]) -> Callable[[Any], Any]:
    def call(state: Any) -> Any:
        outputs = program.call(*(take(state) for take in inputs.values()))
        return outputs[0] if len(outputs) == 1 else outputs

    return call


@contextmanager
def _importing_from(folder: str) -> Iterator[None]:
    """Imports find modules beside the file."""
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)
