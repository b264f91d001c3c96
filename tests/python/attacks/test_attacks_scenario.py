"""Hostile and mistaken scenarios: each ends in exit 0 or a message that names place, key and fix; nothing crashes."""

from __future__ import annotations

import json
import os
import random
import re
import resource
import signal
import stat
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import arm3r_cpp as arm3r
import pytest
from conftest import ROOT, scenario_files
from random_scenarios import sample_seed
from timing import once_within

SCENARIO_EXIT, USAGE_EXIT, FORMAT_EXIT = 3, 2, 9
HEAD = "format: 1\n"
FULL = """\
format: 1
name: full
arm:
  convention: slide
  link2: {length: 0.8, shape: cylinder, radius: 0.02, density: 2700}
  damping: [0.1, 0.1, 0.1]
initial: {q: [0, 30 deg, -60 deg], qd: [0, 0, 1e-3]}
wall:
  point: [2, 0, 0]
  size: infinite
  motion: {type: sinusoid, amplitude: 0.1, frequency: 2.5}
  contact: {law: diagonal, stiffness: [1000, 10, 10]}
controller: {type: gravity_compensation, model: {link3: {mass: 0.7}}}
solver: {method: rk4, step: 0.001}
time: {stop: 0.5, log_every: 0.1}
checks:
  - {name: stays, column: q1, of: max_abs, below: 1}
"""

Refused = Callable[..., str]


def cpu_seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Outcome:
    def __init__(self, code: int, message: str) -> None:
        self.code, self.message = code, message


@pytest.fixture
def check(cli, tmp_path: Path) -> Callable[..., Outcome]:
    """check(text, *options): exit code and messages of `arm3r check`, the file called s.yaml."""

    def call(text: str | bytes, *options: str) -> Outcome:
        (tmp_path / "s.yaml").write_bytes(text if isinstance(text, bytes) else text.encode())
        result = cli("check", "s.yaml", *options, cwd=tmp_path)
        assert result.returncode >= 0, result
        warnings = all(": warning: " in line for line in result.stderr.splitlines())
        assert (result.returncode == 0) == warnings
        return Outcome(result.returncode, result.stderr)

    return call


@pytest.fixture
def refused(check) -> Refused:
    """refused(text): the messages of a scenario that must exit with 3."""

    def call(text: str | bytes, *options: str) -> str:
        outcome = check(text, *options)
        assert outcome.code == SCENARIO_EXIT, outcome.message
        return outcome.message

    return call


# ---- A: bytes and structure -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["", "# nothing\n", "\n\n", "---\n"])
def test_an_empty_file_points_to_the_template(refused, text):
    message = refused(text)
    assert "the scenario is empty" in message and "arm3r template" in message


def test_unreadable_files_exit_2_with_the_reason(cli, tmp_path):
    for path, reason in [(tmp_path, "Is a directory"), (tmp_path / "none.yaml", "No such file")]:
        result = cli("check", path)
        assert result.returncode == USAGE_EXIT
        assert str(path) in result.stderr and reason in result.stderr


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_no_permission(cli, tmp_path):
    path = tmp_path / "closed.yaml"
    path.write_text(HEAD)
    path.chmod(0)
    result = cli("check", path)
    assert result.returncode == USAGE_EXIT and "Permission denied" in result.stderr


def test_only_regular_files_and_standard_input(cli, tmp_path):
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    for path in [fifo, "/dev/zero"]:
        result = cli("check", path, timeout=600)
        assert result.returncode == USAGE_EXIT and "not a regular file" in result.stderr
    assert cli("check", "-", input=HEAD).returncode == 0
    with open("/dev/zero", "rb") as endless:
        assert cli("check", "-", stdin=endless, timeout=600).returncode == SCENARIO_EXIT


@pytest.mark.timed
def test_a_file_of_1_gib_is_refused_at_the_cap_at_once(cli, tmp_path):
    huge = tmp_path / "huge.yaml"
    with huge.open("wb") as file:
        file.truncate(1 << 30)

    def refused():
        before = cpu_seconds_of_children()
        result = cli("check", huge)
        assert result.returncode == SCENARIO_EXIT and "1048576 bytes" in result.stderr
        return cpu_seconds_of_children() - before

    assert once_within(0.1, refused)


def test_the_number_of_values_is_capped(refused):
    assert "more than 50000 values" in refused(HEAD + "checks: [" + "1," * 100_000 + "1]\n")


def test_the_number_of_keys_in_a_map_is_capped(refused):
    assert "more than 1000 keys" in refused(HEAD + "".join(f"k{i}: 1\n" for i in range(40_000)))


def test_a_long_value_is_refused_at_its_place(refused):
    assert "s.yaml:2:7: error[yaml.scalar_length]" in refused(HEAD + "name: " + "x" * 100_000 + "\n")


@pytest.mark.parametrize("text", ["[" * 100_000, "{a: " * 20_000, HEAD + "arm: " + "[" * 65, "- " * 50_000])
def test_deep_nesting_says_so(refused, text):
    assert "nesting deeper than 64" in refused(text)


