"""The pictures of the experiments: a folder of the user's, or stills of the sample clips."""

from pathlib import Path

import cv2
import numpy as np

from benchmarks.timing import read_picture
from stages.media import FrameRange
from stages.media.reading.decode import open_decoder

SAMPLES = Path(__file__).parents[2] / "sample_videos"
STILLS = (
    ("astronaut.jpg", 0),
    ("bigbuckbunny.mp4", 0),
    ("bigbuckbunny.mp4", 70),
    ("city.mp4", 0),
    ("city.mp4", 60),
    ("shapes.mp4", 20),
)
"""Sample and number of the frame: a portrait, drawn scenes, photographs, abstract shapes."""
ENDINGS = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"})
LARGEST = 512 * 512
"""Larger pictures are reduced to this many pixels, as those of the paper have."""


def sample_pictures() -> dict[str, np.ndarray]:
    """Stills of the samples by name, [H, W, 3] uint8 each."""
    pictures = {}
    for name, number in STILLS:
        path = SAMPLES / name
        with open_decoder(path, FrameRange(number, number)) as frames:
            pixels = next(frames).pixels
        label = path.stem if path.suffix == ".jpg" else f"{path.stem} {number}"
        pictures[label] = reduced(pixels)
    return pictures


def folder_pictures(folder: Path) -> dict[str, np.ndarray]:
    """The stills of a folder by name, [H, W, 3] uint8 each.

    Raises:
        SystemExit: If there is none.
    """
    paths = sorted(path for path in folder.glob("*") if path.suffix.lower() in ENDINGS)
    if not paths:
        raise SystemExit(f"{folder}: holds no still; give a folder of PNG or JPEG files")
    return {path.stem: reduced(read_picture(path)) for path in paths}


def reduced(pixels: np.ndarray) -> np.ndarray:
    """A picture of at most `LARGEST` pixels, of the same shape."""
    height, width = pixels.shape[:2]
    scale = np.sqrt(LARGEST / (width * height))
    if scale >= 1:
        return np.ascontiguousarray(pixels)
    size = (round(scale * width), round(scale * height))
    return cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
