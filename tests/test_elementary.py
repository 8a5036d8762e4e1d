"""Logarithms, powers and angles of the project's own are as exact as float32 lets them be."""

from typing import Any

import numpy as np
import pytest
import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.elementary import (
    binary_log,
    exponential,
    half_angle,
    natural_log,
    power_of_90,
)

COUNT = 200_000
"""Values of each function."""
UNITS = 2
"""Units in the last place that a result may be off."""
SMALLEST = np.finfo(np.float32).tiny


def kernel_of(function: Any) -> Any:
    """A kernel that applies a function of one number."""

    @wp.kernel(module="unique", module_options=EXACT)
    def apply(
        span: wp.array(dtype=wp.vec2i), x: wp.array(dtype=float), result_out: wp.array(dtype=float)
    ):
        """Apply it."""
        i = span[0][0] + wp.tid()
        if i < span[0][1]:
            result_out[i] = function(x[i])

    return apply


@wp.kernel(module="unique", module_options=EXACT)
def halve(
    span: wp.array(dtype=wp.vec2i),
    x: wp.array(dtype=float),
    y: wp.array(dtype=float),
    result_out: wp.array(dtype=wp.vec2f),
):
    """Halve the angles of vectors."""
    i = span[0][0] + wp.tid()
    if i < span[0][1]:
        result_out[i] = half_angle(x[i], y[i])


def results(device: str, kernel: Any, dtype: Any, *given: np.ndarray) -> np.ndarray:
    """What a kernel makes of numbers [N]."""
    runner = Device(device, 1)
    inputs = []
    for values in given:
        inputs.append(runner.empty(len(values), float))
        runner.write(inputs[-1], values)
    made = runner.empty(len(given[0]), dtype)
    phase = runner.record(kernel, inputs, [made])
    phase.resize(len(given[0]))
    runner.run([phase])
    return runner.read(made, len(given[0]))


def assert_near(actual: np.ndarray, expected: np.ndarray) -> None:
    """Within `UNITS`; what float32 does not hold becomes 0 or infinity as there."""
    with np.errstate(over="ignore", under="ignore"):
        rounded = expected.astype(np.float32)
    held = np.isfinite(rounded)
    np.testing.assert_array_equal(actual[~held], rounded[~held])
    units = np.abs(actual[held] - expected[held]) / np.spacing(np.abs(rounded[held]))
    assert units.max() <= UNITS


def spread(low: float, high: float, *edges: float) -> np.ndarray:
    """Random numbers of a range, its ends, and others that matter, [N] float32."""
    random = np.random.default_rng(3).uniform(low, high, COUNT)
    return np.array([low, high, *edges, *random], dtype=np.float32)


def above_nothing() -> np.ndarray:
    """All magnitudes above 0, the neighbours of 1 and of the seam between two exponents."""
    magnitudes = 2.0 ** spread(-126.0, 127.9).astype(float)
    near = 1.0 + np.arange(-300, 300) * 2.0**-24
    seam = np.sqrt(0.5) + np.arange(-300, 300) * 2.0**-24
    ends = [SMALLEST, np.finfo(np.float32).max]
    return np.array([*magnitudes, *near, *seam, *2 * seam, *ends], dtype=np.float32)


FUNCTIONS = [
    (natural_log, np.log, above_nothing()),
    (binary_log, np.log2, above_nothing()),
    (exponential, np.exp, spread(-120.0, 95.0, 0.0, -0.0, 88.72, 88.73, -87.3, -103.9, -104.1)),
    (exponential, np.exp, spread(-(2.0**-10), 2.0**-10, 2.0**-30, -(2.0**-30))),
    (exponential, np.exp, np.array([-np.inf, np.inf, -3e38, 3e38], dtype=np.float32)),
    (power_of_90, lambda x: x**90, spread(0.0, 1.0, 0.3, 1.0 - 2.0**-24)),
]


@pytest.mark.parametrize(
    ("function", "true", "values"), FUNCTIONS, ids=lambda value: getattr(value, "key", "")
)
def test_function(function: Any, true: Any, values: np.ndarray, device: str) -> None:
    """Against the same function of float64."""
    with np.errstate(over="ignore", under="ignore"):
        expected = true(values.astype(float))
    assert_near(results(device, kernel_of(function), float, values), expected)


def test_powers_of_two_have_whole_logarithms(device: str) -> None:
    """To the bit: levels of detail change there."""
    exponents = np.arange(-126, 128)
    powers = (2.0**exponents).astype(np.float32)
    np.testing.assert_array_equal(results(device, kernel_of(binary_log), float, powers), exponents)


def test_logarithm_and_exponential_never_turn_back(device: str) -> None:
    """They rise, across the seams of their pieces as well."""
    for function, values in ((natural_log, above_nothing()), (exponential, spread(-100.0, 88.0))):
        made = results(device, kernel_of(function), float, np.sort(values))
        assert (np.diff(made) >= 0).all()


def test_half_angles(device: str) -> None:
    """Vectors of all lengths and directions, near the axes too."""
    rng = np.random.default_rng(5)
    length, angle = 10.0 ** rng.uniform(-15, 15, COUNT), rng.uniform(-np.pi, np.pi, COUNT)
    flat = 10.0 ** rng.uniform(-12, 0, COUNT // 4)
    angle[: COUNT // 4] = flat
    angle[COUNT // 4 : COUNT // 2] = np.pi - flat
    x = (length * np.cos(angle)).astype(np.float32)
    y = (length * np.sin(angle)).astype(np.float32)
    x[:5], y[:5] = (1.0, -1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, -1.0, 0.0)
    made = results(device, halve, wp.vec2f, x, y)
    x, y = x.astype(float), y.astype(float)
    half = np.arctan2(y, np.abs(x)) / 2
    cosine = np.where(x < 0, np.abs(np.sin(half)), np.cos(half))
    sine = np.where(x < 0, np.where(y < 0, -1, 1) * np.cos(half), np.sin(half))
    assert_near(made[:, 0], cosine)
    assert_near(made[:, 1], sine)
