"""time.log_columns: the columns chosen have the bits of the full log, and nothing else changes."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import Cli
from random_scenarios import IN_JOINTS, LAWS, random_scenario, sample_seed, yaml_of

OWN = {"hash", "columns", "scenario", "elapsed_s"}
"""What of a summary is told of the log, or of the clock."""


def rest_of(summary: dict[str, Any]) -> str:
    return repr({key: value for key, value in summary.items() if key not in OWN})


def outcome_of(scenario: arm3r.Scenario, **options: Any) -> arm3r.Run:
    try:
        return scenario.run(**options)
    except arm3r.Arm3rError as error:
        assert error.run is not None
        return error.run


def compare(scenario: arm3r.Scenario, names: list[str], **options: Any) -> None:
    """The run of a scenario, beside the same with these columns in its log."""
    full = outcome_of(scenario, **options)
    chosen = scenario.copy()
    chosen["time.log_columns"] = names
    run = outcome_of(chosen, **options)
    assert run.columns == [name for name in full.columns if name == "t" or name in names]
    for name in run.columns:
        assert np.array_equal(run[name].view(np.uint64), full[name].view(np.uint64)), name
    assert rest_of(run.summary) == rest_of(full.summary)
    assert [check["value"] for check in run.checks] == [check["value"] for check in full.checks]


def some_of(rng: np.random.Generator, columns: list[str]) -> list[str]:
    count = int(rng.choice([1, 2, 3, 6, len(columns) // 2]))
    return [str(name) for name in rng.permutation(columns)[:count]]


@pytest.mark.filterwarnings("ignore::arm3r_cpp.ScenarioWarning")
@pytest.mark.parametrize("law", LAWS)
def test_random_subsets_have_the_bits_of_the_full_log(law: str) -> None:
    seed = sample_seed()
    print(f"ARM3R_SEED={seed}")
    rng = np.random.default_rng([seed, LAWS.index(law)])
    for sampled in (False, True):
        scenario = arm3r.Scenario(yaml_of(random_scenario(rng, law=law, sampled=sampled, longest=0.6)))
        scenario["checks"] = [{"column": "qdd2", "minus": "energy_kinetic", "of": "max_abs", "below": 1e300}]
        for method in ("dopri5", "rk4", "taylor", "rodas4", "auto"):
            changed = scenario.copy()
            changed["solver"] = {"method": method}
            try:
                columns = outcome_of(changed).columns
            except (arm3r.ScenarioError, AssertionError):
                continue  # the method does not know this law
            compare(changed, some_of(rng, columns))


@pytest.mark.filterwarnings("ignore::arm3r_cpp.ScenarioWarning")
def test_every_column_alone_and_all_but_one() -> None:
    scenario = arm3r.Scenario.example("force_control/hybrid_biased_sensor")
    scenario["time.stop"] = 0.3
    scenario["checks"] = []
    columns = scenario.run().columns
    for name in columns:
        compare(scenario, [name])
        compare(scenario, [other for other in columns if other != name])


def test_checks_and_trust_keep_the_columns_that_they_read() -> None:
    scenario = arm3r.Scenario.example("moving_wall")
    compare(scenario, ["depth"])
    compare(scenario, ["tau2"], trust=True)
    scenario["time.log_columns"] = ["q1"]
    run = scenario.run(trust=True)
    assert run.passed and run.trust is not None and run.columns == ["t", "q1"]


def test_a_law_of_your_own_and_a_simulation_choose_columns() -> None:
    scenario = arm3r.Scenario("format: 1\ntime: {stop: 0.1}\n")
    compare(scenario, ["tau3", "qdd1"], controller=lambda t, state: state.tau_g - state.qd)
    scenario["time.log_columns"] = ["tau3"]
    simulation = arm3r.Simulation(scenario)
    simulation.step([1.0, 2.0, 3.0])
    assert simulation.run.columns == ["t", "tau3"]


def test_a_bad_end_is_explained_alike() -> None:
    """The message names the pose before it, though the log has no angles."""
    text = (
        "format: 1\narm: {convention: slide}\ninitial: {q: [0.2, -0.5, 1.1]}\ntime: {stop: 3}\n"
        "controller: {type: resolved_acceleration, position_gain: 400, velocity_gain: 40}\n"
        "reference: {type: minimum_jerk, tip: [2.2, 0.1, 0.1], duration: 0.5}\n"
    )
    full, chosen = arm3r.Scenario(text), arm3r.Scenario(text)
    chosen["time.log_columns"] = ["tau1"]
    ends = [outcome_of(scenario) for scenario in (full, chosen)]
    assert ends[0].outcome == ends[1].outcome != "ok"
    assert "singular pose" in ends[0].summary["message"]
    assert rest_of(ends[0].summary) == rest_of(ends[1].summary)


def test_a_batch_has_the_same_bits_whatever_is_logged() -> None:
    scenario = arm3r.Scenario.example("moving_wall")
    chosen = scenario.copy()
    chosen["time.log_columns"] = ["q1"]
    tables = [s.batch({"wall.contact.stiffness": [100.0, 1e3, 1e4]}) for s in (scenario, chosen)]
    for name in tables[0]:
        assert np.array_equal(tables[0][name], tables[1][name], equal_nan=True), name
    with pytest.raises(arm3r.UsageError, match="chooses columns of a log"):
        scenario.batch({"time.log_columns[0]": [1.0, 2.0]})


@pytest.mark.parametrize(
    ("value", "place", "words"),
    [
        ("[]", "2:32", "a list of 1 to"),
        ("q1", "2:32", "got q1"),
        ("[q2, q2]", "2:37", "time.log_columns[1]: this column stands in the list twice, got q2"),
        ("[q]", "2:33", "write q1, q2, q3"),
        ("[t, tip]", "2:36", "write tip_x, tip_y, tip_z"),
        ("[f_on_wal_x]", "2:33", "did you mean f_on_wall_x?"),
        ("[q1, force]", "2:37", "only with a wall, got force; add `wall: {}`"),
        ("[1]", "2:33", "there is no such column, got 1"),
    ],
)
def test_a_wrong_list_is_refused_with_its_place(value: str, place: str, words: str) -> None:
    with pytest.raises(arm3r.ScenarioError) as refused:
        arm3r.Scenario(f"format: 1\ntime: {{stop: 0.1, log_columns: {value}}}\n", file="a.yaml").validate()
    assert f"a.yaml:{place}: error" in str(refused.value) and words in str(refused.value)


def test_a_law_in_joints_has_no_path_of_the_tip() -> None:
    scenario = arm3r.Scenario(f"format: 1\ncontroller: {{type: {IN_JOINTS[0]}}}\nreference: {{type: hold}}\n")
    scenario["time.log_columns"] = ["tip_ref_x"]
    with pytest.raises(arm3r.ScenarioError, match="follows a path of the tip"):
        scenario.run()


def test_files_and_tables_have_the_columns_chosen(cli: Cli, tmp_path: Any) -> None:
    path = tmp_path / "run.csv"
    cli("run", "scenarios/moving_wall.yaml", "--set", "time.log_columns=[q1, f_on_wall_x]", "-o", str(path))
    assert path.read_text().startswith("t,q1,f_on_wall_x\n")
    run = arm3r.Run.load(path)
    assert run.columns == ["t", "q1", "f_on_wall_x"] and run.passed
    run.to_npz(tmp_path / "again.npz")
    assert arm3r.Run.load(tmp_path / "again.npz").columns == run.columns
    with pytest.raises(KeyError, match=r"the log of this run does not have 'tau1'.*time\.log_columns"):
        run["tau1"]


def test_npz_by_the_library_has_an_array_for_each_column(cli: Cli, tmp_path: Any) -> None:
    paths = [tmp_path / "one.npz", tmp_path / "two.npz"]
    scenario = arm3r.Scenario.example("moving_wall")
    scenario["time.stop"] = 0.5
    scenario["checks"] = []
    text = tmp_path / "short.yaml"
    text.write_text(scenario.to_yaml())
    for path in paths:
        cli("run", str(text), "-o", str(path))
    expected = scenario.run()
    with np.load(paths[0]) as file, zipfile.ZipFile(paths[0]) as archive, zipfile.ZipFile(paths[1]) as other:
        assert archive.testzip() is None  # every checksum is right
        assert file.files == [*expected.columns, "summary.json"]
        for name in expected.columns:
            assert np.array_equal(file[name].view(np.uint64), expected[name].view(np.uint64)), name
            assert archive.read(f"{name}.npy") == other.read(f"{name}.npy")
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {info.compress_type for info in archive.infolist()} == {zipfile.ZIP_STORED}
        assert archive.read("summary.json") == (tmp_path / "one.json").read_bytes()
    loaded = arm3r.Run.load(paths[0])
    assert loaded.columns == expected.columns and loaded.summary["hash"] == expected.summary["hash"]
    data = bytearray(paths[0].read_bytes())
    data[200] ^= 1
    paths[0].write_bytes(data)
    with pytest.raises(arm3r.UsageError, match=r"one\.npz: not "):
        arm3r.Run.load(paths[0])


def uses_of(run: arm3r.Run, folder: Path) -> dict[str, Callable[[], object]]:
    """Everything that reads columns of a run by name."""
    return {
        "overview": lambda: arm3r.plot.overview(run),
        "force": lambda: arm3r.plot.force(run),
        "lecture": lambda: arm3r.plot.lecture(run),
        "animate": lambda: arm3r.plot.animate(run, folder / "run.gif", fps=5, speed=2),
        "to_html": lambda: run.to_html(folder / "run.html"),
        "q": lambda: run["q"],
        "tip": lambda: run["tip"],
        "energy_kinetic": lambda: run["energy_kinetic"],
    }


@pytest.mark.parametrize("which", ("moving_wall", "force_control/hybrid_biased_sensor", "05_free_fall"))
def test_what_reads_a_run_has_its_columns_or_says_which_are_missing(which: str, tmp_path: Path) -> None:
    seed = sample_seed()
    print(f"ARM3R_SEED={seed}")
    rng = np.random.default_rng(seed)
    scenario = arm3r.Scenario.example(which)
    scenario["time.stop"] = 0.1
    scenario["checks"] = []
    columns = scenario.run().columns[1:]
    whole = [["q1", "q2", "q3"], ["tip_x", "tip_y", "tip_z"], ["qd1"]]
    for names in whole + [some_of(rng, columns) for _ in range(6)]:
        scenario["time.log_columns"] = names
        for use, read in uses_of(scenario.run(), tmp_path).items():
            try:
                read()
            except arm3r.UsageError as error:
                refused = str(error)
                assert "column" in refused, (use, names)
                assert refused == error.args[0], (use, names)


def test_a_column_that_was_not_chosen_is_named_with_the_mend() -> None:
    scenario = arm3r.Scenario.example("moving_wall")
    scenario["time.log_columns"] = ["q2"]
    with pytest.raises(
        arm3r.ColumnError, match=r"add q1, q2, q3 to time.log_columns, or leave that out; there are t, q2"
    ):
        scenario.run()["q"]


# ---- how a run ends --------------------------------------------------------------------------------------------------


def diverging_scenario(rng: np.random.Generator) -> str:
    """Gains, rates and forces of any size: most of these runs break off."""
    laws = ["none", "constant", "joint_pd", "stiffness", "impedance", "computed_torque", "resolved_acceleration"]
    law, method = laws[int(rng.integers(len(laws)))], rng.choice(["rk4", "rk4", "taylor", "dopri5", "rodas4"])
    gain = lambda: float(10 ** rng.uniform(1, 9))  # noqa: E731
    controller: dict[str, Any] = {"type": law}
    if law in ("joint_pd", "computed_torque", "resolved_acceleration"):
        controller |= {"velocity_gain": gain(), "position_gain": gain()}
    if law in ("stiffness", "impedance"):
        controller["damping"] = gain()
    if law == "constant":
        controller["torque"] = (gain() * rng.normal(size=3)).tolist()
    keys: dict[str, Any] = {
        "format": 1,
        "arm": {"damping": [float(10 ** rng.uniform(0, 6))] * 3} if method == "rk4" and rng.random() < 0.6 else {},
        "initial": {"q": rng.uniform(-1, 1, 3).tolist(), "qd": (10 ** rng.uniform(0, 5) * rng.normal(size=3)).tolist()},
        "controller": controller,
        "solver": {"method": str(method), "max_steps": 3000},
        "time": {"stop": 1, "log_every": float(rng.choice([1e-3, 0.01, 7.3e-4]))},
    }
    if method == "rk4":
        keys["solver"]["step"] = float(rng.choice([1e-3, 3e-3, 1e-2]))
    if law not in ("none", "constant") and rng.random() < 0.3:
        keys["sampling"] = {"rate": 1000}
    if rng.random() < 0.4:
        stiffness = {"stiffness": float(10 ** rng.uniform(3, 9))}
        keys["wall"] = {"point": [1.7, 0, 0], "size": "infinite", "acts_on_arm": True, "contact": stiffness}
        keys["wall"]["motion"] = {"type": "fixed"}
    return yaml_of(keys)


def end_of(scenario: arm3r.Scenario) -> tuple[Any, ...]:
    run = outcome_of(scenario)
    return run.outcome, run.summary["t_end"], run.summary["message"], len(run.t)


def check_ends(count: int) -> None:
    """A run that breaks off ends at the same instant, with the same message, whatever is logged, and in a batch."""
    seed, compared = sample_seed(), 0
    rng = np.random.default_rng([seed, 11])
    for number in range(count):
        text = diverging_scenario(rng)
        scenario = arm3r.Scenario(text)
        try:
            scenario.validate()
        except arm3r.ScenarioError:
            continue
        whole = end_of(scenario)
        compared += whole[0] != "ok"
        batches = [
            scenario.batch({"arm.base_height": [0.0]}, columns=columns) for columns in (None, ["energy_kinetic"])
        ]
        assert {batch["t_end"][0] for batch in batches} == {whole[1]}, f"seed {seed}, {number}: {whole}\n{text}"
        assert len({batch["outcome"][0] for batch in batches}) == 1, f"seed {seed}, {number}: {whole}\n{text}"
        for columns in (["q1"], ["qdd1"], ["energy_kinetic"], ["tip_dvx"], ["tau1"], ["tip_vx", "energy_residual"]):
            scenario["time.log_columns"] = columns
            assert end_of(scenario) == whole, f"seed {seed}, {number}, {columns}\n{text}"
    assert compared > 0.2 * count


def test_the_end_of_a_run_does_not_depend_on_what_is_logged() -> None:
    check_ends(60)


@pytest.mark.gate
@pytest.mark.random
def test_the_ends_of_many_runs_do_not_depend_on_what_is_logged() -> None:
    check_ends(1500)
