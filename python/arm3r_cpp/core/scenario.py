"""Scenarios: what is simulated, as text, by path, and as numbers."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from .. import _native
from .._messages import describe, warn_user
from .._native import BatchProgress, Floats, Progress, lib
from .._progress_bar import shown
from ..answers.meant_names import Answering, no_attribute
from ..control.law import Law, NativeLaw, check_rate, check_time_limit, run_with_law
from ..errors import Arm3rError, ScenarioError, ScenarioWarning, UsageError, class_of_outcome
from ..examples import FOLDER, is_sweep, path_of
from .arm import Arm
from .batch import Batch, run_batch
from .comparison import Beside
from .flow import flow
from .params import numbers_of, places
from .provided import provided
from .run import Run

if TYPE_CHECKING:
    from ..control.batch_law import MakeLaw


class Scenario(metaclass=Answering):
    """A scenario: read from YAML, changed by path, validated and run by the library.

    >>> scenario = Scenario.example("moving_wall")
    >>> scenario["wall.contact.stiffness"] = 500
    >>> run = scenario.run()

    Attributes:
        file: its name in messages.
        handle: the library's own `arm3r_scenario *`.
    """

    def __init__(self, text: str = "format: 1\n", *, file: str = "scenario.yaml") -> None:
        """Read a scenario from text; `file` is its name in messages.

        Raises:
            ScenarioError: the text cannot be read as YAML of the kind allowed; what it says is judged when it is used.
            UsageError: the text is the name of a file.
        """
        texts = (*_native.utf8(text, "text"), *_native.utf8(file, "file"))
        if os.path.isfile(text):
            raise UsageError(f"text: a file's name instead of a scenario; use Scenario.load({text!r})", code="usage")
        self.file = file
        self._warned: set[str] | None = set()
        self.handle = _native.create("scenario", lib.arm3r_scenario_create, *texts)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scenario:
        """Read a scenario from a file.

        Raises:
            UsageError: the file cannot be read.
            ScenarioError: as for a text.
        """
        return cls.of_handle(
            _native.create("scenario", lib.arm3r_scenario_load, *_native.file_path(path)), os.fspath(path)
        )

    @classmethod
    def example(cls, name: str) -> Scenario:
        """A scenario that is installed with the package, such as "moving_wall" or "lecture/05_free_fall".

        The command `arm3r examples` lists them.

        Raises:
            UsageError: there is no such scenario; the message names the nearest one.
        """
        path = path_of(name)
        if is_sweep(path.relative_to(FOLDER).as_posix()):
            raise UsageError(f"{name}: is a sweep; arm3r.sweep({str(path)!r}, out=...) runs it", code="usage")
        return cls.load(path)

    @classmethod
    def of_handle(cls, handle: Any, file: str) -> Scenario:
        """The scenario that the library holds; handle: its `arm3r_scenario *`, file: its name in messages."""
        scenario = cls.__new__(cls)
        scenario.handle, scenario.file, scenario._warned = handle, file, set()
        return scenario

    def copy(self) -> Scenario:
        """An independent copy."""
        copy = self.of_handle(_native.create("scenario", lib.arm3r_scenario_copy, self.handle), self.file)
        copy._warned = None if self._warned is None else set(self._warned)
        return copy

    def __copy__(self) -> Scenario:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Scenario:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self.to_yaml(), self.file)

    def __repr__(self) -> str:
        return f"<Scenario {self.file}>"

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            is_section = any(place.partition(".")[0] == name for place in places())
            meant = f'scenario["{name}"], or of a key in it scenario["{name}.KEY"]' if is_section else ""
            raise no_attribute("Scenario", name, dir(Scenario), meant=meant)

    def __getitem__(self, path: str) -> Any:
        """The value at a dotted path, defaults included, list items by [i]: "wall.contact.stiffness", "initial.q[1]".

        None stands for what is absent; maps leave it out. Putting back what was read changes nothing.

        Raises:
            UsageError: there is no such key; the message names the nearest one.
            ScenarioError: the scenario is not valid.
        """
        found = _native.text(lib.arm3r_scenario_get, self.handle, *_native.utf8(path, "path"))
        return _plain(json.loads(found, parse_float=_number))

    def __setitem__(self, path: str, value: Any) -> None:
        """Put a number, text, flag, list, array or map at a path; its value is validated when it is next used.

        Angles may be given as text: "30 deg". A new type, method or law drops the keys of the old one. None takes away
        what is there: the default holds again.

        Raises:
            TypeError: the value is none of these, or the path is not text.
            ScenarioError: there is no such key, at the path or in a map; the message names the nearest one, and the
                scenario is as it was.
        """
        changed = self._changed({path: value})
        if path not in places() or isinstance(value, Mapping):
            changed._check_keys(path)
        self._take(changed)

    def update(self, values: Mapping[str, Any]) -> None:
        """Put several values, by path, and validate them together: all of them or, where an error is raised, none.

        >>> scenario.update({"controller": {"type": "user"}, "sampling": {"rate": 500, "delay": 0.002}})

        A map takes the place of the whole section. The values are put one after the other, as by `scenario[path]`.

        Raises:
            TypeError: `values` is no map, or a value or a path is of a wrong type.
            ScenarioError: the scenario would not be valid; it is as it was.
        """
        if not isinstance(values, Mapping):
            raise TypeError(f"values: a map of values by path is needed, got {type(values).__name__}")
        changed = self._changed(values)
        _native.call(lib.arm3r_scenario_validate, changed.handle)
        self._take(changed)

    def _take(self, changed: Scenario) -> None:
        self.handle, self._warned = changed.handle, None if self._warned is None else set()

    def _changed(self, values: Mapping[str, Any]) -> Scenario:
        """A copy with other values, not validated."""
        changed = self.copy()
        for path, value in values.items():
            place = _native.utf8(path, "path")
            _native.call(lib.arm3r_scenario_set, changed.handle, *place, *_native.utf8(flow(value, path), path))
        return changed

    def _check_keys(self, path: str) -> None:
        """ScenarioError: a key on the way to a path, at it or below it, exists under no choice."""
        try:
            _native.text(lib.arm3r_scenario_name, self.handle)
        except Arm3rError as error:
            unknown = [
                problem
                for problem in error.problems
                if problem["code"] == "scenario.unknown_key"
                and (_is_part(problem["path"], path) or _is_part(path, problem["path"]))
            ]
            if unknown:
                message = "\n".join(map(describe, unknown))
                raise ScenarioError(message, status=error.status, code=error.code, problems=unknown) from None

    def set_from_option(self, text: str) -> None:
        """Put a value given as "PATH=VALUE" with VALUE in YAML, as the commands' option --set takes it.

        Raises:
            UsageError: there is no "=".
        """
        path, equals, value = text.partition("=")
        if not (path and equals):
            raise UsageError(f"--set {text}: PATH=VALUE is needed, such as time.stop=5", code="usage")
        self.edit(path, value, "--set")

    def edit(self, path: str, value: str, origin: str) -> None:
        """Put YAML text at a path; messages call the place it came from `origin`."""
        texts = [part for word in (path, value, origin) for part in _native.utf8(word, path)]
        _native.call(lib.arm3r_scenario_set_from, self.handle, *texts)
        self._take(self)

    def __contains__(self, path: str) -> bool:
        """Whether there is a value at a path, a default included.

        Raises:
            ScenarioError: the scenario is not valid.
        """
        try:
            return self[path] is not None
        except UsageError:
            return False

    def validate(self) -> None:
        """Raise ScenarioError, listing all problems, unless the scenario is valid.

        What is allowed but probably a mistake is issued as ScenarioWarning, once for each state of the scenario.
        """
        _native.call(lib.arm3r_scenario_validate, self.handle)
        self.warn_of_itself()

    @property
    def warnings(self) -> list[str]:
        """What is allowed in this scenario but probably a mistake, a sentence each. It must be valid."""
        lines = _native.text(lib.arm3r_scenario_warnings, self.handle).splitlines()
        return [line.partition(": warning: ")[2] for line in lines]

    def warn_of_itself(self) -> None:
        """Issue what `warnings` has. ScenarioError: it is not valid."""
        if self._warned is not None:  # a quiet one need not look for them
            self.warn(self.warnings)

    def warn(self, sentences: Iterable[str]) -> None:
        """Issue the warnings that this state of the scenario has not yet led to."""
        for sentence in sentences:
            if self._warned is not None and sentence not in self._warned:
                warn_user(f"{self.file}: {sentence}", ScenarioWarning)
                self._warned.add(sentence)

    @property
    def is_quiet(self) -> bool:
        """Whether it issues no warnings."""
        return self._warned is None

    def quiet(self) -> Scenario:
        """This scenario, which issues no warnings from now on, and neither do its copies."""
        self._warned = None
        return self

    def _repr_html_(self) -> str:
        return str(provided("page of a scenario")(self))

    def _ipython_key_completions_(self) -> list[str]:
        return sorted({part for path in places() for part in _sections(path)} | {"name", "checks"})

    @property
    def name(self) -> str:
        """Its `name`, by default the file's stem."""
        return _native.text(lib.arm3r_scenario_name, self.handle)

    @property
    def params(self) -> Floats:
        """All numbers of the scenario: shape (param_count(),), SI units and radians; see `param_index`.

        Lists of a table with more than 16 points stand behind them: index of the key's first number, length, numbers.
        """
        return numbers_of(self.handle)

    @property
    def arm(self) -> Arm:
        """The arm it describes."""
        return Arm(self.params)

    def to_yaml(self, *, annotate: bool = False) -> str:
        """The whole scenario with all defaults, itself a scenario; `annotate`: each value's origin in a comment."""
        return _native.text(lib.arm3r_scenario_yaml, self.handle, bool(annotate))

    def run(
        self,
        *,
        controller: Law | NativeLaw | str | os.PathLike[str] | None = None,
        rate: float | None = None,
        progress: Progress | None = None,
        time_limit: float | None = None,
        trust: bool = False,
    ) -> Run:
        """Simulate. Ctrl-C ends the run at once with KeyboardInterrupt.

        What is allowed in the scenario but probably a mistake is issued as ScenarioWarning, and so is what only the run
        shows, such as a link that moves through the wall.

        >>> run = scenario.run(controller=lambda t, state: state.tau_g - 5 * state.qd)

        Args:
            controller: a law of your own instead of the scenario's, controller(t, state) -> three torques, N m. It is
                called once at each sample, in increasing time, and its torque held until the next. Or a function in a
                file, "my_law.m" or "my_law.py:f"; `arm3r docs control` says what its arguments get. `run_beside` runs
                the scenario's own controller, too.
            rate: of its samples, Hz; None: the scenario's sampling.rate, by default 1000.
            progress: called as progress(t, stop, steps) at most every 20 ms; a true result stops the run, and what it
                raises comes out unchanged.
            time_limit: s of wall clock.
            trust: whether `run.trust` is to say up to when the joint angles are right; it takes three more runs, each
                of them longer and within `time_limit`. Not with a controller of your own, which may have a memory.

        Raises:
            ScenarioError: the scenario is not valid.
            ControllerError: the controller raised, which is then its `__cause__`, or returned no torque; `error.tick`,
                `error.t`, `error.received` and `error.run` say more.
            UsageError: the controller's file cannot be read, or an argument of its function is not known.
            NumericalError, BudgetError: the run did not reach its end; `error.run` holds it as far as it came.
            Arm3rError: `progress` stopped the run; `error.run` likewise.
        """
        check_time_limit(time_limit)
        if trust and controller is not None:
            raise UsageError("trust: it takes more runs, and a law of your own may have a memory", code="usage")
        if isinstance(controller, (str, os.PathLike)):
            law: Law = provided("function of a file")(controller).law(self)
            controller = law
        if controller is None and rate is not None:
            raise UsageError("rate: it is that of a controller, and none is given; set sampling.rate", code="usage")
        mine = self if controller is None else self.for_law(rate)
        mine.warn_of_itself()
        if controller is None:
            options: Any = {"progress": progress, "time_limit": time_limit, "trust": bool(trust)}
            run = Run.of_handle(_native.start(lib.arm3r_scenario_run, mine.handle, **options))
        else:
            limits: Any = {"progress": progress, "time_limit": time_limit}
            run = run_with_law(mine.handle, controller, mine.file, Run.of_handle, **limits)
        mine.warn(_native.text(lib.arm3r_run_warnings, run.handle).splitlines())
        if run.outcome != "ok":
            raise class_of_outcome(run.outcome)(
                f"{self.file}: {run.outcome}: {run.summary['message']}", code=f"run.{run.outcome}", run=run
            )
        return run

    def run_beside(
        self,
        controller: Law | str | os.PathLike[str],
        *,
        rate: float | None = None,
        progress: Progress | None = None,
        time_limit: float | None = None,
    ) -> Beside:
        """Run a controller of your own, and beside it the scenario's own, at the same samples.

        >>> beside = scenario.run_beside("my_gravity.m")
        >>> print(beside)
        >>> beside.figure()

        A function of the joint angles alone is a gravity torque. Where the scenario does not compensate gravity, the
        controller beside it is `gravity_compensation`.

        Args, Raises: as `run`. What ends your run early is in `beside.failure` and is not raised.
        """
        limits: Any = {"progress": progress, "time_limit": time_limit}
        beside: Beside = provided("run of two controllers")(self, controller, rate=rate, **limits)
        return beside

    def for_law(self, rate: float | None) -> Scenario:
        """A copy whose controller is a law of the user's own. What it warns of, this scenario has warned of."""
        mine = self.copy()
        if mine["controller.type"] != "user":
            mine["controller.type"] = "user"
            mine["reference"] = None
        if rate is not None:
            check_rate(rate)
            mine["sampling.rate"] = rate
        mine._warned = self._warned
        return mine

    def batch(
        self,
        values: Mapping[str, Any],
        *,
        grid: bool = False,
        threads: int | None = None,
        progress: BatchProgress | Literal[False] | None = None,
        controller: Law | NativeLaw | str | os.PathLike[str] | None = None,
        make_controller: MakeLaw | None = None,
        rate: float | None = None,
        columns: Sequence[str] | None = None,
        metrics: Sequence[str] | None = None,
    ) -> Batch[Scenario]:
        """Many runs at once: a table of their summaries. Ctrl-C ends it at once with KeyboardInterrupt.

        >>> batch = scenario.batch({"wall.contact.stiffness": np.geomspace(1e2, 1e6, 1000)}, columns=["q", "force"])
        >>> batch["peak_force"], batch.rows["force"][7]

        A run that fails is one row; one whose values are not valid has the outcome `invalid`, and NaN.

        Args:
            values: arrays by key, SI units and radians: (..., k) of a key with several numbers, (...) of any other and
                of a single place, "initial.q[1]". Words and flags may vary too: {"solver.method": ["rk4", "dopri5"]}.
            grid: False: the arrays broadcast as NumPy's do; True: every value of each with every one of the others.
            threads: how many; None: one for each CPU that this process may use. It never changes a result.
            progress: called as progress(runs_done, runs) at most every 20 ms; a true result ends the runs left as
                `stopped`, and what it raises comes out unchanged. None: a bar on stderr, if that is a terminal and the
                runs take longer than a second; False: nothing.
            controller: a law of your own for all runs, as `run` takes it. A Python function is called for one run after
                the other in this thread; so is a NativeLaw, unless it is declared re-entrant. A function in a file is
                made anew for each run, and gets the numbers of that run's arm.
            make_controller: called as make_controller(index) at the start of each run, for a law with a memory or with
                gains of its own; it returns the law of this run. index: as for a column, so a tuple where the batch has
                several dimensions.
            rate: of the samples of these laws, Hz, as in `run`.
            columns: of the rows that are wanted beside the summaries, at the instants that the scenario logs, whatever
                time.log_columns chooses: names, or names of three such as "q". They are `batch.rows`, and take 8 bytes
                for each run, column and row. None: no rows.
            metrics: the names of the summaries that are wanted, such as ["peak_force", "settling_time"]; `outcome` is
                always one. Metrics of a controller's performance that are not among them are not computed, which
                saves up to 0.4 of the time of a batch by rk4. None: all.

        Raises:
            ControllerError: a law in Python raised, or returned no torque: `error.index` is its run, and no other one
                is begun. A torque that is not finite, and a NativeLaw that returns an error, end that run alone, with
                the outcome `controller`.
            UsageError: a key or a metric that there is not, a number that varies twice, or arrays of shapes that do not
                fit.
            TypeError: not numbers.
            BudgetError: there is no memory for the table or the rows.
            ScenarioError: the scenario itself is not valid, a word is none of its key's, or no run has one of the
                columns.
        """
        with shown(progress, "batch", "runs") as report:
            return run_batch(
                self,
                values,
                grid=grid,
                threads=threads,
                progress=report,
                controller=controller,
                make_controller=make_controller,
                rate=rate,
                columns=columns,
                metrics=metrics,
            )


def _is_part(path: str, of: str) -> bool:
    return path == of or path.startswith((f"{of}.", f"{of}["))


def _sections(path: str) -> Iterator[str]:
    """A path and the sections that it lies in: "wall", "wall.contact", "wall.contact.law"."""
    parts = path.split(".")
    return (".".join(parts[:count]) for count in range(1, len(parts) + 1))


def _restore(text: str, file: str) -> Scenario:
    return Scenario(text, file=file)


def _number(text: str) -> int | float:
    """The library writes 1e+07 for a whole number too; keys that need one take no other."""
    value = float(text)
    return int(value) if value.is_integer() else value


def _plain(value: Any) -> Any:
    """Without what is absent in maps; and JSON has no infinity: the library writes "inf"."""
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, dict):
        return {key: item for key, given in value.items() if (item := _plain(given)) not in (None, {})}
    return math.inf if value == "inf" else value


def _read_arm(request: str) -> tuple[int, str]:
    from ..robots.explicit import answer

    return answer(request)


_native.read_arms_with(_read_arm)