@pytest.mark.parametrize("text", ["&x [*x]", "&x {a: *x}", "a: &a [*b]\nb: &b [*a]", "a: &x 1\n&y *x : 2"])
def test_cycles_and_aliases(refused, text):
    assert "anchors and aliases are not supported" in refused(text)


def test_billion_laughs(refused):
    text = "a0: &a0 [1,1]\n" + "".join(f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 12))
    assert "s.yaml:1:5: error[yaml.anchor]" in refused(text)


def test_undefined_alias_and_alias_key(refused):
    assert "s.yaml:2:4: error[yaml.alias]" in refused(HEAD + "a: *x\n")
    assert "error[yaml.alias]" in refused(HEAD + "a: &x 1\n*x : 1\n")


def test_merge_keys(refused):
    assert "s.yaml:3:3: error[yaml.merge]" in refused(HEAD + "arm:\n  <<: {damping: [1, 1, 1]}\n")


def test_a_duplicate_key_shows_both_lines(refused):
    message = refused(HEAD + "arm:\n  link2:\n    mass: 1\n    length: 1\n    mass: 2\n")
    assert "s.yaml:6:5: error[yaml.duplicate_key]: arm.link2.mass" in message and "line 4" in message


def test_a_second_document(refused):
    assert re.search(
        r"s\.yaml:[23]:1: error\[yaml.documents\]: .*one document per file", refused(HEAD + "---\nformat: 1\n")
    )
    assert "yaml.documents" in refused(HEAD + "...\n---\nname: x\n")


@pytest.mark.parametrize("tag", ["!!python/object:os.system", "!include", "!!binary", "!!float"])
def test_tags(refused, tag):
    assert "s.yaml:2:7: error[yaml.tag]" in refused(HEAD + f"name: {tag} x\n")


def test_a_tab_names_its_column(refused):
    assert "tab at column 1 of line 3; use spaces" in refused(HEAD + "arm:\n\tdamping: [0, 0, 0]\n")


@pytest.mark.parametrize(
    "text, offset",
    [
        (HEAD.encode("utf-16"), 0),
        (HEAD.encode("utf-32"), 0),
        (b"format: 1\nname: \xff\n", 16),
        (b"format: 1\nname: \xc0\xaf\n", 16),
        (b"format: 1\nname: \xed\xa0\x80\n", 16),
        (b"format: 1\nname: a\0b\n", 17),
        ("format: 1\nname: a\u202eb\n".encode(), 17),
        ("format: 1\nname: a\u2066b\n".encode(), 17),
        (b"format: 1\nname: a\x1b[31mb\n", 17),
        (b"format: 1\rname: x\r", 9),
        (b"format: 1\n\x0cname: x\n", 10),
    ],
)
def test_what_is_not_plain_utf8_is_refused_with_its_byte(refused, text, offset):
    message = refused(text)
    assert "error[yaml.encoding]" in message and f"at byte {offset};" in message


def test_a_byte_order_mark_is_accepted(check):
    assert check(b"\xef\xbb\xbf" + HEAD.encode()).code == 0


def test_line_ends(check, refused):
    assert check(FULL.replace("\n", "\r\n")).code == 0
    assert check(HEAD.strip()).code == 0
    assert "s.yaml:3:1: error[scenario.unknown_key]: armm" in refused("format: 1\r\nname: x\r\narmm: {}\r\n")


def accepted_or_refused(text: str) -> bool:
    """Whether the text is a scenario; raises where it is neither that nor refused in words."""
    try:
        arm3r.Scenario(text).validate()
        return True
    except (arm3r.ScenarioError, arm3r.IncompatibleError, arm3r.BudgetError) as error:
        assert str(error)
        return False


def shortened(text: str) -> list[str]:
    return [text[:i] for i in range(len(text))] + [text[:i] + text[i + 1 :] for i in range(len(text))]


