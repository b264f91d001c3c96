"""Right-hand sides f(t, x) of an arm that no torque drives, as ode45 and solve_ivp call them."""

from __future__ import annotations

from typing import Any

import pytest
from arm3r_cpp import UnjudgedError
from arm3r_cpp.verify.functions import formula_verdict
from formulas.outcomes import NUMBERS, arm_of

MATLAB = """
function dx = rhs(t, x)
q = x(1:3); qd = x(4:6);
{numbers}
c2 = cos(q(2)); c23 = cos(q(2)+q(3)); s2 = sin(q(2)); s23 = sin(q(2)+q(3)); s3 = sin(q(3));
r = a2*c2 + l3*c23;
M22 = I2 + m2*l2^2 + I3 + m3*(a2^2 + l3^2 + 2*a2*l3*cos(q(3)));
M23 = I3 + m3*(l3^2 + a2*l3*cos(q(3)));
M11 = m2*(l2*c2)^2 + m3*r^2 + I2*c2^2 + I3*c23^2 + axial2*s2^2 + axial3*s23^2;
M = [M11 0 0; 0 M22 M23; 0 M23 I3+m3*l3^2];
d2 = -2*(m2*l2^2 + I2 - axial2)*c2*s2 - 2*m3*r*(a2*s2 + l3*s23) - 2*(I3 - axial3)*c23*s23;
d3 = -2*m3*r*l3*s23 - 2*(I3 - axial3)*c23*s23;
k = m3*a2*l3*s3;
h = [d2*qd(1)*qd(2)+d3*qd(1)*qd(3); -0.5*d2*qd(1)^2-k*(2*qd(2)*qd(3)+qd(3)^2); -0.5*d3*qd(1)^2+k*qd(2)^2];
G = [0; m2*g*l2*c2 + m3*g*r; m3*g*l3*c23];
tau = {torque};
dx = [qd; M\\(tau - h - G)];
end
"""
SCRIPT = "x0 = [0.1; 0.2; 0.3; 0; 0; 0];\n[t, x] = ode45(@rhs, [0 2], x0);\nplot(t, x)\n"


def text_of(torque: str = "[0; 0; 0]") -> str:
    numbers = " ".join(f"{name} = {value};" for name, value in NUMBERS["unequal"].items() if name not in ("a3", "d1"))
    return MATLAB.format(numbers=numbers, torque=torque)


def verdict_on(text: str, written: Any, kind: str | None = None) -> Any:
    scenario = arm_of("unequal", "slide").copy()
    scenario["arm.link1.inertia_axial"] = 0.0
    return formula_verdict(written("rhs.m", text), kind, scenario)


@pytest.mark.parametrize("kind", [None, "forward"])
@pytest.mark.parametrize("torque", ["[0; 0; 0]", "zeros(3, 1)", "0*qd"])
def test_the_arm_left_alone_is_right(kind: str | None, torque: str, written: Any) -> None:
    verdict = verdict_on(text_of(torque), written, kind)
    assert verdict.ok and verdict.kind == "forward" and "without a torque" in verdict.found, str(verdict)


def test_a_script_that_integrates_it_is_judged_by_it(written: Any) -> None:
    assert verdict_on(SCRIPT + text_of(), written).ok


def test_a_mistake_in_it_is_found(written: Any) -> None:
    verdict = verdict_on(text_of().replace("2*qd(2)*qd(3)", "qd(2)*qd(3)"), written)
    assert {(one.old, one.new) for one in verdict.findings} == {("qd(2)", "2*qd(2)")}, str(verdict)


@pytest.mark.parametrize("torque", ["-5*qd", "[0; 3; 0]", "K*(q0 - q)"])
def test_an_arm_with_a_torque_of_its_own_is_not_judged(torque: str, written: Any) -> None:
    text = text_of(torque).replace("c2 = cos", "K = 3; q0 = [1; 1; 1];\nc2 = cos", 1)
    with pytest.raises(UnjudgedError, match=r"rhs\.m:\d+: cannot be judged: it sets a torque") as raised:
        verdict_on(text, written)
    line = int(str(raised.value).split("rhs.m:")[1].split(":")[0])
    assert text.split("\n")[line - 1].startswith("tau = ")
