"""Heights: brightness, or a picture of depth, as the third dimension of a mesh."""

from functools import lru_cache

import numpy as np

from stages.exchange.relief import Relief
from stages.masks.gray import read_gray
from stages.mesh import Mesh


def heights_of(relief: Relief, mesh: Mesh, brightness: np.ndarray) -> np.ndarray:
    """Heights of the vertices [px], [V], from 0 upwards.

    Args:
        relief: What is wanted.
        mesh: The triangles.
        brightness: Of their corners, 0 to 1, [T, 3]; what a picture of depth replaces.
    """
    found = (
        means_around(mesh, brightness)
        if relief.path is None
        else sampled(depth_of(relief.path), mesh.vertices / (mesh.width, mesh.height))
    )
    high = found if relief.height > 0 else 1.0 - found
    return abs(relief.height) * max(mesh.width, mesh.height) * np.clip(high, 0.0, 1.0)


def means_around(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """Means of what the triangles around each vertex have at it, [V].

    Each counts by its angle there: so much of the vertex's surroundings it covers, however large it
    is farther away.

    Args:
        mesh: The triangles.
        values: At their corners, [T, 3].
    """
    corners = mesh.corners
    onwards, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cross = onwards[..., 0] * back[..., 1] - onwards[..., 1] * back[..., 0]
    angles = np.arctan2(np.abs(cross), (onwards * back).sum(axis=2)).ravel()
    places, count = mesh.triangles.ravel(), mesh.vertex_count
    total = np.bincount(places, angles, count)
    weighted = np.bincount(places, angles * values.ravel(), count)
    return np.asarray(weighted / np.maximum(total, 1e-12))


@lru_cache(maxsize=1)
def depth_of(path: str) -> np.ndarray:
    """A picture of depth, 0 to 1, [h, w]; read once for all frames.

    Raises:
        MediaError: If it cannot be read.
    """
    return read_gray(path)


def sampled(picture: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values of a picture between its pixels, [N].

    Args:
        picture: [h, w].
        places: Right and down, as shares of the picture, [N, 2].
    """
    rows, columns = picture.shape
    x = np.clip(places[:, 0] * columns - 0.5, 0, columns - 1)
    y = np.clip(places[:, 1] * rows - 0.5, 0, rows - 1)
    left, top = x.astype(np.int64), y.astype(np.int64)
    right, below = np.minimum(left + 1, columns - 1), np.minimum(top + 1, rows - 1)
    across, down = x - left, y - top
    upper = picture[top, left] * (1 - across) + picture[top, right] * across
    lower = picture[below, left] * (1 - across) + picture[below, right] * across
    return np.asarray(upper * (1 - down) + lower * down)
