"""Heights: brightness, or a picture of depth, as the third dimension of a mesh."""

from dataclasses import dataclass
from functools import lru_cache
from math import isfinite

import numpy as np

from stages.mesh import Mesh
from warp_kernels.errors import OptionError

MOST = 10.0
"""Most that a relief is high, in longer sides of the picture."""


@dataclass(frozen=True)
class Relief:
    """How high what is bright stands.

    Raises:
        OptionError: From `parse`, if the text has another form.
    """

    height: float
    """From black to white, as a share of the picture's longer side; below 0 black is on top."""
    path: str | None
    """A picture that tells the heights; None for the colours of the triangles."""

    @classmethod
    def parse(cls, text: str | float) -> "Relief":
        """Read `0.2` or `0.2:depth.png`.

        Args:
            text: As the user wrote it.
        """
        share, _, path = str(text).partition(":")
        try:
            height = float(share)
        except ValueError:
            height = 0.0
        if not (isfinite(height) and 0 < abs(height) <= MOST):
            raise OptionError(
                f"--relief {text}: write a height from -{MOST:g} to {MOST:g}, not 0, such as 0.2, "
                "and perhaps a picture of depth, such as 0.2:depth.png"
            )
        return cls(height, path or None)

    def heights(self, mesh: Mesh, brightness: np.ndarray) -> np.ndarray:
        """Heights of the vertices [px], [V], from 0 upwards.

        Args:
            mesh: The triangles.
            brightness: Of their corners, 0 to 1, [T, 3]; what a picture of depth replaces.
        """
        found = (
            means_around(mesh, brightness)
            if self.path is None
            else sampled(depth_of(self.path), mesh.vertices / (mesh.width, mesh.height))
        )
        high = found if self.height > 0 else 1.0 - found
        return abs(self.height) * max(mesh.width, mesh.height) * np.clip(high, 0.0, 1.0)


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
    from stages.masks.gray import read_gray

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
