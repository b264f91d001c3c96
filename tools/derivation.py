"""Writes docs/derivation.md: kinematics and dynamics of the arm, derived from its frames by sympy, in both conventions.

    python tools/derivation.py

The page is a chain of formulas: each knows the joint angles, the numbers of the arm and the formulas above it, so that
it can be evaluated from top to bottom, as `evaluate` does. `chain` has them as sympy expressions, `page` as text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import sympy as sp

PAGE = Path(__file__).parents[1] / "docs" / "derivation.md"
TURNS = {"simscape": -1, "slide": 1}
"""Sign of the right angle by which the frame of joint 2 is turned about x, by convention."""

Q = sp.symbols("q_1 q_2 q_3", real=True)
QD = sp.symbols(r"\dot{q}_1 \dot{q}_2 \dot{q}_3", real=True)
ARM = sp.symbols(
    "g m_1 m_2 m_3 d_1 z_{c1} a_2 a_3 l_2 l_3 I_1 I_{x2} I_{y2} I_{z2} I_{x3} I_{y3} I_{z3}", positive=True
)
GRAVITY, M1, M2, M3, D1, ZC1, A2, A3, L2, L3, I1, *INERTIAS = ARM
PAYLOAD = sp.Symbol("m_p", positive=True)
ROTORS = sp.symbols("J_{a1} J_{a2} J_{a3}", positive=True)
X, Y, Z = sp.eye(3).columnspace()


class Formula(NamedTuple):
    """name = expression; the expression knows names of formulas above it."""

    name: str
    value: sp.Expr | sp.Matrix


class Bodies(NamedTuple):
    """Links 2 and 3: what moves with the angles q2 and q3, in true functions of the angles."""

    frames: tuple[sp.Matrix, sp.Matrix]
    centres: tuple[sp.Matrix, sp.Matrix]
    tip: sp.Matrix


# ---- the derivation -------------------------------------------------------------------------------------------------


def turned(axis: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """The rotation matrix about x or z."""
    c, s = sp.cos(angle), sp.sin(angle)
    about_x, about_z = [[1, 0, 0], [0, c, -s], [0, s, c]], [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    return sp.Matrix(about_x if axis == X else about_z)


def simple(value: sp.Expr | sp.Matrix) -> sp.Expr | sp.Matrix:
    """With cos(q2 + q3) in place of products, and a square where there is one."""
    if isinstance(value, sp.MatrixBase):
        return value.applyfunc(simple)
    return sp.factor(sp.trigsimp(sp.expand(value)))


@cache
def bodies(convention: str) -> Bodies:
    base = turned(Z, Q[0]) * turned(X, TURNS[convention] * sp.pi / 2)
    frames = simple(base * turned(Z, Q[1])), simple(base * turned(Z, Q[1]) * turned(Z, Q[2]))
    shoulder = D1 * Z
    elbow = shoulder + A2 * frames[0] * X
    return Bodies(frames, (shoulder + L2 * frames[0] * X, elbow + L3 * frames[1] * X), elbow + A3 * frames[1] * X)


def axes(convention: str) -> sp.Matrix:
    """The axes of the three joints, as columns: those of joints 2 and 3 are parallel."""
    axis = bodies(convention).frames[0] * Z
    return sp.Matrix.hstack(Z, axis, axis)


def linear(point: sp.Matrix) -> sp.Matrix:
    return simple(point.jacobian(sp.Matrix(Q)))


def angular(convention: str, link: int) -> sp.Matrix:
    return sp.Matrix.hstack(*(axes(convention)[:, joint] * int(joint < link) for joint in range(3)))


@cache
def link_mass_matrix(convention: str, link: int) -> sp.Matrix:
    """The part of link 2 or 3 in the mass matrix."""
    move = linear(bodies(convention).centres[link - 2])
    turn = bodies(convention).frames[link - 2].T * angular(convention, link)
    inertia = sp.diag(*INERTIAS[3 * (link - 2) : 3 * (link - 1)])
    return simple((M2, M3)[link - 2] * move.T * move) + simple(turn.T * inertia * turn)


def christoffel(mass: sp.Matrix) -> sp.Matrix:
    """The Coriolis matrix of a mass matrix."""

    def entry(i: int, j: int) -> sp.Expr:
        return sum(
            (sp.diff(mass[i, j], Q[k]) + sp.diff(mass[i, k], Q[j]) - sp.diff(mass[j, k], Q[i])) * QD[k] / 2
            for k in range(3)
        )

    return sp.Matrix(3, 3, entry)


@cache
def potential(convention: str) -> sp.Expr:
    centres = (ZC1 * Z, *bodies(convention).centres)
    return sum(mass * GRAVITY * centre.dot(Z) for mass, centre in zip((M1, M2, M3), centres, strict=True))


# ---- abbreviations --------------------------------------------------------------------------------------------------

ANGLES = {"1": Q[0], "2": Q[1], "3": Q[2], "{23}": Q[1] + Q[2]}
COS = {digits: sp.Symbol(f"C_{digits}") for digits in ANGLES}
SIN = {digits: sp.Symbol(f"S_{digits}") for digits in ANGLES}
IN_WORDS = {sp.cos(angle): COS[digits] for digits, angle in ANGLES.items()}
IN_WORDS |= {sp.sin(angle): SIN[digits] for digits, angle in ANGLES.items()}
IN_ANGLES = {name: function for function, name in IN_WORDS.items()}
C2, C3, C23, S2, S3, S23 = COS["2"], COS["3"], COS["{23}"], SIN["2"], SIN["3"], SIN["{23}"]
R, H, H2, H3, SMALL_B, MU = sp.symbols(r"r h h_2 h_3 b \mu")
LUMPED = sp.symbols("A_1 A_2 A_3 B_2 B_3 B G_2 G_3")


def short(value: sp.Expr | sp.Matrix) -> sp.Expr | sp.Matrix:
    """With C_2 for cos(q2) and so on."""
    return value.xreplace(IN_WORDS)


def written_with(value: sp.Matrix, *definitions: tuple[sp.Symbol, sp.Expr, sp.Symbol]) -> sp.Matrix:
    """Entries in which a name replaces its definition, where that makes them shorter.

    definitions: a name, what it stands for, and a symbol that can be eliminated by it.
    """

    def shorter(entry: sp.Expr) -> sp.Expr:
        for name, meaning, by in definitions:
            replaced = sp.expand(sp.cancel(entry.subs(by, sp.solve(meaning - name, by)[0])))
            entry = min(entry, replaced, key=sp.count_ops)
        return entry

    return value.applyfunc(shorter)


@cache
def lumped() -> tuple[Formula, ...]:
    """The numbers that the motion depends on: coefficients of M, and of U."""
    whole = short(sum((link_mass_matrix("slide", link) for link in (2, 3)), sp.diag(I1, 0, 0)))
    squares = {S2**2: 1 - C2**2, S23**2: 1 - C23**2}
    first = sp.Poly(sp.expand(whole[0, 0]).subs(squares), C2, C23)
    second = sp.Poly(whole[1, 1], C3)
    height = sp.Poly(sp.expand(short(potential("slide")) / GRAVITY), S2, S23)
    values = [first.coeff_monomial(monomial) for monomial in (1, C2**2, C23**2)]
    values += [second.coeff_monomial(1) - whole[2, 2], whole[2, 2], second.coeff_monomial(C3) / 2]
    values += [height.coeff_monomial(monomial) for monomial in (S2, S23)]
    return tuple(Formula(str(name), sp.expand(value)) for name, value in zip(LUMPED, values, strict=True))


@cache
def mass_matrix() -> sp.Matrix:
    """In these numbers."""
    a1, a2, a3, b2, b3, b, *_ = LUMPED
    first = a1 + a2 * C2**2 + a3 * C23**2 + 2 * b * C2 * C23
    return sp.Matrix([[first, 0, 0], [0, b2 + b3 + 2 * b * C3, b3 + b * C3], [0, b3 + b * C3, b3]])


@cache
def coriolis() -> tuple[Formula, ...]:
    """h2 and h3 are half the derivatives of M11, b that of M23; then the matrix."""
    mass = mass_matrix().xreplace(IN_ANGLES)
    half = [short(sp.diff(mass[0, 0], Q[joint]) / 2) for joint in (1, 2)]
    meanings = dict(zip((H2, H3, SMALL_B), (*half, -short(sp.diff(mass[1, 2], Q[2]))), strict=True))
    by = zip(meanings, meanings.values(), (LUMPED[1], LUMPED[2], LUMPED[5]), strict=True)
    matrix = written_with(short(christoffel(mass)).applyfunc(sp.expand), *by)
    return (
        *(Formula(str(name), sp.expand(value)) for name, value in meanings.items()),
        Formula("C", matrix.applyfunc(sp.factor)),
    )


# ---- the chain ------------------------------------------------------------------------------------------------------


def words() -> list[Formula]:
    return [Formula(str(name), function) for name, function in IN_ANGLES.items()]


def frames(convention: str) -> list[Formula]:
    frame = bodies(convention).frames
    return [Formula("R_2", short(frame[0])), Formula("R_3", short(frame[1]))]


def reach() -> list[Formula]:
    return [Formula("r", A2 * C2 + A3 * C23), Formula("h", A2 * S2 + A3 * S23)]


def by_reach(value: sp.Matrix) -> sp.Matrix:
    """With r and h where these make it shorter."""
    (_, r), (_, h) = reach()
    return written_with(short(value).applyfunc(sp.expand), (R, r, A2), (H, h, A2))


def points(convention: str) -> list[Formula]:
    body = bodies(convention)
    centres = [short(body.centres[0]), short(simple(body.centres[1]))]
    return [*reach(), Formula("c_2", centres[0]), Formula("c_3", centres[1]), Formula("x", by_reach(body.tip))]


def tip_jacobian(convention: str) -> list[Formula]:
    return [Formula("J", by_reach(linear(bodies(convention).tip)))]


def link_jacobians(convention: str) -> list[Formula]:
    moved = [Formula(f"J_{{c{link}}}", short(linear(bodies(convention).centres[link - 2]))) for link in (2, 3)]
    return [*moved, *(Formula(f"J_{{w{link}}}", short(angular(convention, link))) for link in (2, 3))]


def link_mass_matrices(convention: str) -> list[Formula]:
    matrices = [Formula(f"M_{link}", short(link_mass_matrix(convention, link))) for link in (2, 3)]
    return [Formula("M_1", sp.diag(I1, 0, 0)), *matrices]


def lumped_mass_matrix() -> list[Formula]:
    return [Formula("M", mass_matrix())]


def gravity(convention: str) -> list[Formula]:
    energy = potential(convention)
    numbers = {formula.name: formula.value for formula in lumped()}
    torque = short(sp.Matrix([sp.diff(energy, angle) for angle in Q])).applyfunc(sp.expand)
    by = [(name, numbers[str(name)], by) for name, by in zip(LUMPED[6:], (M2, L3), strict=True)]
    return [Formula("U", short(energy)), Formula(r"\tau_g", written_with(torque, *by).applyfunc(sp.factor))]


def payload() -> list[Formula]:
    mass = M3 + PAYLOAD
    moved = Formula(str(MU), M3 * PAYLOAD / mass * (A3 - L3) ** 2)
    inertias = [Formula(f"{inertia}'", inertia + MU) for inertia in INERTIAS[4:]]
    return [Formula("m_3'", mass), Formula("l_3'", (M3 * L3 + PAYLOAD * A3) / mass), moved, *inertias]


def rotors() -> list[Formula]:
    return [Formula("M'", sp.MatrixSymbol("M", 3, 3) + sp.diag(*ROTORS))]


# ---- the text -------------------------------------------------------------------------------------------------------

HEAD = r"""
# The derivation

