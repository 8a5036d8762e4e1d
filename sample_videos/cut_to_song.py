"""Cut the sample clips to the bars of `song.ogg`: a rough cut without sound, for a music video.

    python sample_videos/cut_to_song.py OUTPUT.mp4

A beat of the song takes twelve frames. Towers at night, the rabbit, towers and a portrait for half
a bar each, and the rabbit again; 1280 x 720, 25 frames a second.
"""

import argparse
from collections.abc import Iterator
from fractions import Fraction
from itertools import islice, repeat
from pathlib import Path

import av
from av.video.reformatter import Interpolation

HERE = Path(__file__).parent
SIZE = (1280, 720)
"""Width and height [px]."""
CUTS = (
    ("city.mp4", 0, 48),
    ("bigbuckbunny.mp4", 0, 48),
    ("city.mp4", 50, 74),
    ("astronaut.jpg", 0, 24),
    ("bigbuckbunny.mp4", 27, 75),
)
"""File, its first frame, and the first one that is not taken; a still stands."""
FACE_TOP = 8
"""Where the part of the portrait begins that has the shape of the film [px]."""


def frames() -> Iterator[av.VideoFrame]:
    """Give the frames of the cut, one after the other."""
    for name, first, end in CUTS:
        with av.open(str(HERE / name)) as file:
            pictures = file.decode(video=0)
            if name.endswith(".mp4"):
                yield from islice(pictures, first, end)
            else:
                yield from repeat(_face(next(pictures)), end - first)


def _face(portrait: av.VideoFrame) -> av.VideoFrame:
    """Cut a part in the shape of the film out of the portrait."""
    pixels = portrait.to_ndarray(format="rgb24")
    height = pixels.shape[1] * SIZE[1] // SIZE[0]
    return av.VideoFrame.from_ndarray(pixels[FACE_TOP : FACE_TOP + height], format="rgb24")


def cut(path: Path) -> None:
    """Write the cut as H.264, near to lossless."""
    with av.open(str(path), "w") as file:
        stream = file.add_stream("libx264", rate=25, options={"crf": "14", "preset": "veryfast"})
        stream.width, stream.height = SIZE
        stream.pix_fmt = "yuv420p"
        for index, frame in enumerate(frames()):
            # 720p counts as BT.709 where nothing is said; `city.mp4` is BT.601
            shown = frame.reformat(
                *SIZE, "yuv420p", dst_colorspace="itu709", interpolation=Interpolation.LANCZOS
            )
            shown.pts, shown.time_base, shown.pict_type = index, Fraction(1, 25), 0
            file.mux(stream.encode(shown))
        file.mux(stream.encode(None))


def main() -> None:
    """Read the command line and cut."""
    parser = argparse.ArgumentParser(description="Cut the sample clips to the bars of song.ogg.")
    parser.add_argument("output", type=Path, metavar="OUTPUT.mp4")
    cut(parser.parse_args().output)


if __name__ == "__main__":
    main()