def judge_shipped(each: int | None) -> None:
    """Judges some pieces of every shipped scenario, or all of them."""
    chance = random.Random(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    for file in scenario_files():
        text = file.read_text()
        assert accepted_or_refused(text), file
        pieces = shortened(text)
        for piece in pieces if each is None else chance.sample(pieces, each):
            accepted_or_refused(piece)


def test_every_prefix_and_every_deletion_is_valid_or_refused() -> None:
    assert accepted_or_refused(FULL)
    for piece in shortened(FULL):
        accepted_or_refused(piece)


def test_some_prefixes_and_deletions_of_every_shipped_scenario() -> None:
    judge_shipped(each=60)


@pytest.mark.gate
def test_all_prefixes_and_deletions_of_every_shipped_scenario() -> None:
    judge_shipped(each=None)


def test_a_section_that_was_cut_off_is_not_filled_with_defaults(refused):
    for section in ["arm", "wall", "initial", "controller", "time"]:
        assert f"s.yaml:2:1: error[scenario.type]: {section}: expects a map, got nothing" in refused(
            HEAD + section + ":\n"
        )


TOKENS = [
    "{", "}", "[", "]", ":", "-", "&x", "*x", "!!t", "<<:", "#", "'", '"', "|", ">", "---", "...", "1e9",
    "-0.0", "inf", "nan", "0x1", "deg", "true", "null", "~", "?", "é", "%YAML", "\n", "  ", "\t",
]  # fmt: skip


def mutant(chance: random.Random, texts: list[str]) -> str:
    """One of the texts after one to six changes: a token, a piece of another text, or a deletion."""
    text = chance.choice(texts)
    for _ in range(chance.randint(1, 6)):
        at = chance.randint(0, len(text))
        other = chance.choice(texts)
        begin = chance.randint(0, len(other))
        piece = chance.choice([chance.choice(TOKENS), other[begin : begin + chance.randint(0, 60)], ""])
        text = text[:at] + piece + text[at + chance.randint(0, 20) * (piece == "") :]
    return text


@pytest.mark.parametrize("count", [3000, pytest.param(130_000, marks=pytest.mark.gate)])
def test_mutated_scenarios_never_crash(count: int) -> None:
    chance = random.Random(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    texts = [FULL, *(file.read_text() for file in scenario_files())]
    for _ in range(count):
        accepted_or_refused(mutant(chance, texts))


@pytest.mark.timed
@pytest.mark.parametrize(
    "text",
    [
        "[" * 1_000_000,
        HEAD + "name: '" + "a" * 1_000_000 + "'",
        HEAD + "checks: [" + "{a: 1}," * 140_000 + "]",
        HEAD + "".join(f"? [{i}]\n: 1\n" for i in range(60_000)),
        "&a " * 300_000,
        HEAD + "".join(f"key{i:06}: 1\n" for i in range(70_000)),
        "\n" * 1_000_000,
        "# " + "x" * 1_000_000,
    ],
    ids=["deep", "long", "wide", "complex keys", "anchors", "keys", "lines", "comment"],
)
def test_the_worst_file_within_the_caps_is_judged_in_little_time_and_memory(executable, tmp_path, text):
    path = tmp_path / "worst.yaml"
    path.write_text(text[: 1 << 20])
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (512 << 20, 512 << 20))  # noqa: E731  address space, not only what is used

    def judged():
        before = cpu_seconds_of_children()
        result = subprocess.run([executable, "check", path], capture_output=True, preexec_fn=limit, timeout=600)
        assert result.returncode == SCENARIO_EXIT
        return cpu_seconds_of_children() - before

    assert once_within(0.3, judged)  # a hundredth to a tenth where nothing else shares the core


def test_control_codes_never_reach_the_terminal(refused):
    message = refused(HEAD + '"k\\x1b[31m": 1\nname: "a\\x1b]0;x\\x07"\n')
    assert "\x1b" not in message and "\x07" not in message and "\\u001b" in message


def test_control_codes_in_a_file_name(cli, tmp_path):
    path = tmp_path / "\x1b[31m.yaml"
    path.write_text("format: x\n")
    assert "\x1b" not in cli("check", path).stderr


def test_a_long_key_is_cut_short(refused):
    message = refused(HEAD + "k" * 900 + ": 1\n")
    assert len(message) < 500 and "..." in message


@pytest.mark.parametrize(
    "text, place, path, meant",
    [
        ("wall:\n  contact: {stifness: 500}\n", "3:13", "wall.contact.stifness", "stiffness"),
        ("arm:\n  link2: {lenght: 1}\n", "3:11", "arm.link2.lenght", "length"),
        ("controler: {}\n", "2:1", "controler", "controller"),
        ("solver: {rtoll: 1e-9}\n", "2:10", "solver.rtoll", "rtol"),
        ("tiem: {stop: 1}\n", "2:1", "tiem", "time"),
        ("stifness: 500\n", "2:1", "stifness", "wall.contact.stiffness or controller.stiffness"),
        ("arm: {log_evry: 1}\n", "2:7", "arm.log_evry", "time.log_every"),
    ],
)
def test_an_unknown_key_meets_the_nearest_one(refused, text, place, path, meant):
    message = refused(HEAD + text)
    assert f"s.yaml:{place}: error[scenario.unknown_key]: {path}: " in message and f"did you mean {meant}?" in message


def test_a_key_in_the_wrong_section_is_sent_to_the_right_one(refused):
    assert "`stiffness` belongs to wall.contact" in refused(HEAD + "wall: {stiffness: 500}\n")
    assert "`section` belongs to shape brick; here the shape is cylinder" in refused(
        HEAD + "arm: {link2: {shape: cylinder, radius: 0.1, section: [0.01, 0.01]}}\n"
    )


def test_a_section_in_another_one_is_sent_to_the_top_level(refused):
    schema = json.loads((ROOT / "docs/scenario.schema.json").read_text())
    sections = [name for name, key in schema["properties"].items() if "$ref" in key]
    assert {"wall", "controller", "reference", "sampling"} <= set(sections)
    for inner in (name for name in sections if name != "wall"):
        message = refused(HEAD + f"wall: {{{inner}: {{}}}}\n")
        assert f"`{inner}` stands at the top level of a scenario, beside `wall`" in message
    assert "the keys of `wall` stand directly under it" in refused(HEAD + "wall: {wall: {point: [1, 0, 0]}}\n")
    controller = "wall: {}\ncontroller: {type: hybrid, reference: {type: hold}}\n"
    assert "`reference` stands at the top level of a scenario, beside `controller`" in refused(HEAD + controller)
    assert "`initial` belongs to reference.force" in refused(HEAD + "reference: {initial: 1}\n")  # a key within


def test_the_controllers_copy_of_the_arm_belongs_to_controllers_that_use_it(refused):
    message = refused(HEAD + "controller: {model: {link2: {mass: 1}}}\n")
    assert "`mass` does not go with type none; take it out, or choose another controller.type" in message
    assert "`model` belongs to arm or controller" in refused(HEAD + "model: {link2: {mass: 1}}\n")


def test_a_missing_key_names_its_parent(refused):
    message = refused(HEAD + "wall:\n  motion: {type: sinusoid, frequency: 1}\n")
    assert "s.yaml:3:3: error[scenario.missing_key]: wall.motion.amplitude" in message and "a number, m" in message


@pytest.mark.parametrize(
    "text, place, expected, got",
    [
        ("initial: {q: [1, 2]}\n", "2:14", "a list of 3 numbers (rad)", "a list of 2"),
        ("initial: {q: {a: 1}}\n", "2:14", "a list of 3 numbers (rad)", "a map"),
        ("initial: {q: 1}\n", "2:14", "a list of 3 numbers (rad)", "1"),
        ("time: {stop: [1]}\n", "2:14", "a number (s)", "a list of 1"),
        ("time: 5\n", "2:7", "a map", "5"),
        ("arm: [1]\n", "2:6", "a map", "a list of 1"),
        ("wall: {contact: {stiffness: [1, 2, 3]}}\n", "2:29", "a number (N/m)", "a list of 3"),
        ("wall: {contact: {law: diagonal, stiffness: 5}}\n", "2:44", "a list of 3 numbers (N/m)", "5"),
        ("checks: 5\n", "2:9", "a list of checks", "5"),
    ],
)
def test_wrong_shapes(refused, text, place, expected, got):
    message = refused(HEAD + text)
    assert f"s.yaml:{place}: " in message and f"expects {expected}, got {got}" in message


def test_all_errors_at_once_in_the_order_of_the_file(refused):
    message = refused(
        HEAD + "nam: x\narm: {dampin: 1}\nwall: {size: 7}\ntime: {stop: 1s}\nsolver: {rtol: -1, atol: 'x'}\n"
    )
    lines = [int(line.split(":")[1]) for line in message.splitlines()]
    assert lines == [2, 3, 4, 5, 6, 6] or lines == [2, 3, 4, 5, 6]


def test_no_more_than_20(refused):
    assert len(refused(HEAD + "".join(f"key{i}: 1\n" for i in range(50))).splitlines()) == 20


def test_another_format(check):
    outcome = check("format: 3\nnothing: known\n")
    assert outcome.code == FORMAT_EXIT
    assert "s.yaml:1:9: error[scenario.format]: format: written for format 3, this is 1" in outcome.message


def test_the_format_must_be_given(refused):
    assert "write `format: 1`" in refused("name: x\n")


@pytest.mark.parametrize("name", ["../../x", "/etc/x", "a/b", '"a\\nb"', ".hidden", "-o", '""', "x" * 300])
def test_a_name_cannot_lead_elsewhere(refused, name):
    assert "error[scenario.name]" in refused(HEAD + f"name: {name}\n")


def test_a_link_or_a_device_is_not_written_through(cli, tmp_path, moving_wall):
    target, link = tmp_path / "precious", tmp_path / "link.csv"
    target.write_text("precious")
    link.symlink_to(target)
    assert cli("run", moving_wall, "--set", "time.stop=0", "--set", "checks=[]", "-o", link).returncode == 0
    assert target.read_text() == "precious" and not link.is_symlink()
    result = cli("run", moving_wall, "-o", "/dev/full")
    assert result.returncode == 6 and stat.S_ISCHR(os.stat("/dev/full").st_mode)


def test_no_scenario_loads_code(refused):
    assert "error[scenario.unknown_key]" in refused(HEAD + "controller: {library: ./evil.so}\n")
    assert "error[scenario.unknown_word]" in refused(HEAD + "controller: {type: ./evil.so}\n")


@pytest.mark.parametrize("text", ['"": 1\n', 'time: {"": 3}\n'])
def test_an_empty_key_is_no_word(refused, text):
    assert "error[yaml.key]" in refused(HEAD + text)


# ---- B: numbers -----------------------------------------------------------------------------------------------------


def number(refused, value: str) -> str:
    return refused(HEAD + f"time: {{stop: {value}}}\n")


@pytest.mark.parametrize(
    "value", ["1e999", "-1e999", "1.7976931348623159e308", "1" + "0" * 400, "1e99999999999999999999"]
)
def test_too_large(refused, value):
    assert "out of double range" in number(refused, value)


@pytest.mark.parametrize("value", ["1e-999", "4.9e-324", "0." + "0" * 400 + "1", "-1e-99999999999999999999"])
def test_too_small(refused, value):
    assert "underflows" in number(refused, value)


@pytest.mark.parametrize("value", [".nan", ".inf", "nan", "inf", "NaN", "-inf", "-.INF", "Infinity"])
def test_only_finite_numbers(refused, value):
    assert "error[number.syntax]" in number(refused, value)


def test_except_where_no_limit_is_meant(check, refused):
    assert check(HEAD + "arm: {torque_limit: [inf, 5, inf]}\n").code == 0
    assert "write inf" in refused(HEAD + "arm: {torque_limit: [.inf, 5, inf]}\n")
    assert "error[scenario.range]" in refused(HEAD + "arm: {torque_limit: [-inf, 5, inf]}\n")
    for size in ["[inf, inf]", "inf", ".inf"]:
        assert "; write infinite" in refused(HEAD + f"wall: {{size: {size}}}\n")


@pytest.mark.parametrize(
    "value, hint",
    [("010", "write 10"), ("-010.5", "write -10.5"), ("00", "write 0"), ("0o10", "would be 8"), ("0x10", "would be 16"),
     ("0b101", "would be 5"), ("1_000", "write 1000"), ("60:30", "sexagesimal")],
)  # fmt: skip
def test_decimal_only(refused, value, hint):
    assert hint in number(refused, value)


def test_a_comma_and_a_locale_with_commas(refused, cli, tmp_path):
    assert "use a point: 1.5" in refused(HEAD + "time:\n  stop: 1,5\n")
    assert "use a point: 1.5" in refused(HEAD + "time: {stop: 1,5}\n")
    assert "in a number use a point" in refused(HEAD + "arm: {gravity: [0, 0, -9,81]}\n")
    path = tmp_path / "s.yaml"
    path.write_text(HEAD + "time: {stop: 0.5}\n")
    german = cli("check", path, env={**os.environ, "LC_ALL": "de_DE.UTF-8"})
    assert german.stdout == cli("check", path).stdout and "stop: 0.5 " in german.stdout


@pytest.mark.parametrize(
    "value, meant", [("NO", "false"), ("y", "true"), ("on", "true"), ("Off", "false"), ("1", "true"), ("True", "true")]
)
def test_flags_are_true_or_false(refused, value, meant):
    assert f"write {meant}" in refused(HEAD + f"wall: {{acts_on_arm: {value}}}\n")


@pytest.mark.parametrize(
    "value, says",
    [('"1.5"', "no quotes"), ("'0.01 '", "no quotes"), ("1.5 2.5", "at character 4"), ("1.5f", "'f' at character 4"),
     ("\u22121.5", "minus"), ("\u0661\u0662", "not a number"),
     ("1.", "write 1 or 1.0"), ("1E5", "small e"), ("+-1", "not a number"),
     ("1e", "at character 2"), ("--1", "not a number"), ("e5", "not a number"), (".", "not a number")],
)  # fmt: skip
def test_what_only_looks_like_a_number(refused, value, says):
    assert says in number(refused, value)


def test_units_are_answered_with_the_plain_number(refused):
    assert "write 0.5 (m)" in refused(HEAD + "arm: {link2: {length: 50 cm}}\n")
    assert "write 30 deg" in refused(HEAD + "initial: {q: [0, 30deg, 0]}\n")
    assert "degrees" in refused(HEAD + "arm: {link2: {length: 50 deg}}\n")
    assert "write 0.05 (m/s)" in refused(HEAD + "wall: {motion: {velocity: 5 cm/s}}\n")
    assert "plain SI, without their unit" in refused(HEAD + "wall: {motion: {velocity: 5 furlong}}\n")


@pytest.mark.parametrize("value", ["3.7", "2147483648", "99999999999", "1e3", "0", "-5"])
def test_integers_neither_round_nor_wrap(refused, value):
    assert "solver.max_steps" in refused(HEAD + f"solver: {{max_steps: {value}}}\n")


def test_negative_zero_is_zero():
    scenario = arm3r.Scenario(HEAD + "arm: {damping: [-0.0, -0, -0e5]}\n")
    assert "damping: [0, 0, 0]" in scenario.to_yaml()


def test_long_decimals_are_rounded_correctly():
    text = "0.1" + "0" * 5000
    assert "stop: 0.1\n" in arm3r.Scenario(HEAD + f"time: {{stop: {text}}}\n").to_yaml()
    digits = "0.1000000000000000055511151231257827021181583404541015625" + "0" * 345
    assert "stop: 0.1\n" in arm3r.Scenario(HEAD + f"time: {{stop: {digits}}}\n").to_yaml()


@pytest.mark.parametrize("value", [".5", "+.5", "5e-1", "0.5", "+0.5e+0", "50e-02"])
def test_b_every_legal_form_of_one_half(value):
    assert "stop: 0.5\n" in arm3r.Scenario(HEAD + f"time: {{stop: {value}}}\n").to_yaml()


# ---- checks ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "claim, says",
    [
        ("{column: q1, event: make, equals: 1}", "only one subject may stand in a check, got column and event"),
        ("{event: brake, equals: 1}", "did you mean break?"),
        ("{event: make, at: 1, equals: 1}", "a check with `event` has no such key"),
        ("{column: q1, of: max, above: 2, below: 1}", "no value is above 2 and below 1"),
        ("{column: q1, of: max, above: 2, below: 2}", "no value is above 2 and below 2"),
    ],
)
def test_a_check_that_cannot_be_meant_is_refused(refused, claim, says):
    assert says in refused(HEAD + f"checks: [{claim}]\n")


