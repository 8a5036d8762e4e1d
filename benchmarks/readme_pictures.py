"""Draw the pictures of README and docs/ again: run each one's command, put its frames together.

    python benchmarks/readme_pictures.py [NAME ...] [--keep]

Names are those of `docs/images/`; without one all are drawn. Commands are read from README and the
pages of `docs/` (`doc_commands.py`).
"""

import argparse
import itertools
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from contact_sheet import read_frames
from doc_commands import ROOT, make

IMAGES = ROOT / "docs" / "images"

BUNNY = "sample_videos/bigbuckbunny.mp4"
CITY = "sample_videos/city.mp4"
ASTRONAUT = "sample_videos/astronaut.jpg"

Cell = tuple[str, int]
"""A file and the frame of it, counted from its first one."""


def of(file: str, *frames: int) -> list[Cell]:
    """A row: frames of one file, side by side."""
    return [(file, frame) for frame in frames]


def stills(*files: str) -> list[Cell]:
    """A row: one picture a file, side by side."""
    return [(file, 0) for file in files]


@dataclass(frozen=True)
class Picture:
    """How a picture is put together."""

    rows: Sequence[Sequence[Cell]]
    """From top to bottom; those of one picture are equally long."""
    width: int
    """Width to which every frame is scaled [px]."""
    crop: tuple[int, int, int, int] | None = None
    """What is then cut out of it: left, top, width and height [px]."""
    gap: int = 4
    """White between frames [px]."""
    quality: int = 88
    """Of the JPEG, 0 to 100."""


PICTURES: dict[str, Picture] = {
    "bigbuckbunny": Picture([of(BUNNY, 0, 37, 74), of("out/rabbit.mp4", 0, 37, 74)], 480),
    "city": Picture([of(CITY, 20, 60), of("out/city.mp4", 20, 60)], 600),
    "edges": Picture([of("out/edges.mp4", 37, 74)], 720),
    "linear": Picture([of("out/linear.mp4", 37, 74)], 720),
    "astronaut": Picture([stills(ASTRONAUT, "out/poster.png")], 512),
    "weights": Picture(
        [stills("docs/images/face_weights.png", "out/even.png", "out/face.png")], 512, gap=8
    ),
    "targets": Picture([stills("out/quality.png", "out/area.png")], 512),
    "preview": Picture(
        [stills("out/shot_0060.png", "out/shot_0067.png", "out/shot_0074.png")], 480
    ),
    "independent": Picture(
        [of("out/alone.mp4", 0, 1, 2), of("out/followed.mp4", 0, 1, 2)], 1280, (700, 150, 480, 280)
    ),
    "focus": Picture(
        [stills(ASTRONAUT, "out/blank.png", "out/poster.png")], 1024, (180, 60, 520, 500), gap=8
    ),
    "focus_clip": Picture(
        [of("out/blank.mp4", 10, 36, 62), of("out/smiling.mp4", 10, 36, 62)], 480, gap=8, quality=86
    ),
    "styles": Picture([stills("out/styles.png")], 1200, quality=80),
    "hatching": Picture([of("out/hatching.mp4", 57)], 1120, quality=86),
    "pencils": Picture([of("out/pencils.mp4", 57)], 1120, quality=86),
    "pen_face": Picture([stills("out/pen_face.png")], 760, quality=86),
    "follow": Picture([of("out/follow.mp4", 2, 12, 28)], 667, (31, 0, 396, 375), 6, 82),
    "circles": Picture([stills("out/circles.png")], 760),
    "glass": Picture([of("out/glass.mp4", 57)], 1120, quality=86),
    "lights": Picture([of("out/lights.mp4", 0)], 1120),
    "music_video": Picture(
        [of("out/music_video.mp4", 12, 36, 54, 96), of("out/music_video.mp4", 133, 151, 171, 181)],
        480,
        quality=84,
    ),
    "music_plan": Picture([stills("out/music_plan.png")], 1600, quality=86),
    "moves": Picture(
        [
            stills("out/assembles.png", "out/explodes.png", "out/shatters.png"),
            stills("out/pulses.png", "out/waves.png", "out/jitters.png"),
        ],
        400,
        quality=86,
    ),
    "pulse": Picture([of("out/pulse.mp4", 3, 12, 43, 50)], 480),
    "build-up": Picture([of("out/build-up.mp4", 4, 20, 45, 72)], 480),
    "ink-to-colour": Picture([of("out/ink-to-colour.mp4", 10, 28, 45, 65)], 480, quality=86),
    "strobe-safe": Picture([of("out/strobe-safe.mp4", 7, 43, 53, 70)], 480, quality=86),
    "palettes": Picture(
        [
            stills("out/sunset.png", "out/poster_colors.png"),
            stills("out/borrowed.png", "out/graded.png"),
        ],
        600,
        quality=86,
    ),
    "loop": Picture(
        [of("out/loop.mp4", 33, 39, 42), of("out/loop.mp4", 44, 47, 0)], 480, quality=84
    ),
    "layouts": Picture(
        [
            stills("out/poisson.png", "out/outlines.png", "out/hex.png"),
            stills("out/phyllotaxis.png", "out/radial.png", "out/web.png"),
        ],
        400,
        quality=86,
    ),
    "kept": Picture([stills("out/kept.png", "out/half_kept.png")], 512, quality=84),
    "lattice": Picture([of("out/lattice.mp4", 0, 9, 20)], 480, quality=84),
    "lenses": Picture([of("out/lenses.mp4", 61)], 1120),
}


