"""What holds corners on the border of the picture while others move."""

import numpy as np

from stages.moves.easing import smooth


def within(places: np.ndarray, size: tuple[int, int], margin: float) -> np.ndarray:
    """How free places are to move, across and down, 0 to 1, of the shape of `places`.

    On a border they may move along it alone; so the picture keeps its edge.

    Args:
        places: Positions [px], [..., 2].
        size: Width and height of the picture [px].
        margin: How far from a border they are quite free [px], above 0.
    """
    nearest = np.minimum(places, np.array(size) - places)
    return smooth(nearest / margin)