def test_on_part_of_a_run_only_its_rows_and_events_are_judged():
    ended_early = arm3r.Scenario(
        HEAD
        + """
solver: {max_steps: 20}
wall: {point: [1.75, 0, 0]}
checks:
  - {name: start, column: t, at: 0, equals: 0}
  - {name: end, column: t, at: 10, equals: 10}
  - {name: made, event: make, equals: 0, abs: 10}
  - {name: largest, column: t, of: max, below: 1e3}
  - {name: last, column: t, of: final, below: 1e3}
  - {name: force, summary: peak_force, below: 1e9}
  - {name: lost, count: break, equals: 0}
"""
    )
    with pytest.raises(arm3r.BudgetError) as error:
        ended_early.run()
    run = error.value.run
    checks = {check["name"]: check for check in run.checks}
    assert {name for name, check in checks.items() if check["passed"]} == {"start", "made"}
    for name in ["largest", "last", "force", "lost"]:
        assert checks[name]["value"] is None
        assert checks[name]["reason"] == f"the run ended at t = {run.summary['t_end']} s"


def test_one_event_is_one_event():
    scenario = arm3r.Scenario(HEAD + "time: {stop: 6}\ncontroller: {type: gravity_compensation}\nwall: {}\n")
    scenario["checks"] = [{"name": "second", "event": "make", "index": 1, "equals": 1}]
    assert scenario.run().checks[0]["reason"] == "there was 1 make event"