def look(cell: Cell, picture: Picture) -> np.ndarray:
    """Read a frame as it stands in the picture.

    Returns:
        RGB code values [0..255, h x w x 3 uint8].
    """
    file, number = cell
    frames = (pixels for _, pixels in read_frames(ROOT / file))
    pixels = next(itertools.islice(frames, number, None), None)
    if pixels is None:
        raise ValueError(f"{file}: has no frame {number}")
    size = (picture.width, round(pixels.shape[0] * picture.width / pixels.shape[1]))
    is_smaller = picture.width < pixels.shape[1]
    way = cv2.INTER_AREA if is_smaller else cv2.INTER_CUBIC
    scaled = pixels if size[0] == pixels.shape[1] else cv2.resize(pixels, size, interpolation=way)
    left, top, width, height = picture.crop or (0, 0, *size)
    return scaled[top : top + height, left : left + width]


COPIED = {"poster": "out/poster.svg", "stretch": "out/stretch.gif"}
"""What is shown as it was made: a film and a drawing."""


def joined(parts: Sequence[np.ndarray], axis: int, gap: int) -> np.ndarray:
    """Put pictures [h x w x 3] beside (axis 1) or below (axis 0) each other, white between them."""
    shape = list(parts[0].shape)
    shape[axis] = gap
    white = np.full(shape, 255, dtype=np.uint8)
    spaced = [piece for part in parts for piece in (white, part)][1:]
    return np.concatenate(spaced, axis=axis)


def draw(name: str) -> None:
    """Put a picture together and store it."""
    picture = PICTURES[name]
    rows = [joined([look(cell, picture) for cell in row], 1, picture.gap) for row in picture.rows]
    pixels = joined(rows, 0, picture.gap)
    path = IMAGES / f"{name}.jpg"
    cv2.imwrite(str(path), pixels[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, picture.quality])
    print(f"{path.relative_to(ROOT)}: {pixels.shape[1]}x{pixels.shape[0]}, {path.stat().st_size}")


def main() -> int:
    """Read the command line and draw."""
    names = [*PICTURES, *COPIED]
    parser = argparse.ArgumentParser(description="Draw the pictures of README and docs/.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(names)}")
    parser.add_argument("--keep", action="store_true", help="take files of out/ as they are")
    options = parser.parse_args()
    unknown = set(options.names) - set(names)
    if unknown:
        parser.error(f"{', '.join(sorted(unknown))}: no picture; they are {', '.join(names)}")
    (ROOT / "out").mkdir(exist_ok=True)
    made: set[str] = set()
    for name in options.names or names:
        if name in COPIED:
            made_file = ROOT / COPIED[name]
            make(COPIED[name], made, options.keep)
            (IMAGES / made_file.name).write_bytes(made_file.read_bytes())
            continue
        for file, _ in (cell for row in PICTURES[name].rows for cell in row):
            make(file, made, options.keep)
        draw(name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
