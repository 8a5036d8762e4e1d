"""Textures: what stands beside a texel."""

import numpy as np
import pytest

from warp_kernels.scene.texels import Texels


@pytest.mark.parametrize("repeats", [False, True])
def test_texels_know_their_neighbours(repeats: bool) -> None:
    """A tile goes on at its other side, another picture's border goes on for ever."""
    texture = Texels.of(np.random.default_rng(0).random((2, 6, 8)))
    for plain, packed in zip(
        texture.levels, texture.with_neighbours(repeats=repeats).levels, strict=True
    ):
        images, rows, columns = plain.shape
        fours = packed.reshape(images, rows, columns, 2, 2)
        for below, right in np.ndindex(2, 2):
            row, column = np.arange(rows) + below, np.arange(columns) + right
            row = row % rows if repeats else np.minimum(row, rows - 1)
            column = column % columns if repeats else np.minimum(column, columns - 1)
            assert np.array_equal(fours[..., below, right], plain[:, row[:, None], column])
