"""The comparison with golden pictures itself: it bites, and it leaves something to look at."""

from pathlib import Path

import numpy as np
import pytest

from tests.golden_images import compare_with_golden, read_png, write_png


@pytest.fixture
def folders(tmp_path: Path) -> dict[str, Path]:
    """Give empty folders for golden pictures and for failures."""
    return {"golden_folder": tmp_path / "golden", "failure_folder": tmp_path / "failed"}


@pytest.fixture
def picture(rng: np.random.Generator, folders: dict[str, Path]) -> np.ndarray:
    """Give a picture [40 x 60 x 3] that is stored as the golden "noise"."""
    pixels = rng.integers(3, 253, size=(40, 60, 3), dtype=np.uint8)
    write_png(folders["golden_folder"] / "noise.png", pixels)
    return pixels


def test_equal_picture_passes(picture: np.ndarray, folders: dict[str, Path]) -> None:
    """The same picture, and one that is off by rounding, pass and leave nothing behind."""
    compare_with_golden(picture, "noise", **folders)
    compare_with_golden(picture + np.uint8(2), "noise", **folders)
    assert not folders["failure_folder"].exists()


def test_planted_failure_bites(picture: np.ndarray, folders: dict[str, Path]) -> None:
    """A block of 4 x 4 wrong pixels fails and leaves actual, expected and difference."""
    planted = picture.copy()
    planted[10:14, 20:24, 1] ^= 0x40
    with pytest.raises(AssertionError, match="noise differs from its golden picture"):
        compare_with_golden(planted, "noise", **folders)
    failed = {path.stem: read_png(path) for path in folders["failure_folder"].iterdir()}
    assert set(failed) == {"noise_actual", "noise_expected", "noise_difference"}
    np.testing.assert_array_equal(failed["noise_actual"], planted)
    np.testing.assert_array_equal(failed["noise_expected"], picture)
    rows, columns = np.nonzero(failed["noise_difference"].any(axis=2))
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (10, 13, 20, 23)


def test_small_shift_of_every_pixel_bites(picture: np.ndarray, folders: dict[str, Path]) -> None:
    """Three code values everywhere are more than rounding."""
    with pytest.raises(AssertionError, match=r"100\.00% of its pixels"):
        compare_with_golden(picture + np.uint8(3), "noise", **folders)


def test_other_size_bites(picture: np.ndarray, folders: dict[str, Path]) -> None:
    """A picture with one row less fails."""
    with pytest.raises(AssertionError, match="its shape is"):
        compare_with_golden(picture[1:], "noise", **folders)


def test_missing_golden_bites(folders: dict[str, Path]) -> None:
    """A picture that was never stored fails and says what to do."""
    with pytest.raises(AssertionError, match="--update-golden"):
        compare_with_golden(np.zeros((4, 4, 3), np.uint8), "never_stored", **folders)


def test_update_stores_the_picture(picture: np.ndarray, folders: dict[str, Path]) -> None:
    """With `update` the new picture replaces the golden one and then passes."""
    other = 255 - picture
    compare_with_golden(other, "noise", update=True, **folders)
    compare_with_golden(other, "noise", **folders)


def test_fixture_reads_the_golden_folder(assert_matches_golden, pytestconfig) -> None:
    """The fixture compares with tests/golden, where nothing has this name."""
    if pytestconfig.getoption("--update-golden"):
        pytest.skip("would store the planted picture")
    with pytest.raises(AssertionError, match=r"tests.golden.never_stored\.png is missing"):
        assert_matches_golden(np.zeros((4, 4, 3), np.uint8), "never_stored")
