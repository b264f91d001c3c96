"""What other programs make of the files: YAML 1.1 readers, and editors with the JSON Schemas."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import jsonschema
import pytest
import yaml
from arm3r_cpp import _native
from conftest import ROOT, scenario_files

SWEEPS = sorted((ROOT / "scenarios/sweeps").glob("*.yaml"))
FILES = [*scenario_files(), *SWEEPS, ROOT / "benchmarks/hybrid_wall.yaml"]
PAGES = [ROOT / "README.md", *sorted(ROOT.glob("docs/*.md"))]
BLOCKS = [block for page in PAGES for block in re.findall(r"```yaml\n(.*?)```", page.read_text(), re.S)]


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


# ---- YAML 1.1 -------------------------------------------------------------------------------------------------------


def differences(text: str) -> list[str]:
    """Where PyYAML reads another value than the library does; `inf` and `30 deg` are text to it."""
    ours = _native.text(_native.lib.arm3r_yaml_json, text.encode(), len(text.encode()), b"text.yaml", 9)
    return list(_differences(json.loads(ours), yaml.safe_load(text), ""))


def _differences(ours: dict[str, Any], theirs: Any, path: str) -> Any:
    if "map" in ours:
        assert [child["key"] for child in ours["map"]] == list(map(str, theirs)), path
        for child, value in zip(ours["map"], theirs.values(), strict=True):
            yield from _differences(child, value, f"{path}.{child['key']}")
    elif "list" in ours:
        for i, (child, value) in enumerate(zip(ours["list"], theirs, strict=True)):
            yield from _differences(child, value, f"{path}[{i}]")
    elif "number" in ours and not ours["degrees"] and "inf" not in ours["text"]:
        if isinstance(theirs, bool) or theirs != ours["number"]:
            yield f"{path}: {ours['text']} is {theirs!r}"
    elif "text" in ours and ours["text"] not in ("true", "false") and theirs != ours["text"]:
        yield f"{path}: {ours['text']!r} is {theirs!r}"


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_shipped_files_mean_the_same_in_yaml_1_1(path: Path) -> None:
    assert differences(path.read_text()) == []


def test_blocks_of_the_pages_mean_the_same_in_yaml_1_1() -> None:
    assert BLOCKS
    for block in BLOCKS:
        assert differences(block) == []


def test_the_comparison_finds_what_yaml_1_1_reads_as_text() -> None:
    found = differences("a: {b: 1e-9, c: [1.0e6, 1.0e+6]}\n")
    assert found == [".a.b: 1e-9 is '1e-9'", ".a.c[0]: 1.0e6 is '1.0e6'"]


def test_what_the_program_prints_means_the_same_in_yaml_1_1(cli: Any, tmp_path: Path) -> None:
    assert differences(cli("template").stdout) == []
    scenario = arm3r.Scenario("format: 1\nwall: {}\n")
    for path, value in {
        "solver.rtol": 2.5e-8, "solver.atol": 1e-14, "arm.link1.inertia_axial": 1e-5, "wall.point": [1e6, -1e-7, 0.5],
        "wall.contact.stiffness": 1e15, "time.start": -5e-5, "initial.q": [1e5, -3e-16, 0.25],
        "checks": [{"column": "q1", "of": "final", "equals": 1e-9, "abs": 1e300, "name": "1e5"}],
    }.items():  # fmt: skip
        scenario[path] = value
    for annotate in (False, True):
        assert differences(scenario.to_yaml(annotate=annotate)) == []
    (tmp_path / "s.yaml").write_text("format: 1\nchecks: [{column: q1, of: final, equals: -.5, abs: 1e-0}]\n")
    assert differences(cli("check", tmp_path / "s.yaml").stdout) == []


@pytest.mark.parametrize("text", ["1e-9", "1e9", "1e+09", "-1e-09", "+2.5e3", ".5", "-.5e-07", "12", "-0.25", "1.5e00"])
def test_numbers_keep_their_bits_on_the_way_through_to_yaml(text: str) -> None:
    scenario = arm3r.Scenario(f"format: 1\nchecks: [{{column: q1, of: final, equals: {text}}}]\n")
    printed = scenario.to_yaml()
    written = re.search(r"equals: (\S+?)[,}]", printed)[1]
    assert float(written) == float(text) and yaml.safe_load(written) == float(text)
    assert arm3r.Scenario(printed).to_yaml() == printed


# ---- the schemas ----------------------------------------------------------------------------------------------------


def schema_of(name: str) -> Any:
    return json.loads((ROOT / f"docs/{name}.schema.json").read_text())


SCENARIO, SWEEP = (jsonschema.Draft7Validator(schema_of(name)) for name in ("scenario", "sweep"))


def test_the_schemas_are_schemas() -> None:
    for schema in (SCENARIO, SWEEP):
        jsonschema.Draft7Validator.check_schema(schema.schema)
        for words in enums(schema.schema):
            assert len(set(words)) == len(words)  # editors refuse a schema in which a word stands twice


def enums(schema: Any) -> Iterator[list[str]]:
    for key, value in schema.items() if isinstance(schema, dict) else enumerate(schema):
        if key == "enum":
            yield value
        elif isinstance(value, (dict, list)):
            yield from enums(value)


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_shipped_files_are_valid_and_name_their_schema(path: Path) -> None:
    validator = SWEEP if path in SWEEPS else SCENARIO
    assert [error.message for error in validator.iter_errors(yaml.safe_load(path.read_text()))] == []
    named = re.match(r"# yaml-language-server: \$schema=(.*)\n", path.read_text())[1]
    assert (path.parent / named).resolve() == ROOT / f"docs/{'sweep' if path in SWEEPS else 'scenario'}.schema.json"


def test_what_the_program_prints_is_valid(cli: Any) -> None:
    for text in (cli("template").stdout, arm3r.Scenario.load(ROOT / "scenarios/moving_wall.yaml").to_yaml()):
        assert [error.message for error in SCENARIO.iter_errors(yaml.safe_load(text))] == []


def test_the_template_names_the_installed_schema(cli: Any) -> None:
    named = re.match(r"# yaml-language-server: \$schema=(.*)\n", cli("template").stdout)[1]
    assert Path(named).is_absolute() and json.loads(Path(named).read_text()) == SCENARIO.schema


def is_valid(validator: Any, text: str) -> bool:
    return validator.is_valid(yaml.safe_load(f"format: 1\n{text}\n"))


AXES = "axes: [{key: time.stop, values: [1]}]"


@pytest.mark.parametrize(
    "text",
    [
        "controler: {}",
        "controller: {type: joint_pd, mass: 2}",
        "controller: {type: joint_pd, kp: 2}",
        "controller: {gravity: 9.81}",
        "controller: {type: impedance, model: {link2: {lenght: 1}}}",
        "controller: {type: hybrid, tracking_time: 0.1}",
        "controller: {type: hybrid, switching: always, contact_on: 2}",
        "controller: {type: gravity_compensation}\nreference: {type: point}",
        "controller: {type: impedance}\nreference: {force: {value: 2}}",
        "controller: {type: constant}",
        "sampling: {rate: 100}",
        "wall: {motion: {type: sinusoid, amplitude: 1}}",
        "wall: {motion: {velocity: 1, amplitude: 1}}",
        "wall: {contact: {law: diagonal, stiffness: 1000}}",
        "wall: {contact: {law: hunt_crossley}}",
        "wall: {contact: {stiffness: [1, 2, 3]}}",
        "arm: {link2: {shape: slender, section: [0.1, 0.1]}}",
        "arm: {link2: {shape: cylinder}}",
        "solver: {method: rk4, rtol: 1.0e-9}",
        "solver: {step: 0.1}",
        "time: {stop: -1.0e+10}",
        "checks: [{column: q1, of: final, event: make, equals: 0}]",
        "checks: [{column: q7, of: final, equals: 0}]",
    ],
)
def test_wrong_scenarios_are_refused_by_schema_and_program(text: str) -> None:
    assert not is_valid(SCENARIO, text)
    with pytest.raises(arm3r.ScenarioError):
        arm3r.Scenario(f"format: 1\n{text}\n").validate()


@pytest.mark.parametrize(
    "text",
    [
        f"scenario: a.yaml\n{AXES}\nmode: random",
        f"scenario: a.yaml\n{AXES}\nruns: 3",
        f"scenario: a.yaml\n{AXES}\nsets: {{}}",
        f"scenario: a.yaml\n{AXES}\nset: {{wall.stifness: 1}}",
        f"scenario: a.yaml\n{AXES}\nmetrics: [peak_forces]",
        f"scenario: a.yaml\n{AXES}\nstatistics: [{{column: depth, of: largest}}]",
        "scenario: a.yaml\naxes: [{key: time.stopp, values: [1]}]",
        "scenario: a.yaml\naxes: [{key: time.stop, values: [1], linspace: [1, 2, 3]}]",
        "scenario: a.yaml\naxes: [{key: time.stop, linspace: [1, 2]}]",
        "scenario: a.yaml\naxes: []",
        AXES,
    ],
)
def test_wrong_sweeps_are_refused_by_schema_and_program(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("format: 1\nwall: {}\n")
    (tmp_path / "sweep.yaml").write_text(f"format: 1\n{text}\n")
    assert not is_valid(SWEEP, text)
    with pytest.raises(arm3r.Arm3rError):
        arm3r.Sweep.load(tmp_path / "sweep.yaml")


def test_the_schema_has_the_defaults_of_the_program() -> None:
    """Of every word of every choice: what the schema calls the default is what the resolved scenario holds."""
    compared = 0
    definitions = SCENARIO.schema["definitions"]
    for path in ("controller", "solver", "wall.contact", "wall.motion", "observer", "arm.link2"):
        (choice,) = {next(iter(rule["if"]["properties"])) for rule in definitions[path]["allOf"]}
        for rule in definitions[path]["allOf"]:
            (word,) = rule["if"]["properties"][choice]["enum"]
            scenario = arm3r.Scenario("format: 1\nwall: {size: infinite}\n")
            if path == "observer":
                scenario["controller"], scenario["sampling"] = {"type": "gravity_compensation"}, {}
            needed = {name: 0.5 for name in rule["then"].get("required", [])}
            needed |= {"torque": [0, 0, 0]} if (path, word) == ("controller", "constant") else {}
            needed |= {"stiffness": [1, 1, 1]} if word == "diagonal" else {}
            needed |= {key: [0.0, 1.0] for key in "tsva"} if word == "table" else {}
            needed |= (
                {"damping": 1} if word == "kelvin_voigt" else {"dissipation": 1} if word == "hunt_crossley" else {}
            )
            needed |= {"mass": 1} if word == "slender" else {}
            scenario[path] = {choice: word, **needed}
            for name, schema in rule["then"]["properties"].items():
                schema = definitions[path]["properties"][name] if schema is True else schema
                if "default" in schema and name != choice and name not in needed:
                    default = float("inf") if schema["default"] == "inf" else schema["default"]
                    if f"{path}.{name}" in scenario:
                        assert scenario[f"{path}.{name}"] == default, (path, word, name)
                        compared += 1
    assert compared > 100


def test_the_ranges_of_sliders_are_those_of_keys() -> None:
    """Every row of the table belongs to a number; what it says lies within the bounds."""
    found: dict[str, list[dict[str, Any]]] = {}
    nodes = [SCENARIO.schema, *SCENARIO.schema["definitions"].values()]
    while nodes:
        node = nodes.pop()
        for name, one in node.get("properties", {}).items():
            if isinstance(one, dict):
                found.setdefault(name, []).append(one)
                nodes.append(one)
        rules = [one for word in ("allOf", "anyOf") for one in node.get(word, []) if isinstance(one, dict)]
        nodes += [*rules, *(rule[word] for rule in rules for word in ("then", "else") if word in rule)]
    for name in re.findall(r'"(\w+)"', (ROOT / "cpp/src/schema/usual_range.cpp").read_text().split("namespace {")[1]):
        assert any("x-range" in one for one in found.get(name, [])), name
    for name, some in found.items():
        for usual, numbers in ((one["x-range"], one.get("items", one)) for one in some if "x-range" in one):
            bounds = next((part for part in numbers.get("anyOf", [numbers]) if "minimum" in part), {})
            assert usual.get("zero", 1) <= bounds.get("maximum", 1e300), name
            assert usual.get("factor", 30) > 1 and (not usual.get("signed") or bounds.get("minimum", -1) < 0), name
