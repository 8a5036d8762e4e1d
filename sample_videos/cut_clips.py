"""Cut the sample clips and the still from their originals; run once, the results are committed.

    python sample_videos/cut_clips.py bigbuckbunny.mp4 cityCC0.mpg astronaut.png

README.md beside this file says where the originals come from and who made them.
"""

import argparse
from fractions import Fraction
from itertools import islice
from pathlib import Path

import av
import av.filter
import cv2
from av.video.reformatter import ColorRange

HERE = Path(__file__).parent
BUNNY_FRAMES = 75
"""The first 3 s: the rabbit leaves its burrow and stretches."""
CITY_FIRST_FRAME, CITY_LAST_FRAME = 66, 140
"""Frames of the original, both included; its hard cut before frame 116 becomes frame 50."""
CITY_SIZE = (720, 404)
"""Width and height [px]; the original has 405 rows, and 4:2:0 needs an even number."""
BT601 = 6
"""H.264's code of SMPTE 170M, in all three colour tags: what players assume of this clip."""


def copy_start(source: Path, target: Path, frame_count: int) -> None:
    """Copy the packets of the first frames and of the sound under them; nothing is re-encoded.

    Args:
        source: An mp4 without reordered frames, so that any prefix of its packets decodes.
        target: The mp4 to write.
        frame_count: Frames to keep.
    """
    with av.open(str(source)) as original, av.open(str(target), "w") as cut:
        pictures, sound = original.streams.video[0], original.streams.audio[0]
        end = frame_count / pictures.average_rate
        copies = {s.index: cut.add_stream_from_template(s) for s in (pictures, sound)}
        for packet in original.demux(pictures, sound):
            if packet.size and packet.pts * packet.time_base < end:
                packet.stream = copies[packet.stream.index]
                cut.mux(packet)


def encode_range(source: Path, target: Path, first: int, last: int) -> None:
    """Re-encode frames `first` to `last`, both included, as H.264 at 25 frames per second.

    The Y'CbCr samples keep their matrix (BT.601); the last row is cropped away.
    """
    width, height = CITY_SIZE
    options = {"crf": "21", "preset": "veryslow", "threads": "1"}
    with av.open(str(source)) as original, av.open(str(target), "w") as cut:
        video = cut.add_stream("libx264", rate=25, options=options)
        video.width, video.height, video.pix_fmt = width, height, "yuv420p"
        context = video.codec_context
        context.color_range = ColorRange.MPEG
        context.colorspace = context.color_primaries = context.color_trc = BT601
        crop = av.filter.Graph()
        crop.link_nodes(
            crop.add_buffer(template=original.streams.video[0]),
            crop.add("crop", f"{width}:{height}:0:0"),
            crop.add("buffersink"),
        ).configure()
        for index, frame in enumerate(islice(original.decode(video=0), first, last + 1)):
            crop.push(frame)
            cropped = crop.pull()
            cropped.pts, cropped.time_base, cropped.pict_type = index, Fraction(1, 25), 0
            cut.mux(video.encode(cropped))
        cut.mux(video.encode(None))


def shrink_still(source: Path, target: Path) -> None:
    """Store a picture as a JPEG of quality 92."""
    cv2.imwrite(str(target), cv2.imread(str(source)), [cv2.IMWRITE_JPEG_QUALITY, 92])


def main() -> None:
    """Write the two clips and the still beside this file."""
    parser = argparse.ArgumentParser(description="Cut the sample clips from their originals.")
    for original in ("bigbuckbunny", "city", "astronaut"):
        parser.add_argument(original, type=Path)
    paths = parser.parse_args()
    copy_start(paths.bigbuckbunny, HERE / "bigbuckbunny.mp4", BUNNY_FRAMES)
    encode_range(paths.city, HERE / "city.mp4", CITY_FIRST_FRAME, CITY_LAST_FRAME)
    shrink_still(paths.astronaut, HERE / "astronaut.jpg")


if __name__ == "__main__":
    main()
