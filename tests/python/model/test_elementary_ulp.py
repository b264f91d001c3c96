"""Accuracy of the elementary functions against 60-digit arithmetic, and their bits at every optimisation level."""

import math
import os
import subprocess
from pathlib import Path

import mpmath
import numpy as np
import pytest

HERE = Path(__file__).parents[1]
INCLUDE = HERE.parent.parent / "cpp" / "include"
LEVELS = ("-O0", "-O2", "-O3", "-O3 -march=native")  # the last has fma, and must not use it
mpmath.mp.dps = 60
pytestmark = pytest.mark.sample(7)  # tests of this file


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """The table program, built once at each optimisation level."""
    built, folder = {}, tmp_path_factory.mktemp("elementary")
    for i, level in enumerate(LEVELS):
        built[level] = folder / f"table{i}"
        flags = f"-std=c++20 {level} -ffp-contract=off -fno-math-errno -fno-trapping-math -I{INCLUDE}"
        command = [os.environ.get("CXX", "c++"), *flags.split(), HERE / "elementary_table.cpp", "-o", built[level]]
        subprocess.run(command, check=True)
    return built


@pytest.fixture
def ours(programs):
    """ours(name, x, y) of (n,) arrays: checks that all levels agree bit for bit, and returns the (n,) results."""

    def compute(name, x, y=None):
        x = np.asarray(x, float)
        pairs = np.stack([x, np.zeros_like(x) if y is None else np.asarray(y, float)], axis=1).tobytes()
        outputs = {
            subprocess.run([p, name], input=pairs, stdout=subprocess.PIPE, check=True).stdout for p in programs.values()
        }
        assert len(outputs) == 1, f"{name} differs between {', '.join(LEVELS)}"
        return np.frombuffer(outputs.pop())

    return compute


def largest_error(results, exact, unit=math.ulp):
    """In units of the last place of the exact values, unless another unit is given."""
    return max(float(abs(mpmath.mpf(float(r)) - e)) / unit(float(e)) for r, e in zip(results, exact, strict=True))


def random():
    return np.random.default_rng(20), 20_000


def spread(low, high, n=10_000):
    """n numbers of either sign, log-uniform in size."""
    rng = np.random.default_rng(30)
    return np.exp(rng.uniform(math.log(low), math.log(high), n)) * rng.choice([-1.0, 1.0], n)


def angles():
    rng, n = random()
    crossings = np.array([float(k * mpmath.pi / 4) for k in rng.integers(-127_000, 127_000, 3000)])
    beside = [crossings, np.nextafter(crossings, np.inf), np.nextafter(crossings, -np.inf)]
    return np.concatenate([rng.uniform(-1e5, 1e5, n), rng.uniform(-7, 7, n), spread(1e-300, 1e5), *beside])


def vectors():
    rng, n = random()
    y, x = rng.normal(size=(2, n))
    slope = rng.uniform(-1, 1, n)
    far = spread(1e-150, 1e150), np.roll(spread(1e-150, 1e150), 1)
    return np.concatenate([y, slope, x, far[0]]), np.concatenate([x, np.ones(n), slope * x, far[1]])


def test_sin_is_within_1_6_ulp_up_to_1e5_rad(ours):
    x = angles()
    assert largest_error(ours("sin", x), map(mpmath.sin, x)) < 1.6


def test_cos_is_within_1_6_ulp_up_to_1e5_rad(ours):
    x = angles()
    assert largest_error(ours("cos", x), map(mpmath.cos, x)) < 1.6


@pytest.mark.parametrize("name, exact", [("rotated_sin", mpmath.sin), ("rotated_cos", mpmath.cos)])
def test_rotated_sincos_is_within_3e_16_up_to_0_03_rad(ours, name, exact):
    rng, n = random()
    x, delta = rng.uniform(-1e3, 1e3, n), rng.uniform(-0.03, 0.03, n)
    true = [exact(mpmath.mpf(a) + mpmath.mpf(b)) for a, b in zip(x, delta, strict=True)]
    assert largest_error(ours(name, x, delta), true, unit=lambda _: 1.0) < 3e-16


