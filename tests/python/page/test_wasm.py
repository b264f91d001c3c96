"""The core in WebAssembly, called by node through core.js, has the bits and the words of the native one."""

from __future__ import annotations

import base64
import gzip
import json
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import _native
from conftest import ROOT, Cli, scenario_files
from elbow_arms import WITH_OFFSETS
from random_scenarios import yaml_of

pytestmark = pytest.mark.needs("wasm")

WASM = ROOT / "build" / "page" / "arm3r.wasm"
TOOLS = ROOT / "tests" / "wasm"
LARGEST = 1_000_000  # bytes, compressed

SCENARIO = """\
format: 1
name: small
initial: {q: [0.1, -0.5, 1.0]}
wall: {point: [1.75, 0.1, 0], contact: {stiffness: 700}, acts_on_arm: true}
time: {stop: 0.3, log_every: 0.01}
checks:
  - {name: it meets the wall, count: make, equals: 1}
"""
LONG = {"method": "rk4", "step": 1e-6, "max_steps": 10**9}


def unpacked(value: dict[str, Any]) -> Any:
    return np.frombuffer(base64.b64decode(value["doubles"])) if value.keys() == {"doubles"} else value


def core(*calls: list[Any]) -> list[Any]:
    """The results of calls of one core, each [method, argument...]."""
    command = ["node", str(TOOLS / "call.mjs"), str(WASM)]
    done = subprocess.run(command, input=json.dumps(calls), capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    results: list[Any] = json.loads(done.stdout, object_hook=unpacked)
    assert len(results) == len(calls)
    return results


def without_time(text: str) -> str:
    return re.sub(r'.*("elapsed_s": |  wall clock ).*\n', "", text)


# ---- runs


def test_a_run_has_the_bits_and_texts_of_the_native_one(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "small.yaml"
    file.write_text(SCENARIO)
    assert cli("run", file, "-o", tmp_path / "small.csv").returncode == 0
    [run] = core(["run_with_csv", SCENARIO, {"name": str(file)}])
    native = arm3r.Scenario.load(file).run()
    assert list(run["columns"]) == native.columns
    for name in native.columns:
        assert run["columns"][name].tobytes() == native[name].tobytes(), name
    assert run["csv"] == (tmp_path / "small.csv").read_text()
    assert without_time(run["summaryText"]) == without_time((tmp_path / "small.json").read_text())
    assert run["report"].startswith("small: ok") and "PASS  it meets the wall" in run["report"]
    [make] = run["events"][:1]
    assert (make["type"], make["t"], make["q"]) == ("make", native.events[0].t, list(native.events[0].q))
    assert run["units"]["f_on_wall_x"] == "N"
    assert [check["passed"] for check in run["checks"]] == [True]
    assert run["resolved"]["wall"]["contact"]["stiffness"] == 700


def test_options_of_a_run() -> None:
    some, unknown, edited, limited = core(
        ["run", SCENARIO, {"columns": ["t", "q2"]}],
        ["run", SCENARIO, {"columns": ["t", "q9"]}],
        ["run", SCENARIO, {"set": {"wall.contact.stiffness": 900, "initial.q": "[0 deg, -30 deg, 60 deg]"}}],
        ["run", SCENARIO, {"set": {"solver": LONG, "time.stop": 100}, "timeLimit": 0.05}],
    )
    assert list(some["columns"]) == ["t", "q2"]
    assert "q9" in unknown["message"]
    scenario = arm3r.Scenario(SCENARIO)
    scenario.update({"wall.contact.stiffness": 900, "initial.q": [0, math.radians(-30), math.radians(60)]})
    assert edited["columns"]["q3"].tobytes() == scenario.run()["q3"].tobytes()
    assert limited["summary"]["outcome"] == "budget"


def test_the_texts_of_reference_are_the_native_ones(cli: Cli) -> None:
    properties, schema, columns, template, yaml, positions = core(
        ["properties"], ["schema"], ["columnsText"], ["template"],
        ["yaml", SCENARIO, {"annotate": True}], ["positions", SCENARIO, [0.1, -0.5, 1.0]],
    )  # fmt: skip
    assert properties["version"] == arm3r.__version__ and "wasm32" in properties["buildInfo"]
    assert schema == cli("schema").stdout and columns == cli("columns").stdout
    assert template == _native.string(_native.lib.arm3r_template())
    assert yaml == arm3r.Scenario(SCENARIO).to_yaml(annotate=True)
    arm = arm3r.Scenario(SCENARIO).arm
    q = [0.1, -0.5, 1.0]
    assert positions["tip"].tolist() == arm.tip_position(q).tolist()
    assert positions["elbow"].tolist() == arm.elbow_position(q).tolist()


def test_the_points_and_axes_of_an_elbow_arm_are_the_native_ones() -> None:
    q = np.random.default_rng(3).uniform(-3, 3, (4, 3))
    scenario = {"format": 1, "arm": WITH_OFFSETS, "initial": {"q": [0.4, -0.7, 1.1]}}
    [found] = core(["positions", yaml_of(scenario), q.ravel().tolist()])
    arm = arm3r.Scenario(yaml_of(scenario)).arm
    assert found["points"].tolist() == arm.points(q).ravel().tolist()
    assert found["axes"].reshape(4, 3, 3).tolist() == arm.geometric_jacobian(q)[:, 3:].swapaxes(1, 2).tolist()
    assert found["reach"] == arm.reach


def test_inverse_kinematics_has_the_bits_of_the_native_one() -> None:
    """Four branches, each up to the first point out of reach."""
    planar, elbow_arm = [[1.2, 0.3, 0.4], [0.5, -0.9, 0.2], [2.5, 0, 0], [1, 0, 0]], [[0.3, 0.2, 0.4]]
    for keys, tips in (({}, planar), ({"arm": WITH_OFFSETS}, elbow_arm)):
        text = yaml_of({"format": 1, "initial": {"q": [0.4, -0.7, 1.1]}, **keys})
        [branches] = core(["inverseKinematics", text, [part for tip in tips for part in tip]])
        arm = arm3r.Scenario(text).arm
        choices = [(front, elbow) for front in (True, False) for elbow in ("up", "down")]
        for found, (front, elbow) in zip(branches, choices, strict=True):
            q = arm.inverse_kinematics(tips[:2], front=front, elbow=elbow)
            assert found.tolist() == q.ravel().tolist(), (front, elbow)
    [beyond] = core(["inverseKinematics", SCENARIO, [9, 0, 0]])
    assert [found.tolist() for found in beyond] == [[]] * 4


def test_the_tip_comes_as_near_to_a_point_as_it_reaches() -> None:
    """In the branch that it is in; towards a point out of reach along the ray from the shoulder."""
    arm = arm3r.Scenario(SCENARIO).arm
    near = [0.1, -0.5, 1.0]
    reachable = arm.tip_position([0.3, -0.2, 0.7]).tolist()
    points = [reachable, [4.0, 3.0, 0.0], [0.0, -3.0, 4.0]]
    found = core(*(["pose_towards", SCENARIO, {"name": "a.yaml", "point": point, "near": near}] for point in points))
    assert found[0]["q"] == pytest.approx([0.3, -0.2, 0.7], abs=1e-12)
    for pose, point in zip(found[1:], points[1:], strict=True):
        tip = np.array(pose["tip"])
        assert arm.tip_position(pose["q"]) == pytest.approx(tip, abs=1e-6)
        assert tip == pytest.approx(2 * np.array(point) / 5, abs=2e-3)


def test_the_example_of_the_page_runs(tmp_path: Path) -> None:
    [block] = re.findall(r"```js\n(.*?)```", (ROOT / "docs" / "webassembly.md").read_text(), re.S)
    assert block.count("./core.js") == 1
    served = f"""
        import {{ readFileSync }} from "node:fs";
        const text = {json.dumps(SCENARIO)};
        globalThis.fetch = async () => ({{ arrayBuffer: async () => readFileSync({json.dumps(str(WASM))}) }});
    """
    script = tmp_path / "page.mjs"
    script.write_text(served + block.replace("./core.js", str(ROOT / "web/core/core.js")))
    done = subprocess.run(["node", str(script)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "PASS  it meets the wall" in done.stdout


# ---- errors


HOSTILE = {
    "an unknown key": SCENARIO.replace("stiffness", "stifness"),
    "a unit": SCENARIO.replace("700", "700 N"),
    "a range": SCENARIO.replace("700", "-1"),
    "no YAML": "wall: {point: [1, 2",
    "nothing": "",
    "a NUL": "name: a\0b",
    "nested lists": "a: " + "[" * 100_000,
    "nested maps": "\n".join(" " * i + "a:" for i in range(1000)),
    "nested flow maps": "{a: " * 100_000,
    "a long text": "name: " + "x" * 2_000_000,
    "an alias of an alias": "a: &a [1, 1]\nb: &b [*a, *a]\nc: [*b, *b]",
    "a tag": "name: !!python/object:os.system x",
    "many keys": "\n".join(f"key{i}: 1" for i in range(50_000)),
    "too many rows": SCENARIO.replace("log_every: 0.01", "log_every: 1.0e-12"),
}


def test_problems_of_a_text_are_the_native_ones() -> None:
    """The core goes on after each: it does not end in a trap."""
    texts = [*HOSTILE.values(), SCENARIO]
    *results, good = core(*(["read", text] for text in texts))
    for (what, text), result in zip(HOSTILE.items(), results, strict=True):
        with pytest.raises(arm3r.Arm3rError) as native:
            arm3r.Scenario(text).validate()
        assert result["resolved"] is None
        names = {"key": "path", "value": "got", "rule": "code"}
        problems = [{names.get(key, key): value for key, value in problem.items()} for problem in result["problems"]]
        assert problems == native.value.problems or (not native.value.problems and len(problems) == 1), what
    assert good["problems"] == [] and good["resolved"]["name"] == "small"


def test_warnings_and_errors_of_a_run() -> None:
    degrees = SCENARIO.replace("[0.1, -0.5, 1.0]", "[0, -30, 60]")
    read, run, thrown = core(["read", degrees], ["run", SCENARIO], ["run", HOSTILE["an unknown key"]])
    assert len(read["warnings"]) > 0 and all(line.startswith("scenario.yaml: warning: ") for line in read["warnings"])
    assert run["warnings"] == arm3r.Scenario(SCENARIO).run().warnings
    assert thrown["error"] == "Arm3rError" and thrown["problems"][0]["line"] == 4
    assert thrown["problems"][0]["column"] == SCENARIO.splitlines()[3].index("stiffness") + 1
    assert "did you mean stiffness?" in thrown["message"]


def test_memory_that_is_not_there_is_an_error_and_no_trap() -> None:
    """WebAssembly has at most 4 GiB: first a million rows are more than what is left, then everything is."""
    many = {"set": {"time.log_every": 3e-7}, "columns": ["t"]}
    _, run, small, blocks, read, full, dead = core(
        ["fill_memory", 2**28], ["run", SCENARIO, many], ["run", SCENARIO, {"columns": ["t"]}],
        ["fill_memory", 2**24, 2**20, 2**16, 2**12, 2**8, 16], ["read", SCENARIO], ["run", SCENARIO], ["is_dead"],
    )  # fmt: skip
    assert run["error"] == "Arm3rError" and "not enough memory" in run["message"]
    assert len(small["columns"]["t"]) == 31
    assert blocks > 100
    assert read["problems"][0]["rule"] == "memory" and "not enough memory" in read["problems"][0]["message"]
    assert full["error"] == "Arm3rError" and "not enough memory" in full["message"]
    assert dead is False


def test_memory_is_given_back() -> None:
    first, later = core(["memory_after", "run", 3, SCENARIO], ["memory_after", "run", 200, SCENARIO])
    assert later == first


def test_a_trap_ends_the_core_with_a_message_and_it_can_be_loaded_again() -> None:
    _, run, again, dead, _, alive, run_again = core(
        ["trap"], ["run", SCENARIO], ["read", SCENARIO], ["is_dead"], ["reload"], ["is_dead"], ["run", SCENARIO]
    )
    assert run["error"] == again["error"] == "DeadCoreError"
    assert "stopped in arm3r_scenario_run: unreachable" in run["message"] and "load it again" in run["message"]
    assert (dead, alive) == (True, False)
    assert run_again["summary"]["outcome"] == "ok"


# ---- many runs


def test_a_batch_has_the_bits_of_the_native_one() -> None:
    runs = 40
    values = np.geomspace(100, 1e5, runs)
    given, drawn, drawn_again = core(
        ["batch", SCENARIO, {"runs": runs, "values": {"wall.contact.stiffness[0]": values.tolist()}}],
        *[["batch", SCENARIO, {"runs": runs, "seed": 7, "within": {"wall.contact.stiffness": 0.1}}]] * 2,
    )
    native = arm3r.Scenario(SCENARIO).batch({"wall.contact.stiffness": values})
    assert list(given["summary"]) == list(native.names)
    for name in native.names:
        assert given["summary"][name].tobytes() == np.asarray(native[name], float).tobytes(), name
    [stiffness] = drawn["varied"].values()
    assert 630 <= stiffness.min() < 660 < 740 < stiffness.max() <= 770
    native = arm3r.Scenario(SCENARIO).batch({"wall.contact.stiffness": stiffness})
    assert drawn["summary"]["peak_force"].tobytes() == native["peak_force"].tobytes()
    assert drawn["summary"]["impulse"].tobytes() == drawn_again["summary"]["impulse"].tobytes()


def test_a_band_holds_the_quantiles_of_its_runs() -> None:
    options = {
        "runs": 25,
        "within": {"initial.q": 0.02},
        "columns": ["q2", "f_on_wall_x"],
        "rows": 16,
        "levels": [0, 0.3, 1],
    }
    [band] = core(["batch", SCENARIO, options])
    assert list(band["varied"]) == ["initial.q[0]", "initial.q[1]", "initial.q[2]"]
    found: dict[str, list[np.ndarray]] = {"q2": [], "f_on_wall_x": []}
    for q in np.transpose(list(band["varied"].values())):
        scenario = arm3r.Scenario(SCENARIO)
        scenario.update({"initial.q": q.tolist(), "time.log_every": 0.3 / 15})
        run = scenario.run()
        assert band["time"].tobytes() == run.t.tobytes()
        for name, rows in found.items():
            rows.append(run[name])
    for name, rows in found.items():
        for level in (0, 0.3, 1):
            quantile = np.quantile(rows, level, axis=0)
            assert np.allclose(band["quantiles"][name][str(level)], quantile, rtol=1e-14, atol=1e-15), (name, level)


# ---- hashes, size and speed


def hashes(command: list[str], output: Path, files: list[Path], runs: int) -> Path:
    done = subprocess.run([*command, "--batch", str(runs), *map(str, files)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    output.write_text(done.stdout)
    return output


def compare(bits: Path, files: list[Path], runs: int, folder: Path) -> str:
    native = hashes([str(bits)], folder / "native.txt", files, runs)
    wasm = hashes(["node", str(TOOLS / "bits.mjs"), str(WASM)], folder / "wasm32.txt", files, runs)
    command = [sys.executable, str(ROOT / "tests" / "c" / "compare_bits.py"), str(native), str(wasm)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_hashes_of_a_sample_are_the_native_ones(bits: Path, tmp_path: Path) -> None:
    names = ("moving_wall", "stiff_wall", "hybrid_first_contact")
    files = [path for path in scenario_files() if path.stem in names]
    assert "| wasm32 | 3 of 3 | 3 of 3 |" in compare(bits, files, 5, tmp_path)


@pytest.mark.gate
def test_hashes_of_all_scenarios_are_the_native_ones(bits: Path, tmp_path: Path) -> None:
    files = scenario_files()
    assert len(files) >= 60
    print(compare(bits, files, 100, tmp_path))


@pytest.mark.gate
def test_the_module_is_small() -> None:
    """As servers send it: compressed with brotli."""
    script = "console.log(zlib.brotliCompressSync(fs.readFileSync(process.argv[1])).length)"
    done = subprocess.run(["node", "-e", script, str(WASM)], capture_output=True, text=True, check=True)
    data = WASM.read_bytes()
    print(f"arm3r.wasm: {len(data)} bytes, {done.stdout.strip()} with brotli, {len(gzip.compress(data, 9))} with gzip")
    assert int(done.stdout) <= LARGEST


@pytest.mark.gate
def test_times_are_printed(moving_wall: Path) -> None:
    """The least times; no time is required here."""
    text = moving_wall.read_text()
    taylor = {"set": {"solver": {"method": "taylor", "tol": 1e-9}, "wall.acts_on_arm": True, "checks": "[]"}}
    band = {"runs": 1000, "within": {"wall.contact.stiffness": 0.1}}
    read, run, batch, rows = core(
        ["times", "read", 30, text],
        ["times", "run", 30, text],
        ["times", "batch", 10, text, taylor | band],
        ["times", "batch", 5, text, taylor | band | {"columns": ["q2", "f_on_wall_x"], "rows": 201}],
    )
    for what, ms in {"read": read, "lecture run": run, "1000 Taylor runs": batch, "with a band": rows}.items():
        print(f"{what}: {min(ms):.1f} ms")
        assert min(ms) > 0
