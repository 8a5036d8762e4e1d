"""Tonal art maps: exact tones at every size, nested strokes, tiles without seams."""

import numpy as np
import pytest

from warp_kernels.scene.texels import Texels
from warp_kernels.styles.tones.tonal_art_map import (
    TONE_STEP,
    TONES,
    crossing_strokes,
    parallel_strokes,
    tonal_art_map,
)

DRAWINGS = {
    "lines": (parallel_strokes, 0.22, 0.0, 0),
    "thin pencil": (parallel_strokes, 0.05, 1.0, 1),
    "crossings": (crossing_strokes, 0.2, 0.0, 0),
    "thick crossings": (crossing_strokes, 0.6, 0.0, 2),
}
TONE_TOLERANCE = 0.02
"""Of a tone's nominal brightness and of its nominal ink."""


@pytest.fixture(scope="module", params=DRAWINGS)
def tones(request: pytest.FixtureRequest) -> np.ndarray:
    """Give the map of a drawing, [tones, rows, columns]."""
    drawing, width, grain, seed = DRAWINGS[request.param]
    return tonal_art_map(drawing, width=width, grain=grain, seed=seed)


def test_every_level_of_detail_has_the_nominal_tones(tones: np.ndarray) -> None:
    """Scale does not change tone: not by 2 % of the brightness, nor by 2 % of the ink."""
    assert len(tones) == TONES >= 6
    ink = TONE_STEP * np.arange(TONES)
    for level in Texels.of(tones).levels:
        brightness = level.mean(axis=(1, 2)) / 255.0
        np.testing.assert_allclose(brightness, 1.0 - ink, rtol=TONE_TOLERANCE)
        np.testing.assert_allclose(1.0 - brightness, ink, rtol=TONE_TOLERANCE)


def test_darker_tones_hold_the_strokes_of_lighter_ones(tones: np.ndarray) -> None:
    """No texel of any level of detail gets brighter from one tone to the next."""
    for level in Texels.of(tones).levels:
        assert (level[1:] <= level[:-1]).all()
    assert (tones[0] == 1.0).all()


def seam(tones: np.ndarray, axis: int) -> float:
    """Step from the last to the first row or column, per greatest step between neighbours."""
    steps = np.abs(tones - np.roll(tones, 1, axis=axis)).mean(axis=(0, 3 - axis))
    return float(steps[0] / steps[1:].max())


@pytest.mark.parametrize("axis", [1, 2])
def test_tiles_join_without_a_seam(tones: np.ndarray, axis: int) -> None:
    """Opposite borders differ no more than neighbours do, as those of a cut tile would."""
    assert seam(tones[1:], axis) <= 1.0


def test_cut_tile_has_a_seam() -> None:
    """The measure above finds the border of a tile that does not close."""
    tones = tonal_art_map(crossing_strokes, width=0.2, grain=0.0, seed=0)
    assert seam(tones[1:, :, 60:-77], 2) > 1.1


def test_lines_are_drawn_by_hand(tones: np.ndarray) -> None:
    """Strokes waver, swell and end: along them nothing repeats, and no line is whole and even."""
    light = tones[1]
    assert len(np.unique(light, axis=1).T) == light.shape[1]
    inked = light[(light < 1.0).any(axis=1)]
    assert (inked.max(axis=1) - inked.min(axis=1) > 0.2).mean() > 0.8


def test_a_seed_fixes_the_drawing() -> None:
    """The same seed gives the same bits, another one another drawing."""
    first, again, other = (
        tonal_art_map(parallel_strokes, width=0.22, grain=0.5, seed=seed) for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(first, again)
    assert np.abs(first[4] - other[4]).mean() > 0.1
