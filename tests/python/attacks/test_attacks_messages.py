"""What is refused says so at the right place, in plain words, with the likely fix; what is a likely slip warns."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from conftest import scenario_files

HEAD = "format: 1\n"
SECTIONS = {
    "wall": "wall: {point: [1.8, 0, 0]}\n",
    "force": "wall: {point: [1.8, 0, 0], acts_on_arm: true}\ncontroller: {type: hybrid}\n",
    "tip": "controller: {type: impedance}\nreference: {type: point, tip: [1.7, 0, 0.1]}\n",
    "joints": "controller: {type: joint_pd}\nreference: {type: point, q: [0, -0.5, 1]}\n",
    "observer": "controller: {type: joint_pd}\nobserver: {}\n",
    "estimator": "wall: {acts_on_arm: true}\ncontroller: {type: impedance}\nestimator: {}\n",
    "tank": "controller: {type: energy_tank}\n",
    "limits": "arm: {torque_limit: [50, 50, 50]}\ncontroller: {type: joint_pd}\n",
    "nothing": "",
}


def problems_of(text: str) -> list[dict[str, Any]]:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario(text, file="s.yaml").validate()
    return raised.value.problems


def message(text: str) -> str:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario(text, file="s.yaml").validate()
    return str(raised.value)


# ---- F2: checks on columns that a run lacks -------------------------------------------------------------------------


def all_columns(cli: Any) -> list[str]:
    return [line.split()[0] for line in cli("columns").stdout.splitlines() if line and not line.startswith(" ")]


@pytest.mark.parametrize("section", SECTIONS.values(), ids=SECTIONS)
def test_a_check_is_refused_exactly_where_the_run_lacks_its_column(cli: Any, section: str) -> None:
    text = HEAD + "time: {stop: 0}\n" + section
    present = set(arm3r.Scenario(text).run().columns)
    names = [name for name in all_columns(cli) if name.replace("_", "").isalnum()]
    assert present < set(names)
    for name in names:
        checked = f"{text}checks: [{{column: t, of: final, equals: 0}}, {{column: {name}, of: final, equals: 0}}]\n"
        try:
            assert arm3r.Scenario(checked).run() and name in present
        except arm3r.ScenarioError as error:
            assert name not in present, error


def test_the_message_has_place_columns_and_hint() -> None:
    text = HEAD + "time: {stop: 0.1}\nchecks: [{name: a, column: residual1, of: final, equals: 0}]\n"
    (problem,) = problems_of(text)
    assert (problem["line"], problem["column"], problem["path"]) == (3, 28, "checks[0].column")
    assert "add `observer: {}`" in problem["hint"] and "only with an observer" in problem["message"]
    assert "q1..q3" in problem["allowed"] and "residual1" not in problem["allowed"]
    minus = "checks: [{column: q1, minus: q_ref1, of: final, equals: 0}]\n"
    assert "joint_pd" in problems_of(HEAD + minus)[0]["hint"]


def test_nothing_is_simulated_for_such_a_check(cli: Any, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(HEAD + "checks: [{column: depth, of: final, equals: 0}]\n")
    for call in (["check", "s.yaml"], ["run", "s.yaml", "-o", "s.csv"]):
        done = cli(*call, cwd=tmp_path)
        assert done.returncode == 3 and "s.yaml:2:19: error[check.column]: checks[0].column" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["s.yaml"]


def test_no_check_is_refused_for_what_another_mistake_hides() -> None:
    text = HEAD + "controller: {type: joint_pdd}\nchecks: [{column: q_ref1, of: final, equals: 0}]\n"
    assert [problem["path"] for problem in problems_of(text)] == ["controller.type"]


# ---- messages 2 to 7 ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words", "absent"),
    [
        ("controller: {type: joint_pd, kp: 100}", ["s.yaml:2:30", "joint_stiffness?", "joint_damping"], ["force_gain"]),
        ("controller: {type: joint_pd, Kd: 1}", ["did you mean joint_damping?"], ["velocity_gain"]),
        ("controller: {type: computed_torque, kp: 1, kd: 2}", ["position_gain?", "velocity_gain?"], ["stiffness?"]),
        ("controller: {type: hybrid, kI: 1}", ["did you mean force_integral_gain?"], []),
        ("controller: {type: impedance, K: 1, D: 1}", ["did you mean stiffness?", "did you mean damping?"], []),
        ("controller: {type: impedance, B: 1}", ["did you mean damping?"], []),
        ("controller: {type: shaped_impedance, m: 1}", ["did you mean mass?"], []),
        ("controller: {type: joint_pd, gains: [1, 2]}", ["did you mean joint_stiffness or joint_damping?"], []),
        ("controller: {type: parallel, k_f: 1}", ["did you mean force_gain?"], ["tank_energy"]),
        ("controller: joint_pd", ["write `controller: {type: joint_pd}`"], ["tank_energy"]),
        ("solver: rk4", ["write `solver: {method: rk4}`"], []),
        ("time: {stop:10}", ["a blank is needed after the colon: stop: 10"], []),
        ("time: {t_end: 10}", ["did you mean time.stop?"], []),
        ("time: {dt: 0.01}", ["did you mean solver.step or time.log_every?"], ["wall.motion.t"]),
        ("dt: 0.01", ["did you mean solver.step or time.log_every?"], []),
        ("time: {step: 0.01}", ["did you mean solver.step or time.log_every?"], []),
        ("reference: {type: point, tip: [1, 0, 0]}", ["control law", "add controller: {type: ...}", "joint_pd"], []),
    ],
)  # fmt: skip
def test_an_unknown_key_names_what_was_meant(text: str, words: list[str], absent: list[str]) -> None:
    found = message(HEAD + text + "\n")
    assert all(word in found for word in words) and not any(word in found for word in absent), found


# ---- S2: only the keys of the chosen type, and what people write instead --------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("controller: {type: joint_pd, kI: 1}", ["`force_integral_gain` belongs to type", "where type is joint_pd"]),
        ("controller: {type: joint_pd, M: 1}", ["`mass` belongs to type", "admittance"]),
        (
            "controller: {type: joint_pd, stiffness: 1}",
            ["not go with type joint_pd", "mean joint_stiffness?"],
        ),
        ("controller: {type: computed_torque, damping: 1}", ["did you mean velocity_gain?"]),
        ("controller: {type: impedance, f_d: 1}", ["did you mean reference.force.value?"]),
        ("controller: {type: impedance, x_d: [1, 0, 0]}", ["did you mean reference.tip?"]),
        ("controller: {kp: 1}", ["where type is none", "choose a type first"]),
        ("wall: {contact: {k: 1}}", ["where law is spring", "did you mean stiffness?"]),
        ("wall: {contact: {mu: 1}}", ["did you mean friction.coefficient?"]),
        ("wall: {contact: {c: 1}}", ["`damping` belongs to law kelvin_voigt"]),
        ("wall: {k: 1}", ["did you mean contact.stiffness?"]),
        ("wall: {v: 1}", ["did you mean motion.velocity?"]),
        ("wall: {velocity: 1}", ["`velocity` belongs to wall.motion"]),
        ("wall: {motion: {type: sinusoid, amplitude: 1, frequency: 1, f: 1}}", ["did you mean frequency?"]),
        ("wall: {motion: {speed: 1}}", ["did you mean velocity?"]),
        ("arm: {link2: {m: 1, L: 2, I: 3}}", ["did you mean mass?", "did you mean length?", "did you mean inertia?"]),
        ("observer: {K_O: 1}", ["did you mean gain?"]),
        ("observer: {K: 1}", ["did you mean gain?"]),
        ("initial: {q_0: 1}", ["did you mean q?"]),
    ],
)
def test_what_people_write_is_known(text: str, words: list[str]) -> None:
    found = message(HEAD + text + "\n")
    assert all(word in found for word in words), found


CHOICES = ["controller.type", "wall.motion.type", "wall.contact.law", "wall.rotation.type", "reference.type",
           "arm.link2.shape", "solver.method", "sensors.velocity.estimate", "observer.reaction"]  # fmt: skip


def _with(choice: str, word: str, more: str = "") -> list[dict[str, Any]]:
    """The problems of a scenario with this word and, beside it, with more keys."""
    *sections, name = choice.split(".")
    text = f"{{{name}: {word}{more}}}"
    for section in reversed(sections):
        text = f"{section}: {text}" if section == sections[0] else f"{{{section}: {text}}}"
    law = "" if choice == "controller.type" else "controller: {type: impedance}\n"
    scenario = arm3r.Scenario(f"{HEAD}{law}{text}\n")
    with pytest.raises(arm3r.ScenarioError) as error:
        scenario.validate()
    return error.value.problems


@pytest.mark.parametrize("choice", CHOICES)
def test_only_keys_of_the_chosen_word_are_listed(choice: str) -> None:
    """No key of the list belongs to another word, and at an unknown key nothing is suggested."""
    section, _, name = choice.rpartition(".")
    words = next(problem["allowed"] for problem in _with(choice, "no_such_word") if problem["path"] == choice)
    for word in words.split(", "):
        (problem,) = (found for found in _with(choice, word, ", zzzzzzzz: 1") if found["path"].endswith(".zzzzzzzz"))
        assert f"where {name} is {word}" in problem["message"] and not problem["hint"]
        keys = [key for key in problem["allowed"].split(", ") if key != name]
        found = _with(choice, word, "".join(f", {key}: no_such_value" for key in keys) + ", zzzzzzzz: 1")
        judged = {problem["path"]: problem["code"] for problem in found}
        assert not {"scenario.other_choice", "scenario.unknown_key"} & {judged.get(f"{section}.{key}") for key in keys}


def test_under_an_unknown_word_no_keys_are_listed() -> None:
    problems = problems_of(HEAD + "controller: {type: impedanc, kp: 3}\n")
    assert [problem["path"] for problem in problems] == ["controller.type", "controller.kp"]
    assert problems[1]["allowed"] == "" and "depends on controller.type" in problems[1]["hint"]


@pytest.mark.parametrize("key", ["tau", "foo", "f_x"])
def test_no_far_fetched_hints(key: str) -> None:
    (problem,) = problems_of(HEAD + f"controller: {{type: joint_pd, {key}: 3}}\n")
    assert problem["hint"] == "", problem["hint"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("wall: {point: [2, 0, 0\ntime: {stop: 1}\n", ["[ of line 2, column 15"]),
        ("wall: {point: [2, 0, 0]\ntime: {stop: 1}\n", ["{ of line 2, column 7"]),
        ("wall: {point: 2, 0, 0]}\n", ["bracket"]),
        ("arm:\n  damping: [0, 0, 0]\n   friction: [0, 0, 0]\n", ["colon", "s.yaml:4:"]),
        ("arm:\n  damping: [0, 0, 0]\n friction: [0, 0, 0]\n", ["indentation", "s.yaml:4:"]),
        ("name: 'a\n", ["a quote is not closed", "s.yaml:2:7"]),
        ('name: "a\ntime: {stop: 1}\n', ["a quote is not closed", "s.yaml:2:7"]),
        ("name: 'it''s\ntime: {stop: 1}\n", ["a quote is not closed", "s.yaml:2:7"]),
        ('name: "a\\"\ntime: {stop: 1}\n', ["a quote is not closed", "s.yaml:2:7"]),
        ('name: "a\\q"\n', ["backslash", "single quotes"]),
        ("name: @a\n", ["quotes"]),
        ("name: a: b\n", ["colon"]),
    ],
)
def test_yaml_that_cannot_be_read_is_reported_in_plain_words(text: str, words: list[str]) -> None:
    found = message(HEAD + text)
    assert all(word in found for word in words), found
    assert not any(word in found for word in ("illegal", "not found", "scalar", "flow")), found


# ---- F10: the reader ------------------------------------------------------------------------------------------------


def test_a_second_byte_order_mark_is_refused() -> None:
    with pytest.raises(arm3r.ScenarioError, match="a second byte order mark"):
        arm3r.Scenario("\ufeff\ufeff" + HEAD)
    assert arm3r.Scenario("\ufeff" + HEAD).validate() is None


@pytest.mark.parametrize("value", ["! foo", "! 'foo'", "!", "! [a]", "!!str foo"])
def test_tags_are_refused(value: str) -> None:
    assert "tags are not supported" in message(HEAD + f"name: {value}\n")


def test_brackets_in_comments_do_not_nest() -> None:
    for comment in ("# " + "[" * 10_001, "name: a # " + "{" * 10_001, "  \t# it is " + "[" * 10_001):
        assert arm3r.Scenario(HEAD + comment + "\ntime: {stop: 1}\n").validate() is None
    for text in ("a#" + "[" * 10_001, 'name: "a\n # ", [' + "[" * 10_001):
        with pytest.raises(arm3r.ScenarioError):
            arm3r.Scenario(HEAD + text + "\n")


@pytest.mark.parametrize("path", ["initial.q[0][0]", "wall.contact.stiffness[0][0]", "initial.q[0][0][0]"])
def test_an_item_of_a_number_is_refused(path: str) -> None:
    scenario = arm3r.Scenario(HEAD + "wall: {}\n")
    with pytest.raises(arm3r.UsageError):
        scenario[path]
    assert path not in scenario
    with pytest.raises(arm3r.Arm3rError):
        scenario[path] = 1
        scenario.validate()
    with pytest.raises(arm3r.UsageError):
        arm3r.Scenario(HEAD).batch({path: [1.0]})


# ---- S1, P8: warnings -----------------------------------------------------------------------------------------------

WALL = "wall: {point: [1.8, 0, 0]}\n"
USES_FORCE = {
    "hybrid": "", "parallel": "", "operational_space": "", "adaptive_reference": "", "shaped_impedance": "",
    "admittance": "", "resolved_acceleration": "", "computed_torque": ", cancel_force: true",
}  # fmt: skip
DOES_NOT = {
    "gravity_compensation": "", "joint_pd": "", "impedance": "", "computed_torque": "",
    "resolved_acceleration": ", cancel_force: false",
}  # fmt: skip


def warnings_of(text: str) -> list[str]:
    return arm3r.Scenario(HEAD + "time: {stop: 0}\n" + text).run().warnings


@pytest.mark.parametrize(
    ("law", "rest", "uses"), [(*law, True) for law in USES_FORCE.items()] + [(*law, False) for law in DOES_NOT.items()]
)
def test_a_force_that_the_arm_does_not_feel_warns_every_law_that_uses_it(law: str, rest: str, uses: bool) -> None:
    controller = f"controller: {{type: {law}{rest}}}\n"
    felt = "wall: {point: [1.8, 0, 0], acts_on_arm: true}\n"
    assert any("write acts_on_arm: true" in line for line in warnings_of(WALL + controller)) == uses
    assert not any("write acts_on_arm: true" in line for line in warnings_of(felt + controller))


@pytest.mark.parametrize("gravity", ["[0, 0, 0]", "[0, 0, -1.62]", "[0, 5, -8]", "[0, 0, 9.80665]"])
@pytest.mark.parametrize("law", ["gravity_compensation", "joint_pd", "impedance", "computed_torque"])
def test_a_default_gravity_of_the_controller_warns(law: str, gravity: str) -> None:
    arm, controller = f"arm: {{gravity: {gravity}}}\n", f"controller: {{type: {law}"
    said = [line for line in warnings_of(arm + controller + "}\n") if "default of controller.gravity" in line]
    assert len(said) == 1 and f"controller.gravity: {gravity}" in said[0]
    assert not any("controller.gravity" in line for line in warnings_of(arm + controller + f", gravity: {gravity}}}\n"))
    for own in ("[0, 0, -5]", "5", "9.80665"):  # what the file says itself is no default
        said = warnings_of(arm + controller + f", gravity: {own}}}\n")
        assert not any("default" in line for line in said)


def test_what_uses_no_gravity_does_not_warn() -> None:
    for controller in (
        "{type: none}",
        "{type: constant, torque: [0, 0, 0]}",
        "{type: joint_pd, compensate_gravity: false}",
    ):
        assert warnings_of(f"arm: {{gravity: [0, 0, -1.62]}}\ncontroller: {controller}\n") == []


def test_warnings_reach_the_command_line_and_json(cli: Any, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(HEAD + "arm: {gravity: [0, 0, 0]}\ncontroller: {type: gravity_compensation}\n")
    assert "s.yaml: warning: the plant feels the gravity [0, 0, 0]" in cli("check", "s.yaml", cwd=tmp_path).stderr
    summary = json.loads(cli("run", "s.yaml", "--json", "--set", "time.stop=0", cwd=tmp_path).stdout)
    assert any("the plant feels the gravity" in line for line in summary["warnings"])


def test_no_shipped_scenario_warns_about_gravity_or_a_force_that_is_not_felt() -> None:
    for path in scenario_files():
        scenario = arm3r.Scenario.load(path)
        scenario["time.stop"] = 0
        scenario["checks"] = []
        said = [w for w in scenario.run().warnings if "controller.gravity" in w or "acts_on_arm" in w]
        assert not said, (path, said)


# ---- F10: the command line ------------------------------------------------------------------------------------------


def test_names_that_are_not_utf8_are_mistakes_of_usage(executable: Path, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(HEAD + "time: {stop: 0}\n")
    for words in ([b"run", b"s.yaml", b"-o", b"\xff.csv"], [b"run", b"\xff.yaml"], [b"check", b"\xff"]):
        done = subprocess.run([bytes(executable), *words], cwd=tmp_path, capture_output=True)
        assert done.returncode == 2 and b"UTF-8" in done.stderr, done


def test_several_results_go_into_a_folder_that_is_made(cli: Any, tmp_path: Path) -> None:
    for name in "ab":
        (tmp_path / f"{name}.yaml").write_text(HEAD + "time: {stop: 0}\n")
    assert cli("run", "a.yaml", "b.yaml", "-o", "new/folder", cwd=tmp_path).returncode == 0
    assert sorted(path.name for path in (tmp_path / "new/folder").iterdir()) == ["a.csv", "a.json", "b.csv", "b.json"]
    assert cli("run", "a.yaml", "b.yaml", "-o", "a.yaml", cwd=tmp_path).returncode == 6
    assert cli("run", "a.yaml", "-o", "none/a.csv", cwd=tmp_path).returncode == 6