def test_tanh_is_within_3_ulp_everywhere(ours):
    rng, n = random()
    x = np.concatenate([rng.uniform(-1, 1, n), rng.uniform(-25, 25, n), spread(1e-300, 1e300)])
    assert largest_error(ours("tanh", x), map(mpmath.tanh, x)) < 3.0


def test_atan2_is_within_2_5_ulp_everywhere(ours):
    y, x = vectors()
    assert largest_error(ours("atan2", y, x), map(mpmath.atan2, y, x)) < 2.5


def test_acos_is_within_3_ulp_everywhere(ours):
    rng, n = random()
    x = np.concatenate([rng.uniform(-1, 1, n), spread(1e-300, 1), 1 - abs(spread(2e-16, 1))])
    assert largest_error(ours("acos", x), map(mpmath.acos, x)) < 3.0


def test_hypot2_is_within_1_3_ulp_from_1e_150_to_1e150(ours):
    y, x = vectors()
    assert largest_error(ours("hypot2", x, y), map(mpmath.hypot, x, y)) < 1.3


def test_fifth_root_is_within_1_2_ulp_of_every_normal_positive(ours):
    rng, n = random()
    x = np.concatenate([rng.uniform(0, 10, n), abs(spread(2.3e-308, 1.7e308, n))])
    assert largest_error(ours("fifth_root", x), (mpmath.root(v, 5) for v in x)) < 1.2


def test_exp_is_within_0_6_ulp_where_its_result_is_normal(ours):
    rng, n = random()
    x = np.concatenate([rng.uniform(-1, 1, n), rng.uniform(-708, 709, n), spread(1e-300, 700)])
    assert largest_error(ours("exp", x), map(mpmath.exp, x)) < 0.6


def test_exp_is_within_1_ulp_where_its_result_is_subnormal(ours):
    x = np.linspace(-745.1, -708.4, 5000)
    assert largest_error(ours("exp", x), map(mpmath.exp, x)) <= 1.0


def test_log_is_within_0_55_ulp_of_every_normal_positive(ours):
    rng, n = random()
    ends = [np.finfo(float).tiny, np.finfo(float).max, math.sqrt(0.5), math.sqrt(2), math.nextafter(1, 0)]
    x = np.concatenate([rng.uniform(0, 2, n), 1 + spread(2e-16, 0.5), abs(spread(2.3e-308, 1.7e308)), ends])
    assert largest_error(ours("log", x), map(mpmath.log, x)) < 0.55


@pytest.mark.parametrize("p", [1.0, 1.0 + 2**-52, 1.5, 2.0, 3.0, "any"])
def test_power_is_within_0_6_ulp_up_to_the_third(ours, p):
    rng, n = random()
    x = np.concatenate([abs(spread(1e-12, 1e3, n)), rng.uniform(0.5, 2, n)])
    exponents = rng.uniform(1, 3, 2 * n) if p == "any" else np.full(2 * n, p)
    true = (mpmath.power(*pair) for pair in zip(x, exponents, strict=True))
    assert largest_error(ours("power", x, exponents), true) < (0.6 if p != 1.0 else 1e-30)


def test_power_is_within_1_ulp_from_the_tenth_to_the_tenth_root(ours):
    rng, n = random()
    x, exponents = abs(spread(1e-12, 1e3, n)), np.exp(rng.uniform(-1, 1, n) * math.log(10))
    true = (mpmath.power(*pair) for pair in zip(x, exponents, strict=True))
    assert largest_error(ours("power", x, exponents), true) < 1.0


AXIS = [-3.0, -1.0, -1e-300, -5e-324, -0.0, 0.0, 5e-324, 1e-300, 1.0, 3.0]


@pytest.mark.parametrize("y", AXIS)
@pytest.mark.parametrize("x", [-0.0, 0.0])
def test_atan2_on_the_axes_is_that_of_c(ours, x, y):
    for a, b in ((y, x), (x, y)):
        (result,) = ours("atan2", [a], [b])
        assert (result, math.copysign(1, result)) == (math.atan2(a, b), math.copysign(1, math.atan2(a, b)))