# ---- what `arm3r check` prints --------------------------------------------------------------------------------------


def test_the_resolved_scenario_is_a_scenario_with_the_same_numbers(root):
    for file in scenario_files():
        first = arm3r.Scenario.load(file)
        again = arm3r.Scenario(first.to_yaml())
        assert again.to_yaml() == first.to_yaml()


def test_every_value_names_its_origin(cli, tmp_path):
    (tmp_path / "s.yaml").write_text(FULL)
    text = cli("check", "s.yaml", "--set", "time.stop=1", cwd=tmp_path).stdout
    lines = [line for line in text.splitlines() if ": " in line and not line.strip().startswith(("#", "-"))]
    assert all(re.search(r"# (s\.yaml:\d+|--set|lecture|inferred|our choice|file)", line) for line in lines)
    assert re.search(r"stop: 1 +# --set", text) and re.search(r"radius: 0.02 +# s.yaml:5", text)


def test_what_the_plant_has_not_is_not_printed_as_the_plants(cli):
    text = HEAD + "arm: {link2: {shape: cylinder, radius: 0.01}}\n"
    text += "controller: {type: gravity_compensation, model: {link2: {shape: brick, mass: 1}}}\n"
    model = cli("check", "-", input=text).stdout.split("\n  model:\n")[1]
    assert "length: as the plant" in model and "section" not in model


