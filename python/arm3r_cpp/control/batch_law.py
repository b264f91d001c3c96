"""Control laws that users write, as `Scenario.batch` takes them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _native
from ..errors import ControllerError, UsageError
from .law import Law, LawAdapter, NativeLaw, cause_of, check_native, name_of, why_it_failed

Index = int | tuple[int, ...]
MakeLaw = Callable[[Any], Law]


class BatchLaw:
    """The law of each run of a batch."""

    def __init__(
        self, controller: Law | NativeLaw | None, make_controller: MakeLaw | None, shape: tuple[int, ...], file: str
    ) -> None:
        """
        Args:
            controller: a law for all runs; or None.
            make_controller: makes the law of a run, of which it gets the index; or None.
            shape: of the batch.
            file: the scenario's name in messages.

        Raises:
            UsageError: not one of both, or not a function.
        """
        if (controller is None) == (make_controller is None):
            raise UsageError("controller, make_controller: give one of them, not both", code="usage")
        if isinstance(make_controller, NativeLaw):
            raise UsageError("make_controller: a function of an index is needed; see NativeLaw.stride", code="usage")
        if isinstance(controller, NativeLaw):
            check_native(controller)
        elif not callable(controller or make_controller):
            raise UsageError(f"controller: a function of (t, state) is needed, got {controller!r}", code="usage")
        self._controller, self._file = controller, file
        self._make: Any = make_controller
        self._numbers = np.arange(math.prod(shape)).reshape(shape)

    def of_run(self, index: Index) -> Law | NativeLaw:
        """The law of a run alone. index: as for a column."""
        return self._of(self._index(self._numbers[index]))

    def _of(self, index: tuple[int, ...]) -> Law | NativeLaw:
        if isinstance(self._controller, NativeLaw):
            law = self._controller
            return law._replace(user=law.user + law.stride * int(self._numbers[index]))
        if self._controller:
            return self._controller
        made = self._make(index[0] if len(index) == 1 else index)
        if isinstance(made, NativeLaw) or not callable(made):
            raise UsageError(f"make_controller: it made {made!r}; a function of (t, state) is needed", code="usage")
        return made

    def groups(self, groups: Sequence[Any]) -> list[NDArray[np.intp]]:
        """The runs of each call of `table`: where each run has its own address, they follow each other."""
        runs = [self._numbers.ravel()[group] for group in groups]
        if not (isinstance(self._controller, NativeLaw) and self._controller.stride):
            return runs
        return [part for group in runs for part in np.split(group, np.flatnonzero(np.diff(group) != 1) + 1)]

    def table(self, runs: NDArray[np.intp], *given: Any, **options: Any) -> _native.Floats:
        """The table of some runs of the batch. `given` and `options`: as `_native.batch` takes them.

        Raises:
            ControllerError: a law in Python raised, or returned no torque; the message names the run.
        """
        if isinstance(self._controller, NativeLaw):
            first = int(runs[0]) if runs.size else 0
            law = self._controller._replace(user=self._controller.user + self._controller.stride * first)
            return _native.batch(*given, law=law, **options)[0]
        caller = _Caller(lambda run: self._of(self._index(runs[run])))
        table, raised = _native.batch(*given, law=caller, **options)
        if raised is None:
            return table
        if not isinstance(raised, Exception):
            raise raised
        raise self._failure(caller, self._index(runs[caller.run]), raised) from cause_of(raised)

    def _index(self, run: np.intp) -> tuple[int, ...]:
        return tuple(int(places[0]) for places in np.nonzero(self._numbers == run)) if self._numbers.shape else ()

    def _failure(self, caller: _Caller, index: tuple[int, ...], raised: Exception) -> ControllerError:
        place = f"{self._file}: controller: run {index[0] if len(index) == 1 else index}"
        adapter = caller.adapter
        if adapter is None:
            why = f"{name_of(self._make)} raised {type(raised).__name__}: {raised}"
            return ControllerError(f"{place}: {why}", code="run.controller", index=index)
        why = why_it_failed(adapter, adapter.law, raised)
        return ControllerError(
            f"{place}, at tick {adapter.tick}, t = {adapter.t:.12g} s: {why}",
            code="run.controller",
            index=index,
            tick=adapter.tick,
            t=adapter.t,
            received=adapter.received,
        )


class _Caller:
    """Calls the laws of runs that come one after the other: each run has a new law."""

    def __init__(self, law_of: Callable[[int], Any]) -> None:
        self._law_of = law_of
        self.run = -1
        self.adapter: LawAdapter | None = None

    def __call__(self, run: int, struct: Any, tau: Any) -> int:
        if run != self.run:
            self.run, self.adapter = run, None
            self.adapter = LawAdapter(self._law_of(run), _native.StateMemory(struct))
        assert self.adapter is not None
        _native.put_torque(self.adapter.answer(struct.t), tau)
        return 0