From the frames of the arm to $`J`$, $`M`$, $`C`$ and $`\tau_g`$, to compare with your own.
Every formula is computed by sympy from the ones above it, in both conventions of
[the model](model.md) (1.1), and compared with the library at random arms and states. This page is
written by `tools/derivation.py`. [`arm3r verify`](verify.md) compares your program.

Symbols are those of the model: lengths $`a_2, a_3`$, distances $`l_2, l_3`$ from the joint to the
centre of mass, height $`d_1`$ of joint 2, masses $`m_i`$, inertias $`I_{xi}, I_{yi}, I_{zi}`$ about
the centre of mass, $`x`$ along the link, $`z`$ along the joint axis; $`I_1`$ is the inertia of link
1 about the axis of joint 1, and $`z_{c1}`$ the height of its centre of mass. Gravity $`g`$ points
along $`-z`$ of the base.
"""
FRAMES = r"""
## 1. Frames

The frame of a link has $`x`$ along the link and $`z`$ along the joint axis. A right angle about
$`x`$ takes the vertical axis of joint 1 to that of joint 2; its sign is the only difference
between the conventions: $`-90°`$ in `simscape`, where a positive angle lowers the arm, and
$`+90°`$ in `slide`, where it raises the arm. The axes of joints 2 and 3 are parallel, so their
angles add up.

