"""A clip with a face that may be passed on: the portrait among the sample clips, seen by a camera
that pans, turns and comes nearer.

    PYTHONPATH=. python benchmarks/moving_portrait.py out/portrait.mp4
"""

import argparse
from pathlib import Path

import av
import cv2
import numpy as np

from stages.media import open_decoder

PORTRAIT = Path(__file__).parents[1] / "sample_videos" / "astronaut.jpg"
MIDDLE = (240.0, 190.0)
"""What the camera looks at [px of the portrait]."""
SIZE, RATE = (400, 320), 25
"""Width and height [px], and frames a second."""


def view(frame: int) -> np.ndarray:
    """Where the portrait's points are in a frame [px], [2, 3].

    Args:
        frame: Its number.
    """
    turn = 10.0 * np.sin(2 * np.pi * frame / 50)
    matrix = cv2.getRotationMatrix2D(MIDDLE, turn, 1.15 * 1.004**frame)
    pan = (35 * np.sin(2 * np.pi * frame / 60), 13 * np.cos(2 * np.pi * frame / 45))
    matrix[:, 2] += np.array(SIZE) / 2 + pan - MIDDLE
    return matrix


def write(path: Path, frames: int) -> None:
    """Write the clip.

    Args:
        path: An mp4.
        frames: How many.
    """
    with open_decoder(PORTRAIT) as decoder:
        portrait = next(decoder).pixels
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=RATE, options={"crf": "14"})
        stream.width, stream.height = SIZE
        stream.pix_fmt = "yuv420p"
        for frame in range(frames):
            picture = cv2.warpAffine(
                portrait,
                view(frame),
                SIZE,
                flags=cv2.INTER_CUBIC,
                borderMode=cv2.BORDER_REFLECT,
            )
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())


def main() -> None:
    """Read the command line and write the clip."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="the clip, an mp4")
    parser.add_argument("--frames", type=int, default=75, help="how many (default: 75)")
    given = parser.parse_args()
    write(given.output, given.frames)


if __name__ == "__main__":
    main()