def test_check_names_likely_slips(cli, tmp_path):
    (tmp_path / "s.yaml").write_text(HEAD + "initial: {q: [0, 90, 0]}\n")
    result = cli("check", "s.yaml", cwd=tmp_path)
    assert result.returncode == 0
    assert result.stderr.startswith("s.yaml: warning: initial.q[1] is more than a full turn, 90 rad")


# ---- --set ----------------------------------------------------------------------------------------------------------


def test_set_of_a_new_type_drops_the_keys_of_the_old(check):
    assert (
        check(
            FULL, "--set", "wall.motion.type=fixed", "--set", "wall.contact.law=spring", "--set", "solver.method=dopri5"
        ).code
        == 0
    )


def test_set_reports_its_own_place_and_the_path(refused):
    assert "--set time.stop=1s: error[number.syntax]: time.stop: " in refused(HEAD, "--set", "time.stop=1s")
    assert "--set time.stop=  1s:3: error[number.syntax]: time.stop: " in refused(HEAD, "--set", "time.stop=  1s")
    assert "did you mean stiffness?" in refused(HEAD, "--set", "wall.contact.stifness=1")


@pytest.mark.parametrize(
    "wrong, says",
    [
        ("time.stop=-1", "error[scenario.range]: time.stop: "),
        ("wall..x=1", "error[path.syntax]: wall..x: "),
        ("initial.q[0=1", "error[path.syntax]: initial.q[0: "),
        ("arm.link2.mass=&x 1", "error[yaml.anchor]: arm.link2.mass: "),
        ("arm.link2.mass=[1", "error[yaml.syntax]: arm.link2.mass: "),
        ("initial.q[3]=1", "error[path.index]: initial.q[3]: `initial.q` has 3 items"),
        ("checks[1]=1", "error[path.index]: checks[1]: `checks` has 0 items"),
    ],
)
def test_of_several_sets_the_wrong_one_is_named(refused, wrong, says):
    message = refused(HEAD, "--set", "wall={}", "--set", wrong, "--set", "time.log_every=0.1")
    assert message.startswith(f"--set {wrong}: {says}") and message.count("\n") == 1


