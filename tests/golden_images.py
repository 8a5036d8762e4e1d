"""Comparison of a picture with a stored one, and what a failure leaves to look at."""

from pathlib import Path

import cv2
import numpy as np

CODE_TOLERANCE = 2
"""Difference of code values that rounding on another device may cause."""
PIXEL_TOLERANCE = 0.001
"""Share of pixels that may differ by more: samples that lie on an edge to the last bit."""
DIFFERENCE_GAIN = 8
"""Factor by which the difference picture is brightened."""


def compare_with_golden(
    actual: np.ndarray,
    name: str,
    *,
    golden_folder: Path,
    failure_folder: Path,
    update: bool = False,
) -> None:
    """Fail unless a picture equals the golden one, up to rounding.

    Args:
        actual: RGB code values [0..255, H x W x 3 uint8].
        name: The golden picture is `<golden_folder>/<name>.png`.
        golden_folder: Where golden pictures are kept.
        failure_folder: Where actual, expected and difference are written on failure.
        update: Store `actual` as the golden picture instead of comparing.

    Raises:
        AssertionError: If the pictures differ or there is no golden one.
    """
    assert actual.dtype == np.uint8, f"a picture is [H, W, 3] uint8, got {actual.dtype}"
    assert actual.ndim == 3, f"a picture is [H, W, 3] uint8, got {actual.shape}"
    golden = golden_folder / f"{name}.png"
    if update:
        write_png(golden, actual)
        return
    assert golden.exists(), f"{golden} is missing; run pytest with --update-golden and look at it"
    expected = read_png(golden)
    problem = _describe_difference(actual, expected)
    if problem:
        write_png(failure_folder / f"{name}_actual.png", actual)
        write_png(failure_folder / f"{name}_expected.png", expected)
        if actual.shape == expected.shape:
            brightened = cv2.absdiff(actual, expected).astype(np.uint16) * DIFFERENCE_GAIN
            difference = np.minimum(brightened, 255).astype(np.uint8)
            write_png(failure_folder / f"{name}_difference.png", difference)
        raise AssertionError(f"{name} differs from its golden picture: {problem}; {failure_folder}")


def read_png(path: Path) -> np.ndarray:
    """Read a picture as RGB code values [0..255, H x W x 3 uint8]."""
    encoded = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    return cv2.cvtColor(cv2.imdecode(encoded, cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Write RGB code values [0..255, H x W x 3 uint8]; makes the folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    encoded = cv2.imencode(".png", cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR))[1]
    path.write_bytes(encoded.tobytes())


def _describe_difference(actual: np.ndarray, expected: np.ndarray) -> str:
    """Say in words how two pictures differ beyond the tolerances; empty if they do not."""
    if actual.shape != expected.shape:
        return f"its shape is {actual.shape}, expected {expected.shape}"
    steps = cv2.absdiff(actual, expected).max(axis=2)
    share = float(np.mean(steps > CODE_TOLERANCE))
    if share <= PIXEL_TOLERANCE:
        return ""
    return (
        f"{share:.2%} of its pixels are off by more than {CODE_TOLERANCE} "
        f"(at most {int(steps.max())}), allowed are {PIXEL_TOLERANCE:.2%}"
    )