```math
R_2 = \mathrm{Rot}_z(q_1)\,\mathrm{Rot}_x(\mp 90°)\,\mathrm{Rot}_z(q_2) \qquad R_3 = R_2\,\mathrm{Rot}_z(q_3)
```
"""
POINTS = r"""
## 2. Points

The elbow, the centres of mass and the tip follow from the first columns of the frames: with
$`\mathbf i = (1,0,0)`$, $`\mathbf k = (0,0,1)`$

```math
c_2 = d_1\mathbf k + l_2 R_2\mathbf i \qquad c_3 = d_1\mathbf k + a_2 R_2\mathbf i + l_3 R_3\mathbf i \qquad
x = d_1\mathbf k + a_2 R_2\mathbf i + a_3 R_3\mathbf i
```

With the reach $`r`$ and the height $`h`$ of the tip from joint 2 they become shorter.
"""
TIP_JACOBIAN = r"""
## 3. Jacobian

```math
J = \frac{\partial x}{\partial q}
```
"""
LINK_JACOBIANS = r"""
## 4. Motion of the links

The Jacobians $`J_{ci}`$ of the centres of mass are derivatives of the points. Those of the angular
velocities, $`J_{wi}`$, have the axes of the joints as columns: $`\mathbf k`$, and for joints 2 and
3 the last column of $`R_2`$. $`J_{w3}`$ is the angular part of the geometric Jacobian (2.5).

