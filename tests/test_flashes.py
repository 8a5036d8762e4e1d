"""Flashes are told where WCAG counts them, at any frame rate, and nowhere else."""

import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import trimotion
from stages.metrics.flashes import Flashes, FlashWatch
from tests import media_samples as samples

RATES = [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(60), Fraction(120)]
QUICK = {"iterations": 4, "frame_iterations": 2, "triangles": 20, "focus": "none"}


def square(hertz: float) -> Callable[[float], float]:
    """Black and white in turn, so many times a second."""
    return lambda time: float(math.floor(2 * hertz * time + 1e-9) % 2)


def code_of(luminance: float) -> int:
    """The grey of a relative luminance, [0..255]."""
    root = 1.055 * luminance ** (1 / 2.4) - 0.055 if luminance > 0.0031308 else 12.92 * luminance
    return round(255 * root)


def watched(
    course: Callable[[float], float],
    rate: Fraction = Fraction(25),
    area: float = 1.0,
    seconds: float = 3.0,
    ground: float = 0.2,
) -> Flashes | None:
    """What is found in a grey film whose left part follows a course of relative luminance."""
    watch = FlashWatch()
    for number in range(round(seconds * rate)):
        pixels = np.full((18, 32, 3), code_of(ground), dtype=np.uint8)
        pixels[:, : round(32 * area)] = code_of(course(float(number / rate)))
        watch.add(pixels, number / rate)
    return watch.found


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_quick_flicker_is_told_and_slow_is_not(rate: Fraction) -> None:
    assert watched(square(2), rate) is None
    found = watched(square(5), rate)
    assert found is not None
    assert found.count == 1
    assert found.first.area == 1
    assert found.first.rate == pytest.approx(5, rel=0.1)
    assert found.first.begins == pytest.approx(0.1, abs=float(1 / rate))
    assert found.first.ends == pytest.approx(2.9, abs=float(1.5 / rate))


def test_three_flashes_a_second_are_allowed_and_four_are_not() -> None:
    for rate in (Fraction(24), Fraction(30), Fraction(60)):
        assert watched(square(3), rate) is None
        assert watched(square(4), rate) is not None


def test_three_flashes_at_once_and_a_rest_are_allowed() -> None:
    def burst(time: float) -> float:
        return square(5)(time % 1.2) if time % 1.2 < 0.6 else 0.0

    assert watched(burst, Fraction(50)) is None


def test_a_quarter_of_the_picture_is_allowed() -> None:
    assert watched(square(5), area=1 / 8) is None
    assert watched(square(5), area=1 / 4) is None
    found = watched(square(5), area=3 / 8)
    assert found is not None
    assert found.first.area == pytest.approx(3 / 8)


def test_small_bright_and_slow_changes_are_no_flashes() -> None:
    def between(low: float, high: float) -> Callable[[float], float]:
        return lambda time: low + (high - low) * square(5)(time)

    assert watched(between(0.5, 0.58)) is None
    assert watched(between(0.5, 0.62)) is not None
    assert watched(between(0.84, 1.0)) is None
    assert watched(between(0.76, 0.9)) is not None
    assert watched(lambda time: 0.5 + 0.5 * math.sin(2 * math.pi * time)) is None


def test_a_flash_may_take_many_frames() -> None:
    found = watched(lambda time: 0.5 + 0.5 * math.sin(10 * math.pi * time), Fraction(120))
    assert found is not None
    assert found.first.rate == pytest.approx(5, rel=0.1)


def test_places_are_told_apart() -> None:
    def course(time: float) -> float:
        return square(5)(time) if 1 <= time < 3 or 6 <= time < 8 else 0.0

    found = watched(course, seconds=9, ground=0.0)
    assert found is not None
    assert found.count == 2
    assert "from 0:01.1 to 0:03.0, over 100 % of the picture and 1 more time up to 0:08.0:" in (
        found.note
    )


def test_textures_that_flicker_are_no_flashes() -> None:
    watch, fine = FlashWatch(), np.indices((144, 256)).sum(axis=0) % 2 * 255
    for number in range(50):
        pixels = np.repeat((fine if number % 2 else 255 - fine)[..., None], 3, axis=2)
        watch.add(pixels.astype(np.uint8), Fraction(number, 25))
    assert watch.found is None


def test_what_is_clear_is_white() -> None:
    watch = FlashWatch()
    for number in range(50):
        pixels = np.zeros((9, 16, 4), dtype=np.uint8)
        pixels[..., 3] = 255 * (number % 2)
        watch.add(pixels, Fraction(number, 25))
    assert watch.found is not None


def test_films_that_flash_are_told_and_stills_are_not(tmp_path: Path) -> None:
    pictures = [np.full((48, 64, 3), 230 * (number % 2), dtype=np.uint8) for number in range(10)]
    clip = samples.write_video(tmp_path / "clip.mp4", pictures)
    track = tmp_path / "clip.mtrk"
    made = trimotion.animate(clip, tmp_path / "out.mp4", track=track, **QUICK)
    (told,) = (note for note in made.notes if "flashes" in note)
    assert "over 100 % of the picture" in told
    again = trimotion.render(track, tmp_path / "again.mp4")
    assert told in again.notes
    part = trimotion.render(track, tmp_path / "part.mp4", frames="0-5")
    stills = trimotion.render(track, tmp_path / "still_##.png")
    assert not any("flashes" in note for note in (*part.notes, *stills.notes))
