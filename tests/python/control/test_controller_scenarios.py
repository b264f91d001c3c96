"""Scenarios with controllers: what each type resolves to, and what is said of keys that do not go together."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest

SLIDE = "format: 1\narm: {convention: slide}\ninitial: {q: [20 deg, 40 deg, -75 deg]}\n"
WALL = "wall: {acts_on_arm: true}\n"
TYPES = {
    "none": "",
    "constant": "torque: [1, 2, 3]",
    "gravity_compensation": "",
    "joint_pd": "",
    "computed_torque": "",
    "resolved_acceleration": "",
    "stiffness": "",
    "joint_stiffness": "",
    "impedance": "",
    "shaped_impedance": "",
    "operational_space": "",
    "hybrid": "",
    "parallel": "",
    "admittance": "",
    "adaptive_reference": "",
    "energy_tank": "",
    "virtual_wall": "",
    "user": "",
}
TABLE = "type: table, t: [0, 1, 2.5], x: [1.5, 1.6, 1.5], y: [0.3, 0.2, 0.4], z: [0, 0.1, 0.2]"
Check = Callable[..., "subprocess.CompletedProcess[str]"]


def controller(type_name: str, gains: str = "") -> str:
    keys = [f"type: {type_name}", *(keys for keys in (TYPES[type_name], gains) if keys)]
    return "controller: {" + ", ".join(keys) + "}\n"


@pytest.fixture
def check(cli, tmp_path: Path) -> Check:
    """check(text, *options): `arm3r check` of a file called s.yaml."""

    def call(text: str, *options: str) -> subprocess.CompletedProcess[str]:
        (tmp_path / "s.yaml").write_text(text)
        return cli("check", "s.yaml", *options, cwd=tmp_path)

    return call


@pytest.fixture
def refused(check) -> Callable[[str], str]:
    """refused(text): the only message about a scenario, which must exit with 3."""

    def call(text: str) -> str:
        result = check(text)
        assert result.returncode == 3, result
        assert result.stderr.count("\n") == 1, result.stderr
        return result.stderr

    return call


@pytest.fixture
def warned(check) -> Callable[[str], str]:
    """warned(text): the likely slips of a scenario that is in order."""

    def call(text: str) -> str:
        result = check(text)
        assert result.returncode == 0, result.stderr
        return result.stderr

    return call


# ---- every type -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("type_name", TYPES)
def test_the_resolved_scenario_of_every_type_is_one_with_the_same_numbers(check, type_name: str) -> None:
    text = SLIDE + WALL + controller(type_name)
    resolved = check(text)
    assert resolved.returncode == 0, resolved.stderr
    again = check(resolved.stdout)
    assert again.returncode == 0, again.stderr
    numbers = [arm3r.Scenario(each).params for each in (text, resolved.stdout, again.stdout)]
    assert all(np.array_equal(numbers[0], other, equal_nan=True) for other in numbers[1:])


@pytest.mark.parametrize("type_name", [name for name in TYPES if name != "user"])
def test_the_resolved_scenario_of_every_type_runs_to_the_same_hash(cli, tmp_path: Path, type_name: str) -> None:
    text = SLIDE + WALL + controller(type_name) + "time: {stop: 0.05}\nsolver: {method: rk4}\n"
    (tmp_path / "s.yaml").write_text(text)
    (tmp_path / "resolved.yaml").write_text(cli("check", tmp_path / "s.yaml").stdout)
    runs = cli("run", tmp_path / "s.yaml", tmp_path / "resolved.yaml", "--json").stdout
    first, second = (run["hash"] for run in json.loads(runs))
    assert first == second


@pytest.mark.parametrize(
    "section",
    [
        "sampling: {rate: 500, delay: 1.5, seed: 7}\n",
        "sampling: {}\nsensors: {encoder: {counts: 4096}, velocity: {estimate: filtered, cutoff: 40}}\n",
        "sampling: {}\nsensors: {force: {noise: 0.1, bias: [1, 2, 3], cutoff: 30, delay: 2, tool_mass: 0.2}}\n",
        "sensors: {force: {analog_cutoff: 100, bias: [1, 0, 0]}}\n",
        "observer: {gain: [50, 40, 30]}\n",
        "sampling: {}\nobserver: {reaction: reflex, reflex_gain: 2}\n",
        "sampling: {}\nobserver: {reaction: retreat, joint_damping: [1, 2, 3]}\n",
        "estimator: {wall: fixed, forgetting: 0.9}\n",
        "push: {force: [-1, 2, 3], start: 0.5, duration: 0.2}\n",
        "push: {force: [-1, 2, 3], rise: 0.5}\n",
        "reference: {type: circle, radius: 0.05}\n",
        "reference: {" + TABLE + "}\n",
        "reference: {type: line, tip: [1.6, 0.3, 0.1], start: 1}\n",
        "reference: {type: sinusoid, tip_amplitude: [0, 0, 0.01]}\n",
        "reference: {type: point, q: [10 deg, 20 deg, -60 deg], force: {type: sinusoid, amplitude: 2}}\n",
    ],
)
def test_sections_beside_a_controller_resolve_to_themselves(check, section: str) -> None:
    text = SLIDE + WALL + controller("hybrid") + section
    resolved = check(text)
    assert resolved.returncode == 0, resolved.stderr
    numbers = [arm3r.Scenario(each).params for each in (text, resolved.stdout)]
    assert np.array_equal(*numbers, equal_nan=True)
    assert not np.array_equal(numbers[0], arm3r.Scenario(SLIDE + WALL + controller("hybrid")).params, equal_nan=True)


def test_defaults_are_those_of_the_type() -> None:
    def gains(type_name: str, *names: str) -> list[object]:
        scenario = arm3r.Scenario(SLIDE + WALL + controller(type_name))
        return [scenario["controller." + name] for name in names]

    assert gains("stiffness", "stiffness", "damping") == [500, 100]
    assert gains("shaped_impedance", "mass", "damping", "stiffness") == [2, 40, 200]
    assert gains("computed_torque", "position_gain", "velocity_gain", "cancel_force") == [100, 20, False]
    assert gains("resolved_acceleration", "position_gain", "velocity_gain", "cancel_force") == [100, 20, True]
    assert gains("hybrid", "force_mass", "force_damping", "force_gain", "force_integral_gain") == [1, 70, 0.5, 5]
    assert gains("hybrid", "position_gain", "velocity_gain") == [400, 40]
    assert gains("parallel", "force_mass", "damping", "stiffness", "force_gain", "force_integral_gain") == [
        1,
        80,
        100,
        0.5,
        6,
    ]
    assert gains("adaptive_reference", "mass", "damping", "stiffness", "reference_gain") == [2, 80, 200, 0.02]
    assert gains("energy_tank", "tank_energy", "tank_low", "tank_high", "tank_capacity") == [0.05, 0.01, 0.03, 5]


def test_gains_vary_by_name_in_a_batch() -> None:
    text = SLIDE + WALL + controller("energy_tank") + "time: {stop: 0.01}\nsolver: {method: rk4}\n"
    scenario = arm3r.Scenario(text)
    batch = scenario.batch({"controller.stiffness": [100.0, 200.0, 300.0], "controller.tank_low": [0.01, 0.04, 0.02]})
    assert [str(outcome) for outcome in batch.outcomes] == ["ok", "invalid", "ok"]
    scenario["controller.damping"] = [0.3, 0.4, 0.5]
    each = scenario.batch({"controller.damping[1]": [0.1, 0.2], "controller.tank_energy": [0.02, 0.03]}, grid=True)
    assert each.ok.all() and each.ok.shape == (2, 2)


def test_a_new_type_drops_the_keys_of_the_old(check) -> None:
    text = SLIDE + WALL + controller("hybrid", "force_mass: 2, model: {link3: {mass: 0.9}}")
    text += "reference: {force: {value: 10}}\nsampling: {rate: 100}\n"
    assert check(text, "--set", "controller.type=stiffness").returncode == 0
    assert check(text, "--set", "controller.type=none").returncode == 0


# ---- keys that are not there ----------------------------------------------------------------------------------------


def test_a_key_of_most_types_names_the_type_that_has_it_not(refused) -> None:
    message = refused(SLIDE + "controller: {type: none, gravity: 9}\n")
    assert "error[scenario.other_choice]: controller.gravity: `gravity` does not go with type none" in message


def test_a_key_of_few_types_names_them(refused) -> None:
    message = refused(SLIDE + controller("stiffness", "tank: false"))
    assert "`tank` belongs to type energy_tank; here the type is stiffness" in message


@pytest.mark.parametrize("section", ["sampling", "sensors"])
@pytest.mark.parametrize("type_name", ["none", "constant"])
def test_what_computes_nothing_takes_no_samples(refused, section: str, type_name: str) -> None:
    message = refused(SLIDE + controller(type_name) + section + ": {}\n")
    assert f"{section}: `{section}` does not go with type {type_name}" in message
    assert "take it out, or choose another controller.type" in message


# ---- rules ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("type_name", ["operational_space", "hybrid", "parallel", "adaptive_reference"])
def test_force_is_controlled_on_a_wall(refused, type_name: str) -> None:
    message = refused(SLIDE + controller(type_name))
    assert f"scenario.needs_wall]: controller.type: {type_name} controls the force on a wall, and there is" in message
    assert "`wall: {}`" in message


def test_other_things_that_need_a_wall(refused, check) -> None:
    assert "reference.force.value: this is a force on the wall" in refused(
        SLIDE + controller("admittance") + "reference: {force: {value: 5}}\n"
    )
    assert "estimator: it estimates the stiffness of the wall" in refused(
        SLIDE + controller("stiffness") + "estimator: {}\n"
    )
    assert check(SLIDE + controller("admittance")).returncode == 0


@pytest.mark.parametrize(
    "reference, says",
    [
        ("type: point", "scenario.missing_key]: reference.tip: reference.type point needs a target"),
        ("type: line", "scenario.missing_key]: reference.tip: reference.type line needs a target"),
        ("type: minimum_jerk", "either reference.tip or reference.q; give one of the two"),
        ("type: line, tip: [1.6, 0, 0], q: [0, 0, 1]", "scenario.conflict]: reference.tip: reference.q says it"),
        ("type: sinusoid", "scenario.missing_key]: reference.tip_amplitude: a sinusoid in positions of the tip"),
        ("type: sinusoid, q_amplitude: [1, 0, 0]", "scenario.conflict]: reference.q_amplitude: controller.type "),
    ],
)
def test_a_reference_of_the_tip_says_where_to(refused, reference: str, says: str) -> None:
    assert says in refused(SLIDE + controller("stiffness") + f"reference: {{{reference}}}\n")


@pytest.mark.parametrize(
    "wrong, says",
    [
        (
            "y: [0.3, 0.2, 0.4]; y: [0.3, 0.2]",
            "scenario.table]: reference.y: not as long as reference.t, got 2 numbers",
        ),
        ("1, 2.5; 1, 1", "scenario.table]: reference.t[2]: the instants of a table must increase, got 1 after 1"),
        ("1, 2.5]; 1]", "scenario.table]: reference.x: not as long as reference.t, got 3 numbers, allowed 2 numbers"),
        ("z: [0, 0.1, 0.2]; z: [0]", "reference.z: expects a list of 2 or more numbers"),
        (", z: [0, 0.1, 0.2]; ", "scenario.missing_key]: reference.z: "),
        ("0.1, 0.2]; 0.1, 2e6]", "scenario.range]: reference.z[2]: "),
    ],
)
def test_a_table_says_one_thing_of_each_instant(check, wrong: str, says: str) -> None:
    result = check(SLIDE + controller("stiffness") + f"reference: {{{TABLE.replace(*wrong.split('; '))}}}\n")
    assert result.returncode == 3 and says in result.stderr, result.stderr


@pytest.mark.parametrize("type_name", ["joint_pd", "computed_torque", "joint_stiffness"])
def test_a_joint_law_has_references_of_its_own(refused, check, type_name: str) -> None:
    def reference(text: str) -> str:
        return SLIDE + controller(type_name) + f"reference: {{{text}}}\n"

    assert "reference.type: a circle is a path of the tip" in refused(reference("type: circle"))
    assert "reference.type: a table is a path of the tip" in refused(reference(TABLE))
    assert f"controller.type {type_name} works in joint angles" in refused(
        reference("type: sinusoid, tip_amplitude: [0, 0, 0.1]")
    )
    assert "a list of 3 numbers, rad" in refused(reference("type: sinusoid"))
    far = refused(reference("type: point, tip: [1.2, 1.6, 0.9]"))
    assert "scenario.out_of_reach]: reference.tip: " in far
    assert "got 2.193171219946131 m from joint 2, allowed 0 to 2 m" in far
    assert "0 m from the axis of joint 1" in refused(reference("type: point, tip: [0, 0, 1.2]"))
    assert check(reference("type: point, tip: [1.2, 0.6, 0.9]")).returncode == 0


@pytest.mark.parametrize(
    "type_name, gains",
    [
        ("resolved_acceleration", ""),
        ("operational_space", ""),
        ("hybrid", ""),
        ("hybrid", "variant: raibert_craig"),
        ("hybrid", "variant: projected"),
        ("parallel", ""),
        ("shaped_impedance", ""),
        ("admittance", ""),
        ("admittance", "inner: position"),
        ("adaptive_reference", ""),
    ],
)
@pytest.mark.parametrize(
    "q, says",
    [
        ("[20 deg, 40 deg, 0]", "the elbow is straight or folded, got sin(q3) = 0, allowed |sin(q3)| >= 0.001"),
        ("[20 deg, 40 deg, 180 deg]", "the elbow is straight or folded"),
        ("[20 deg, 60 deg, 60 deg]", "the tip stands on the axis of joint 1"),
    ],
)
def test_a_law_that_inverts_the_jacobian_starts_where_it_can(
    check, type_name: str, gains: str, q: str, says: str
) -> None:
    text = f"format: 1\narm: {{convention: slide}}\ninitial: {{q: {q}}}\nwall: {{point: [5, 0, 0]}}\n"
    result = check(text + controller(type_name, gains))
    assert result.returncode == 3
    assert "scenario.singular]: initial.q: controller.type " + type_name + " inverts the Jacobian" in result.stderr
    assert says in result.stderr


@pytest.mark.parametrize(
    "type_name, gains",
    [
        ("stiffness", ""),
        ("impedance", ""),
        ("hybrid", "variant: jacobian_transpose"),
        ("admittance", "inner: joint_pd"),
    ],
)
def test_a_law_without_an_inverse_starts_anywhere(check, type_name: str, gains: str) -> None:
    text = "format: 1\narm: {convention: slide}\ninitial: {q: [20 deg, 40 deg, 0]}\nwall: {point: [5, 0, 0]}\n"
    assert check(text + controller(type_name, gains)).returncode == 0


@pytest.mark.parametrize(
    "type_name, gains, says",
    [
        ("energy_tank", "tank_low: 0.03", "controller.tank_low: must lie below controller.tank_high, got 0.03 J"),
        ("energy_tank", "tank_high: 6", "controller.tank_high: must lie not above controller.tank_capacity, got 6 J"),
        ("energy_tank", "tank_energy: 5.5", "controller.tank_energy: must lie not above controller.tank_capacity"),
        ("hybrid", "contact_off: 2", "controller.contact_off: must lie not above controller.contact_on, got 2 N"),
        ("hybrid", "force_mass: 0", "scenario.range]: controller.force_mass: "),
        ("shaped_impedance", "mass: [1, 0, 1]", "scenario.range]: controller.mass[1]: "),
        ("virtual_wall", "plane_normal: [0, 0, 0]", "controller.plane_normal: a direction needs a length"),
        ("adaptive_reference", "adaptation: indirect", "scenario.missing_key]: controller.assumed_stiffness: "),
    ],
)
def test_gains_that_contradict_each_other(refused, type_name: str, gains: str, says: str) -> None:
    assert says in refused(SLIDE + WALL + controller(type_name, gains))


def test_without_a_tank_its_levels_do_not_matter(check) -> None:
    assert check(SLIDE + controller("energy_tank", "tank: false, tank_low: 1")).returncode == 0


def test_the_controllers_copy_of_the_arm_must_be_an_arm(refused) -> None:
    message = refused(SLIDE + controller("stiffness", "model: {link3: {inertia: [0.1, 0.2, 0.31]}}"))
    assert "scenario.inertia]: controller.model.link3.inertia: " in message


# ---- samples --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "keys, path",
    [
        ("sensors: {encoder: {counts: 1024}}", "sensors.encoder.counts"),
        ("sensors: {velocity: {estimate: difference}}", "sensors.velocity.estimate"),
        ("sensors: {force: {noise: 0.1}}", "sensors.force.noise"),
        ("sensors: {force: {resolution: 0.1}}", "sensors.force.resolution"),
        ("sensors: {force: {cutoff: 50}}", "sensors.force.cutoff"),
        ("sensors: {force: {delay: 1}}", "sensors.force.delay"),
        ("sensors: {force: {tool_mass: 0.2}}", "sensors.force.tool_mass"),
        ("observer: {reaction: stop}", "observer.reaction"),
    ],
)
def test_what_there_is_only_in_samples(refused, check, keys: str, path: str) -> None:
    text = SLIDE + controller("stiffness") + keys + "\n"
    message = refused(text)
    assert f"error[scenario.needs_sampling]: {path}: " in message and "`sampling: {rate: 1000}`" in message
    assert check(text + "sampling: {}\n").returncode == 0


def test_passivity_is_watched_in_samples(refused, check) -> None:
    text = SLIDE + controller("virtual_wall", "passivity_control: true")
    assert "scenario.needs_sampling]: controller.passivity_control: " in refused(text)
    assert check(text + "sampling: {}\n").returncode == 0


def test_bias_and_a_filter_before_the_samples_are_continuous_too(check) -> None:
    text = SLIDE + controller("stiffness") + "sensors: {force: {bias: [1, 0, 0], analog_cutoff: 50}}\n"
    assert check(text).returncode == 0


def sampled(sampling: str, step: str) -> str:
    return SLIDE + controller("stiffness") + f"sampling: {{{sampling}}}\nsolver: {{method: rk4, step: {step}}}\n"


@pytest.mark.parametrize(
    "sampling, step, got, nearest",
    [
        ("rate: 1000", "0.0008", "8e-04", "0.001"),
        ("rate: 1000", "0.0007", "7e-04", "5e-04"),
        ("rate: 1000", "0.0003", "3e-04", "0.0003333333333333333"),
        ("rate: 1000", "0.003", "0.003", "0.001"),
        ("rate: 1000, delay: 0.5", "0.001", "0.001", "5e-04"),
        ("rate: 1000, delay: 1.25", "0.0005", "5e-04", "0.00025"),
    ],
)
def test_samples_fall_on_fixed_steps(refused, check, sampling: str, step: str, got: str, nearest: str) -> None:
    message = refused(sampled(sampling, step))
    assert "error[scenario.grid]: solver.step: " in message
    assert f"got {got} s" in message and f"the nearest is {nearest} s" in message
    assert check(sampled(sampling, nearest)).returncode == 0


def test_a_rate_whose_period_is_no_short_decimal_is_met_to_rounding(check) -> None:
    assert check(sampled("rate: 300", "0.0016666666666666668")).returncode == 0
    assert check(sampled("rate: 300", "0.00166666667")).returncode == 3


def test_taylor_needs_samples_of_a_law(refused, check) -> None:
    text = SLIDE + controller("stiffness") + "solver: {method: taylor}\n"
    message = refused(text)
    assert "scenario.no_series]: solver.method: taylor has no series of a law that computes continuously" in message
    assert "controller.type stiffness" in message
    assert check(text + "sampling: {}\n").returncode == 0
    limits = "arm: {convention: slide, torque_limit: [50, 50, 50]}\n"
    recursion = controller("gravity_compensation", "algorithm: recursion")
    text = "format: 1\n" + limits + recursion + "solver: {method: taylor}\n"
    assert check(text).returncode == 3
    assert check(text + "sampling: {}\n").returncode == 0


@pytest.mark.parametrize(
    "section, path",
    [
        ("push: {force: [1, 0, 0]}\nsampling: {}\n", "push"),
        ("observer: {}\n", "observer"),
        ("sampling: {}\nsensors: {force: {analog_cutoff: 9}}\n", "sensors.force.analog_cutoff"),
    ],
)
def test_taylor_says_what_else_it_has_no_series_of(refused, section: str, path: str) -> None:
    text = SLIDE + controller("gravity_compensation") + "solver: {method: taylor}\n" + section
    assert f"scenario.no_series]: {path}: taylor has no series of" in refused(text)


def test_too_many_samples_are_a_matter_of_budget(cli, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(SLIDE + controller("stiffness") + "sampling: {rate: 1e6}\n")
    result = cli("run", "s.yaml", "--set", "time.stop=101", cwd=tmp_path)
    assert result.returncode == 5
    assert "budget.ticks" in result.stderr and "sampling.rate" in result.stderr
    batch = arm3r.Scenario(SLIDE + controller("stiffness") + "sampling: {rate: 1e6}\ntime: {log_every: 50}\n")
    assert [str(o) for o in batch.batch({"time.stop": [1e-5, 101.0]}).outcomes] == ["ok", "budget"]


# ---- likely slips ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("type_name", [name for name in TYPES if name not in ("none", "constant", "user")])
def test_defaults_are_no_slip(warned, type_name: str) -> None:
    assert warned(SLIDE + WALL + controller(type_name)) == ""


@pytest.mark.parametrize(
    "text, says",
    [
        (
            "wall: {}\n" + controller("hybrid"),
            "controller.type hybrid presses on the wall and wall.acts_on_arm is false",
        ),
        (
            WALL + controller("hybrid", "force_integral_gain: 40"),
            "the force loop of controller.type hybrid is unstable: its polynomial is s^3 + 70 s^2 + 500 s + 40000, and "
            "controller.force_integral_gain must stay below 35 1/s",
        ),
        (
            WALL + controller("operational_space", "force_integral_gain: 40"),
            "controller.type operational_space is unstable: its polynomial is s^3 + 70 s^2 + 500 s + 40000",
        ),
        (
            WALL + controller("parallel", "force_integral_gain: 50"),
            "its polynomial is s^3 + 80 s^2 + 600 s + 50000, and controller.force_integral_gain must stay below 48 1/s",
        ),
        (WALL + controller("hybrid", "force_damping: 0"), "and it has no damping"),
        (
            "wall: {acts_on_arm: true, contact: {stiffness: 1483.2}}\n" + controller("admittance", "inner: position"),
            "wall.contact.stiffness is 1483.2 N/m, and this admittance over this inner loop is stable on walls up to "
            "1440 N/m only",
        ),
        (
            "wall: {acts_on_arm: true, contact: {stiffness: 5000}}\n"
            + controller("adaptive_reference", "reference_gain: 0.21"),
            "controller.reference_gain is 0.21 m/(N s), and the loop is stable below 0.208",
        ),
        (
            WALL + controller("shaped_impedance", "mass: 0.1"),
            "controller.mass is 0.1 kg along the wall's normal, less than a third of the ",
        ),
        (
            WALL + controller("hybrid", "variant: raibert_craig"),
            "hybrid variant raibert_craig is unstable in part of the workspace",
        ),
        (
            controller("computed_torque", "position_gain: 400, velocity_gain: 40") + "sampling: {rate: 20}\n",
            "the controller computes every 0.05 s, and these position and velocity gains are stable with periods below "
            "0.05 s only",
        ),
        (
            controller("gravity_compensation") + "sampling: {rate: 100}\nobserver: {}\n",
            "observer.gain times the period of sampling is 0.5, and above 0.2",
        ),
        (
            controller("gravity_compensation") + "sampling: {rate: 100}\nobserver: {gain: [1, 2, 200]}\n",
            "observer.gain times the period of sampling is 2: the residual diverges",
        ),
        (
            controller("stiffness") + "reference: {type: point, tip: [2, 0, 1.5]}\n",
            "the reference of the tip leaves the reach of the arm by 0.5 m",
        ),
        (
            controller("stiffness") + "reference: {type: line, tip: [1.5, 0, 0], start: 11}\n",
            "reference.start is 11 s, and the run ends at 10 s",
        ),
        (
            controller("stiffness") + "reference: {" + TABLE + "}\n",
            "the table of the reference begins 0.25208 m from where the tip starts",
        ),
        (
            WALL + controller("hybrid") + "reference: {force: {type: sinusoid, value: 1, amplitude: 2}}\n",
            "the reference of the force falls to -1 N: a wall cannot pull",
        ),
        (
            WALL + controller("hybrid") + "reference: {force: {type: step, start: 20}}\n",
            "reference.force.start is 20 s, and the run ends at 10 s",
        ),
        (
            WALL + controller("hybrid", "anti_windup: conditional"),
            "controller.anti_windup has nothing to do: every arm.torque_limit is inf",
        ),
        (
            controller("energy_tank", "stiffness_amplitude: 250"),
            "controller.stiffness_amplitude is 250 N/m, more than the stiffness of 200 N/m",
        ),
        (controller("none") + "push: {}\n", "push.force is [0, 0, 0]: nothing pushes"),
        (controller("none") + "push: {force: [1, 0, 0], start: 12}\n", "push.start is 12 s, and the run ends at 10 s"),
        (controller("parallel", "gravity: 9.81") + WALL, "the controller compensates 9.81"),
    ],
)
def test_a_likely_slip_is_named_with_its_numbers(warned, text: str, says: str) -> None:
    message = warned(SLIDE + text)
    assert says in message and message.count("\n") == 1, message


def test_stability_is_judged_by_the_wall_there_is(warned) -> None:
    gentle = "wall: {acts_on_arm: true, contact: {stiffness: 1396.8}}\n"
    assert warned(SLIDE + gentle + controller("admittance", "inner: position")) == ""
    assert warned(SLIDE + WALL + controller("admittance", "inner: position, stiffness: [10, 1e4, 1e4]")) == ""
    assert "stable" in warned(SLIDE + WALL + controller("admittance", "inner: position, damping: [1, 1e3, 1e3]"))


def test_a_controller_that_compensates_nothing_is_free_of_slips_of_gravity(warned) -> None:
    wrong = "compensate_gravity: false, gravity: 9.81"
    assert warned(SLIDE + controller("joint_pd", wrong)) == ""
    assert "9.81" in warned(SLIDE + controller("joint_pd", "gravity: 9.81"))
