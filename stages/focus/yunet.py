"""Find faces in one picture: the network YuNet, run by OpenCV alone.

The network is a stack of convolutions, so a picture of any size goes through it at once. In a
picture that it gets it sees faces of about 10 to 300 px; larger ones are found in reduced copies.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from stages.focus.face import Face
from warp_kernels.errors import OptionError

MODEL = Path(__file__).parent / "models" / "yunet_n.onnx"
"""The network; its origin and licence stand beside it."""
GRIDS = (8, 16, 32)
"""Its three grids: distance of their cells [px of the picture that it gets]."""
LIKELY = 0.4
"""Least score of what is looked at again, 0 to 1."""
CROP = 96
"""Side of the square in which it is looked at again [px]."""
LOOKS = ((24.0, False), (32.0, True), (44.0, True), (32.0, False), (44.0, False), (24.0, True))
"""How: sizes of the face there [px], and whether it is mirrored. What looks like a face by its
details only, as a rabbit's does, is none in so few pixels."""
TURNS = (0.0, 40.0, -40.0, 90.0, -90.0)
"""How far it may be turned beside what its eyes tell [degrees]."""
CLEAR = 0.88
"""With such a score of the first look, in the fewest pixels, it is turned no further."""
AROUND = 28.0
"""Size that a face has where it is looked for around a place: the crop shows far more [px]."""
HOPELESS = 0.45
"""Below this mean of the first looks the others are spared."""
ALIKE = 0.3
"""Answers whose squares share this part of their union are one face."""
WIDEST = 8.0
"""Logarithm of the largest face that is answered [steps of a grid]: in pictures of few pixels there
are answers without bounds."""
FARTHEST = 4.0
"""And further away nothing is a face [longer sides of what the network gets]."""
LEAST_SIZE = 10.0
"""Smaller faces are not believed [px of the picture that the network gets]."""