def test_the_path_inside_a_set_value_is_whole(refused):
    assert "error[yaml.anchor]: checks[0].at: " in refused(HEAD, "--set", "checks=[{at: &x 1}]")


def test_a_value_set_from_python_is_not_called_an_option():
    scenario = arm3r.Scenario(HEAD)
    scenario["time.stop"] = -1
    with pytest.raises(arm3r.ScenarioError, match=r"^set time\.stop=-1: error\[scenario\.range\]: time\.stop: "):
        scenario.validate()
    scenario["time.stop"] = 1
    assert re.search(r"stop: 1 +# set\n", scenario.to_yaml(annotate=True))


ONE_NUMBER_OR_A_LIST = [
    ("wall.motion.velocity", ["wall={}"]),
    ("wall.contact.stiffness", ["wall.contact.law=diagonal"]),
    ("controller.gravity", ["controller.type=gravity_compensation"]),
]


@pytest.mark.parametrize("path, before", ONE_NUMBER_OR_A_LIST)
def test_an_item_of_what_may_be_one_number_needs_the_list(check, refused, path, before):
    sets = [word for edit in before for word in ("--set", edit)]
    message = refused(HEAD, *sets, "--set", f"{path}[0]=1")
    assert f"`{path}` can be a single number" in message and "give the whole list" in message
    assert check(HEAD, *sets, "--set", f"{path}=[3, 2, 1]", "--set", f"{path}[0]=1").code == 0


def test_an_item_of_a_number_that_stands_there_needs_the_list(refused):
    message = refused(HEAD + "wall: {motion: {velocity: 0.5}}\n", "--set", "wall.motion.velocity[0]=1")
    assert "is 0.5, not a list; give the whole list" in message


@pytest.mark.parametrize("nothing", ["", " ", "~", "# 5"])
def test_only_null_takes_a_key_out(cli, refused, tmp_path, nothing):
    text = HEAD + "wall: {contact: {stiffness: 500}}\n"
    assert "there is no value" in refused(text, "--set", f"wall.contact.stiffness={nothing}")
    (tmp_path / "s.yaml").write_text(text)
    assert "stiffness: 1000 " in cli("check", "s.yaml", "--set", "wall.contact.stiffness=null", cwd=tmp_path).stdout


def test_null_needs_a_key_to_take_out(check, refused):
    assert "did you mean wall.contact.stiffness?" in refused(HEAD, "--set", "wall.contact.stifness=null")
    assert "no such key" in refused(HEAD, "--set", "checks[0]=null")
    for known in ["wall", "wall.contact", "time.stop", "checks", "name"]:
        assert check(HEAD, "--set", f"{known}=null").code == 0
    assert check(HEAD + "stifness: 1\n", "--set", "stifness=null").code == 0


def test_set_of_one_item_leaves_the_others(cli, tmp_path):
    (tmp_path / "s.yaml").write_text(HEAD)
    text = cli("check", "s.yaml", "--set", "initial.q[1]=0", cwd=tmp_path).stdout
    assert "q: [0, 0, 1.0471975511965976]" in text


# ---- the executable -------------------------------------------------------------------------------------------------