```math
J_{ci} = \frac{\partial c_i}{\partial q} \qquad \omega_i = J_{wi}\,\dot q
```
"""
LINK_MASS_MATRICES = r"""
## 5. Mass matrix, link by link

The kinetic energy of link $`i`$ is $`\tfrac12\dot q^T M_i\,\dot q`$. Link 1 turns about a fixed
axis. The conventions have the same $`M`$: it depends on the angles by cosines and by squares of
sines.

```math
M_i = m_i J_{ci}^T J_{ci} + J_{wi}^T R_i\,\mathrm{diag}(I_{xi}, I_{yi}, I_{zi})\,R_i^T J_{wi}
```
"""
NUMBERS = r"""
## 6. Mass matrix

With $`S_2^2 = 1 - C_2^2`$ and $`S_{23}^2 = 1 - C_{23}^2`$, the sum of the parts is a polynomial in
$`C_2`$, $`C_3`$ and $`C_{23}`$; its coefficients are the numbers of (3.2). $`G_2`$ and $`G_3`$ are
those of the potential energy, section 8.
"""
MASS_MATRIX = r"""
```math
M = M_1 + M_2 + M_3
```
"""
CORIOLIS = r"""
## 7. Coriolis matrix

By the Christoffel symbols. $`h_2`$ and $`h_3`$ are half the derivatives of $`M_{11}`$ with respect
to $`q_2`$ and $`q_3`$, $`b`$ is minus the derivative of $`M_{23}`$ with respect to $`q_3`$. Another
$`C`$ may be right too, if its product $`C\dot q`$ is the same; with this one $`\dot M - 2C`$ is
skew. The conventions have the same $`C`$, since they have the same $`M`$.

```math
C_{ij} = \frac12\sum_k\left(\frac{\partial M_{ij}}{\partial q_k} + \frac{\partial M_{ik}}{\partial q_j}
- \frac{\partial M_{jk}}{\partial q_i}\right)\dot q_k
```
"""
GRAVITY_TORQUE = r"""
## 8. Gravity torque

The torque that holds the arm is the gradient of the potential energy; $`c_1 = z_{c1}\mathbf k`$.
Joint 1 is vertical and needs no torque. For gravity in any other direction see (3.5).