class YuNet:
    """The network, loaded once; not to be shared by threads.

    Raises:
        OptionError: If its file is missing or damaged.

    Source: Wu, Peng and Yu, YuNet: A Tiny Millisecond-level Face Detector (2023).
    """

    def __init__(self, path: Path = MODEL) -> None:
        try:
            self._net = cv2.dnn.readNetFromONNX(str(path), engine=cv2.dnn.ENGINE_CLASSIC)
        except cv2.error as error:
            raise OptionError(
                f"--focus faces: {path} is missing or damaged; install trimotion again, or use "
                "--focus none"
            ) from error

    def find(self, pixels: np.ndarray, scale: float) -> list[tuple[float, Face]]:
        """Find what looks like a face in a picture.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            scale: Size of what the network gets beside that of the picture, at most 1.

        Returns:
            Scores [0..1] and faces, the best first.
        """
        height, width = pixels.shape[:2]
        reduced = [max(1, round(scale * side)) for side in (width, height)]
        copy = cv2.resize(pixels, reduced, interpolation=cv2.INTER_AREA)
        scores, answers = self._answers(copy)
        likely = (scores >= LIKELY) & (answers[:, 1].mean(axis=1) >= LEAST_SIZE)
        stretch = np.array([width / reduced[0], height / reduced[1]])
        return _merged(scores[likely], answers[likely] * stretch)

    def examined(self, pixels: np.ndarray, face: Face) -> tuple[float, Face]:
        """Look again at what may be a face, upright and in sizes that suit.

        Ferns, fur and folds of cloth look like a face once; faces look so again and again.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            face: What may be a face.

        Returns:
            How sure it is [0..1], the mean score of the looks, or 0 as soon as that can only be
            low; and where the looks saw the face.
        """
        total, places, size = 0.0, np.zeros((4, 2)), 0.0
        face = self._turned(pixels, face)
        for count, (wanted, is_mirrored) in enumerate(LOOKS, start=1):
            score, seen = self._look(pixels, face, wanted, is_mirrored)
            total += score
            if total < HOPELESS * count:
                return 0.0, face
            places += score * seen.places
            size += score * seen.size
        return total / len(LOOKS), Face(places / total, size / total)

    def _turned(self, pixels: np.ndarray, face: Face) -> Face:
        """The face turned as a first look sees it best: of turned ones eyes are not told right."""
        best, most = face, 0.0
        for turn in TURNS:
            across, down = np.cos(np.radians(turn)), np.sin(np.radians(turn))
            turned = (face.places - face.middle) @ np.array([[across, down], [-down, across]])
            other = replace(face, places=face.middle + turned)
            score = self._look(pixels, other, *LOOKS[0])[0]
            if score > most:
                best, most = other, score
            if most >= CLEAR:
                break
        return best

    def near(self, pixels: np.ndarray, face: Face) -> tuple[float, Face]:
        """Look for a face around the place where it was before.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            face: The face in an earlier picture.

        Returns:
            As `examined`; 0 if there is none.
        """
        score, seen = self._look(pixels, face, AROUND, False, away=1.0)
        return self.examined(pixels, seen) if score >= HOPELESS else (0.0, face)

    def _look(
        self, pixels: np.ndarray, face: Face, size: float, is_mirrored: bool, away: float = 0.35
    ) -> tuple[float, Face]:
        """The best answer for a face of about a size in the middle of a crop.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            face: What the crop shows.
            size: How large it is there [px].
            is_mirrored: Whether the crop is mirrored.
            away: How far from the middle the answer may be [face sizes].

        Returns:
            Its score [0..1] and its face in the picture.
        """
        crop, matrix = _upright(pixels, face, size)
        scores, answers = self._answers(crop[:, ::-1] if is_mirrored else crop)
        sizes = answers[:, 1].mean(axis=1)
        distances = np.hypot(*(answers[:, 0] - CROP / 2).T)
        meant = (distances < away * size) & (sizes > 0.6 * size) & (sizes < 1.7 * size)
        best = int(np.argmax(np.where(meant, scores, -1.0)))
        if not meant[best]:
            return 0.0, face
        places = answers[best][[0, 2, 3, 4]]
        if is_mirrored:
            places = places[[0, 2, 1, 3]] * (-1.0, 1.0) + (CROP, 0.0)
        back = cv2.invertAffineTransform(matrix)
        shrink = float(np.sqrt(abs(np.linalg.det(back[:, :2]))))
        seen = Face(places @ back[:, :2].T + back[:, 2], float(sizes[best]) * shrink)
        return float(scores[best]), seen

    def _answers(self, picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """All answers of the network.

        Args:
            picture: What it gets, [h, w, 3] uint8.

        Returns:
            Scores [0..1], [N], and places [px], [N, 5, 2]: middle, width and height, right eye,
            left eye, mouth.
        """
        height, width = picture.shape[:2]
        rows, columns = (-(-side // 32) * 32 for side in (height, width))
        given = np.zeros((1, 3, rows, columns), dtype=np.float32)
        given[0, :, :height, :width] = picture[..., ::-1].transpose(2, 0, 1)
        self._net.setInput(given)
        kinds = [f"{kind}_{step}" for kind in ("cls", "obj", "bbox", "kps") for step in GRIDS]
        outputs = [output[0].astype(np.float64) for output in self._net.forward(kinds)]
        grids = [np.concatenate(outputs[n : n + len(GRIDS)]) for n in range(0, len(outputs), 3)]
        faceness, objectness, boxes, points = grids
        cells, steps = _cells(columns, rows)
        answers = np.empty((len(cells), 5, 2))
        answers[:, 0] = cells + boxes[:, :2] * steps
        answers[:, 1] = np.exp(np.minimum(boxes[:, 2:], WIDEST)) * steps
        seen = cells[:, None] + points.reshape(-1, 5, 2) * steps[:, None]
        answers[:, 2:4] = seen[:, :2]
        answers[:, 4] = seen[:, 3:].mean(axis=1)  # its corners; nobody asks for the nose
        both = np.clip(faceness, 0.0, 1.0) * np.clip(objectness, 0.0, 1.0)
        sane = (np.abs(answers) <= FARTHEST * max(rows, columns)).all(axis=(1, 2))
        return np.where(sane, np.sqrt(both[:, 0]), 0.0), answers


def _upright(pixels: np.ndarray, face: Face, size: float) -> tuple[np.ndarray, np.ndarray]:
    """A face in the middle of a square picture, turned so that its eyes are level.

    Args:
        pixels: The picture, [H, W, 3] uint8.
        face: The face.
        size: How large it becomes [px].

    Returns:
        [CROP, CROP, 3] uint8, and what leads from the picture's positions to its own, [2, 3].
    """
    across = face.places[2] - face.places[1]
    # of a profile the eyes lie in one place
    apart = np.hypot(*across) > 0.1 * face.size
    turn = np.degrees(np.arctan2(across[1], across[0])) if apart else 0.0
    # reduced by halves first: the mapping takes single pixels
    halves = 2 ** max(0, int(np.log2(max(face.size / size, 1.0))))
    reach = 0.75 * CROP / size * face.size
    low = np.clip(np.floor(face.middle - reach).astype(int), 0, pixels.shape[1::-1])
    high = np.clip(np.ceil(face.middle + reach).astype(int), low + 1, pixels.shape[1::-1])
    low = np.minimum(low, high - 1)
    near = pixels[low[1] : high[1], low[0] : high[0]]
    reduced = [max(1, side // halves) for side in near.shape[1::-1]]
    copy = cv2.resize(near, reduced, interpolation=cv2.INTER_AREA)
    shrink = np.array(reduced) / near.shape[1::-1]
    middle = (float(face.middle[0]), float(face.middle[1]))
    matrix = np.asarray(cv2.getRotationMatrix2D(middle, turn, size / face.size), np.float64)
    matrix[:, 2] += CROP / 2 - face.middle
    # positions count from corners of pixels, OpenCV's from their middles
    inside = matrix.copy()
    inside[:, 2] += matrix[:, :2] @ low
    inside[:, :2] /= shrink
    inside[:, 2] += inside[:, :2] @ (0.5, 0.5) - 0.5
    return cv2.warpAffine(copy, inside, (CROP, CROP), flags=cv2.INTER_LINEAR), matrix


@cache
def _cells(width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the network's answers count from and in what, in their order.

    Args:
        width: Of what it gets [px].
        height: The same.

    Returns:
        Corners of cells [px], [N, 2], and their sides [px], [N, 1].
    """
    corners, sides = [], []
    for step in GRIDS:
        y, x = np.mgrid[0 : height // step, 0 : width // step]
        corners.append(step * np.stack([x, y], axis=-1).reshape(-1, 2).astype(np.float64))
        sides.append(np.full((len(corners[-1]), 1), float(step)))
    return np.concatenate(corners), np.concatenate(sides)


def _merged(scores: np.ndarray, answers: np.ndarray) -> list[tuple[float, Face]]:
    """One face of all the answers that mean it: their mean, weighted by the scores."""
    found = []
    left = np.argsort(-scores, kind="stable")
    while len(left):
        centres, sizes = answers[left, 0], answers[left, 1].mean(axis=1)
        same = overlap(centres[:1], sizes[:1], centres, sizes)[0] >= ALIKE
        same[0] = True
        weights = scores[left[same]]
        mean = np.average(answers[left[same]], axis=0, weights=weights)
        places = mean[[0, 2, 3, 4]]
        found.append((float(weights[0]), Face(places, float(mean[1].mean()))))
        left = left[~same]
    return found


def overlap(
    centres: np.ndarray, sizes: np.ndarray, others: np.ndarray, other_sizes: np.ndarray
) -> np.ndarray:
    """Which part of their union squares share.

    Args:
        centres: Middles of squares [px], [N, 2].
        sizes: Their sides [px], [N].
        others: Middles of others [px], [M, 2].
        other_sizes: Their sides [px], [M].

    Returns:
        [N, M], 0 to 1.
    """
    half, other_half = sizes[:, None, None] / 2, other_sizes[None, :, None] / 2
    a, b = centres[:, None], others[None]
    common = np.minimum(a + half, b + other_half) - np.maximum(a - half, b - other_half)
    both = np.clip(common, 0.0, None).prod(axis=2)
    union = sizes[:, None] ** 2 + other_sizes[None] ** 2 - both
    shared: np.ndarray = both / np.maximum(union, 1e-9)
    return shared


def is_same(face: Face, other: Face, least: float = ALIKE) -> bool:
    """Whether two faces of one picture are the same.

    Args:
        face: One.
        other: The other.
        least: Least part of their union that their squares share.
    """
    sizes = np.array([face.size]), np.array([other.size])
    shared = overlap(face.middle[None], sizes[0], other.middle[None], sizes[1])[0, 0]
    return bool(shared >= least)