def test_output_that_cannot_be_written_exits_6_and_leaves_nothing(cli, tmp_path, moving_wall):
    result = cli("run", moving_wall, "-o", tmp_path / "none" / "x.csv")
    assert result.returncode == 6 and "No such file or directory" in result.stderr
    with open("/dev/full", "w") as full:
        result = cli("run", moving_wall, "-o", "-", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert result.returncode == 6 and "No space left on device" in result.stderr
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))  # noqa: E731
    result = cli("run", moving_wall, "-o", tmp_path / "x.csv", preexec_fn=limit)
    assert result.returncode == 6 and "File too large" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_closed_pipe_ends_by_sigpipe(executable, moving_wall):
    command = subprocess.Popen(
        [executable, "run", moving_wall, "-o", "-"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    command.stdout.close()
    assert command.wait(timeout=600) == -signal.SIGPIPE


def test_a_closed_pipe_ends_quietly_where_the_caller_ignores_sigpipe(executable, moving_wall):
    ignore = lambda: signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # noqa: E731
    command = subprocess.Popen(
        [executable, "run", moving_wall, "-o", "-"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=ignore
    )
    command.stdout.close()
    assert command.stderr.read() == b"" and command.wait(timeout=600) == -signal.SIGPIPE


LONG_TIME = "time={stop: 1e6, log_every: 1e3}"
MANY_STEPS = "solver={method: rk4, step: 1e-3, max_steps: 1000000000}"
LONG_RUN = ["--set", LONG_TIME, "--set", MANY_STEPS, "--set", "checks=[]"]


@pytest.mark.timed
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_run_within_100_ms_by_the_signal_itself(executable, tmp_path, moving_wall, number):
    def delay():
        ours = signal.signal(number, signal.default_int_handler)  # nohup has it ignored, also by what is started here
        run = subprocess.Popen(
            [executable, "run", moving_wall, *LONG_RUN, "-o", tmp_path / "x.csv"], stderr=subprocess.PIPE
        )
        signal.signal(number, ours)
        try:
            time.sleep(0.3)
            assert run.poll() is None, run.stderr.read()
            begin = time.monotonic()
            run.send_signal(number)
            assert run.wait(timeout=600) == -number
            assert list(tmp_path.iterdir()) == []
            return time.monotonic() - begin
        finally:
            run.kill()  # where it does not end

    assert once_within(0.1, delay)


def test_a_time_limit_exits_5_and_keeps_the_rows(cli, tmp_path, moving_wall):
    result = cli("run", moving_wall, *LONG_RUN, "--time-limit", "0.2", "-o", tmp_path / "x.csv")
    assert result.returncode == 5 and "budget" in result.stdout
    assert (tmp_path / "x.csv").exists() and '"budget"' in (tmp_path / "x.json").read_text()


def test_too_little_memory_exits_5_and_says_what_takes_it(cli, moving_wall):
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (512 << 20, 512 << 20))  # noqa: E731
    result = cli("run", moving_wall, "--set", "time.log_every=3e-6", "--set", "checks=[]", preexec_fn=limit)
    assert result.returncode == 5
    assert "error[memory]: there is not enough memory" in result.stderr and "time.log_every" in result.stderr


def test_a_failed_check_exits_10(cli, moving_wall):
    result = cli("run", moving_wall, "--set", "checks=[{name: impossible, column: t, of: max, below: 1}]")
    assert result.returncode == 10 and "FAIL  impossible" in result.stdout


def test_an_unknown_call_is_met_with_the_likely_one(cli):
    result = cli("rnu", "x.yaml")
    assert result.returncode == USAGE_EXIT and "did you mean run? See arm3r --help" in result.stderr
    assert "no program arm3r-nothing; see arm3r --help" in cli("nothing").stderr


@pytest.mark.parametrize("typed", ["--out", "--outptu", "-output", "-output=x.csv"])
def test_an_unknown_option_is_met_with_the_likely_one(cli, moving_wall, typed):
    result = cli("run", moving_wall, typed, "x.csv")
    assert result.returncode == USAGE_EXIT and "did you mean --output?" in result.stderr


@pytest.mark.parametrize("words", [["-o", "x.csv"], ["-ox.csv"], ["-o=x.csv"], ["--output=x.csv"]])
def test_an_option_and_its_value_in_one_word_or_two(cli, tmp_path, moving_wall, words):
    assert cli("run", moving_wall, "--set", "time.stop=0", "--set", "checks=[]", *words, cwd=tmp_path).returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.csv", "x.json"]


def test_an_empty_file_name_is_called_that(cli):
    result = cli("check", "")
    assert result.returncode == USAGE_EXIT and "the file name is empty" in result.stderr
    with pytest.raises(arm3r.OutputError, match="the file name is empty"):
        arm3r.Scenario(HEAD + "time: {stop: 0}\n").run().to_csv("")


def test_another_program_is_found_on_the_path(cli, tmp_path):
    program = tmp_path / "arm3r-hello"
    program.write_text('#!/bin/sh\necho "$@"\n')
    program.chmod(0o755)
    result = cli("hello", "--json", "a b", env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"})
    assert result.stdout == "--json a b\n"


def test_two_scenarios_of_one_name_do_not_share_a_file(cli, tmp_path):
    for name in ["a.yaml", "b.yaml"]:
        (tmp_path / name).write_text(HEAD + "name: same\ntime: {stop: 0}\n")
    result = cli("run", tmp_path / "a.yaml", tmp_path / "b.yaml", "-o", tmp_path)
    assert result.returncode == USAGE_EXIT and "same.csv" in result.stderr


def test_a_scenario_is_not_overwritten_by_its_own_results(cli, tmp_path):
    path = tmp_path / "s.yaml"
    path.write_text(HEAD)
    assert cli("run", path, "-o", path).returncode == USAGE_EXIT and path.read_text() == HEAD


def test_a_scenario_is_not_overwritten_by_its_own_summary(cli, tmp_path):
    path = tmp_path / "a.json"
    path.write_text(HEAD)
    for output in [tmp_path / "a.csv", tmp_path]:
        result = cli("run", path, "-o", output)
        assert result.returncode == USAGE_EXIT and "a.json: error[usage]: this would overwrite" in result.stderr
        assert path.read_text() == HEAD and list(tmp_path.iterdir()) == [path]


def test_the_template_is_a_scenario(cli):
    template = cli("template").stdout
    assert cli("check", "-", input=template).returncode == 0


@pytest.mark.parametrize("call", ["check", "run"])
def test_a_run_that_would_be_too_large_is_refused_before_it_begins(cli, tmp_path, call):
    path = tmp_path / "long.yaml"
    path.write_text("format: 1\ntime: {stop: 1e9, log_every: 1e-9}\n")
    result = cli(call, path)
    assert result.returncode == 5
    assert f"{path}:2:30: error[budget.rows]: time.log_every" in result.stderr