```math
U = -\sum_i m_i\,\mathbf g\cdot c_i \qquad \tau_g = \frac{\partial U}{\partial q}
```
"""
PAYLOAD_AT_TIP = r"""
## 9. Payload and rotors

A payload $`m_p`$ at the tip is link 3 with other numbers: those with a prime take the place of
those without.
"""
ROTORS_AT_JOINTS = r"""
Rotors with the inertias $`J_{ai}`$, seen at the joints, add to the diagonal.
"""

# ---- the numbers to compare with ------------------------------------------------------------------------------------

NUMBERS_TO_COMPARE = """
## 10. Numbers to compare with

An arm with unequal links, at $`q = (0.3, -0.5, 1.1)`$, $`\\dot q = (0.7, -0.4, 0.9)`$:

```yaml
format: 1
arm:
  base_height: 0.2
  gravity: [0, 0, -9.81]
  link1: {mass: 3, com: 0.1, inertia_axial: 0.02}
  link2: {length: 1.2, mass: 2.5, com: 0.5, inertia: [0.02, 0.3, 0.31]}
  link3: {length: 0.9, mass: 1.5, com: 0.4, inertia: [0.015, 0.1, 0.11]}
```
"""
EXAMPLE = dict(zip(map(str, (*Q, *QD)), (0.3, -0.5, 1.1, 0.7, -0.4, 0.9), strict=True))
EXAMPLE |= dict(zip(map(str, ARM), (9.81, 3, 2.5, 1.5, 0.2, 0.1, 1.2, 0.9, 0.5, 0.4, 0.02), strict=False))
EXAMPLE |= dict(zip(map(str, INERTIAS), (0.02, 0.3, 0.31, 0.015, 0.1, 0.11), strict=True))
EXAMPLE |= dict.fromkeys(map(str, (PAYLOAD, *ROTORS)), 0.0)

# ---- the parts ------------------------------------------------------------------------------------------------------


class Part(NamedTuple):
    """A part of the page: what it says, and then its formulas."""

    text: str
    formulas: Callable[[str], Sequence[Formula]]


PARTS = [
    Part(HEAD, lambda _: words()),
    Part(FRAMES, frames),
    Part(POINTS, points),
    Part(TIP_JACOBIAN, tip_jacobian),
    Part(LINK_JACOBIANS, link_jacobians),
    Part(LINK_MASS_MATRICES, link_mass_matrices),
    Part(NUMBERS, lambda _: lumped()),
    Part(MASS_MATRIX, lambda _: lumped_mass_matrix()),
    Part(CORIOLIS, lambda _: coriolis()),
    Part(GRAVITY_TORQUE, gravity),
    Part(PAYLOAD_AT_TIP, lambda _: payload()),
    Part(ROTORS_AT_JOINTS, lambda _: rotors()),
]


@cache
def chain(convention: str) -> list[Formula]:
    """Every formula of a convention, from top to bottom."""
    return [formula for part in PARTS for formula in part.formulas(convention)]


def evaluate(convention: str, numbers: Mapping[str, float]) -> dict[str, Any]:
    """The value of every formula, by its name: floats, arrays (3,) and (3, 3).

    numbers: angles, rates, and what describes the arm, by their names on the page. The formulas use nothing else and
    nothing but each other.
    """
    values: dict[str, Any] = dict(numbers)
    for name, expression in chain(convention):
        known = sorted(expression.free_symbols, key=str)
        value = np.array(sp.lambdify(known, expression, "numpy")(*(values[str(symbol)] for symbol in known)), float)
        values[name] = value.ravel() if value.shape[1:] == (1,) else value
    return values


# ---- the page -------------------------------------------------------------------------------------------------------

ORDER = [GRAVITY, M1, M2, M3, PAYLOAD, *LUMPED, *ARM[4:], MU, *ROTORS]
ORDER += [ratio[digits] for digits in ANGLES for ratio in (COS, SIN)] + [R, H, H2, H3, SMALL_B, *QD, *Q]
"""Of the factors of a product, and so of the terms of a sum."""


def rank(value: sp.Expr) -> tuple[Any, ...]:
    """Where a factor stands in a product, and a term in a sum."""
    if isinstance(value, sp.Symbol):
        return (ORDER.index(value),)
    if value.is_Pow:
        return rank(value.base)
    parts = sorted(rank(part) for part in value.args if not part.is_number)
    return (len(ORDER), *parts) if value.is_Add else tuple(place for part in parts for place in part)


def tex(value: Any) -> str:
    """As TeX, with factors and terms in the order that formulas of mechanics have."""
    if isinstance(value, sp.MatrixBase):
        rows = (" & ".join(tex(entry) for entry in value.row(row)) for row in range(value.rows))
        return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"
    if isinstance(value, sp.MatAdd):
        return " + ".join(tex(part) for part in sorted(value.args, key=lambda part: not part.is_symbol))
    if isinstance(value, sp.Add):
        signed = [tex(term) for term in sorted(value.args, key=rank)]
        return signed[0] + "".join(f" - {one[1:]}" if one[0] == "-" else f" + {one}" for one in signed[1:])
    if isinstance(value, sp.Mul):
        return tex_of_product(value)
    if isinstance(value, sp.Pow):
        base = tex(value.base)
        return f"{base}^{value.exp}" if value.base.is_Symbol else rf"\left({base}\right)^{value.exp}"
    if isinstance(value, (sp.cos, sp.sin)):
        angle = tex(value.args[0])
        return rf"\{value.func} " + (angle if value.args[0].is_Symbol else f"({angle})")
    return str(value)


def tex_of_product(value: sp.Expr) -> str:
    above, below = sp.fraction(value)
    if below != 1:
        return rf"\frac{{{tex(above)}}}{{{tex(below)}}}"
    number, rest = value.as_coeff_Mul()
    factors = sorted(sp.Mul.make_args(rest), key=rank)
    digits = {sp.Integer(1): "", sp.Integer(-1): "-"}.get(number, f"{number} ")
    return digits + " ".join(rf"\left({tex(one)}\right)" if one.is_Add else tex(one) for one in factors)


def page() -> str:
    """The text of docs/derivation.md."""
    return "".join(part.text + "\n" + blocks(part) for part in PARTS).lstrip() + numbers_part()


def blocks(part: Part) -> str:
    """The formulas of a part: once what both conventions have in common, then what each has of its own."""
    simscape, slide = (part.formulas(convention) for convention in ("simscape", "slide"))
    shared = [one for one in simscape if one in slide]
    own = {
        "simscape": [one for one in simscape if one not in shared],
        "slide": [one for one in slide if one not in shared],
    }
    text = math(shared) if shared else ""
    for convention, formulas in own.items():
        if formulas:
            text += f"{chr(10) if text else ''}In `{convention}`:\n\n{math(formulas)}"
    return text


def numbers_part() -> str:
    """Values of the main formulas of an unequal arm, in both conventions."""
    text = NUMBERS_TO_COMPARE
    for convention in TURNS:
        values = evaluate(convention, EXAMPLE)
        lines = [f"{name} &= {tex_of_values(values[name])}" for name in (*"xJMC", r"\tau_g")]
        text += f"\nIn `{convention}`:\n\n{aligned(lines)}"
    return text


def tex_of_values(values: Any) -> str:
    rows = (" & ".join(f"{entry:.6f}" if entry else "0" for entry in row) for row in np.atleast_2d(values.T).T)
    return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"


def math(formulas: Sequence[Formula]) -> str:
    """A block of formulas: numbers first, as many in a line as the longest allows, then matrices."""
    numbers = [one for one in formulas if isinstance(one.value, sp.Expr)]
    matrices = [one for one in formulas if one not in numbers]
    parts = (aligned(lines_of(group)) for group in (numbers, matrices) if group)
    return "\n".join(parts)


def lines_of(formulas: Sequence[Formula]) -> list[str]:
    equations = [f"{one.name} &= {tex(one.value)}" for one in formulas]
    count = max(1, LINE // max(map(len, equations)))
    return [" & ".join(equations[i : i + count]) for i in range(0, len(equations), count)]


def aligned(lines: Sequence[str]) -> str:
    return "```math\n\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}\n```\n"


LINE = 110
"""Letters of TeX."""


def main() -> None:
    PAGE.write_text(page())


if __name__ == "__main__":
    main()
