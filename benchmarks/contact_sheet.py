"""Put frames of a source above the same moments of a result, side by side in one PNG.

    python benchmarks/contact_sheet.py SOURCE RESULT -o SHEET.png [--frames 6]

The moments are spread evenly over the result; the source's frames are those shown at these times,
so the two may differ in size, frame rate and length.
"""

import argparse
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
from av.video.reformatter import ColorRange, Interpolation, VideoReformatter

CELL_WIDTH = 320
"""Width of one picture on the sheet [px]."""
GAP = 4
"""White between pictures [px]."""
CAPTION_HEIGHT = 22
"""Room for the time above each column [px]."""
# Without accurate rounding and full chroma the conversion shifts colours by about one level.
ACCURATE = Interpolation.BICUBIC | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT


def read_frames(path: Path) -> Iterator[tuple[Fraction, np.ndarray]]:
    """Decode a video or still.

    Args:
        path: What FFmpeg reads.

    Yields:
        Presentation time [s] and upright RGB pixels [0..255, H x W x 3 uint8] of each frame.
    """
    reformatter = VideoReformatter()
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        stream.thread_type = "AUTO"
        for frame in container.decode(stream):
            # An untagged video is HD or not by its size, as players decide.
            is_hd = frame.width >= 1280 or frame.height > 576
            untagged = frame.colorspace == 2
            rgb = reformatter.reformat(
                frame,
                format="rgb24",
                src_colorspace=("ITU709" if is_hd else "ITU601") if untagged else None,
                dst_color_range=ColorRange.JPEG,
                interpolation=ACCURATE,
            )
            time = Fraction(0) if frame.pts is None else frame.pts * Fraction(frame.time_base)
            yield time, np.rot90(rgb.to_ndarray(), k=round(frame.rotation / 90) % 4)


def pick_times(path: Path, count: int) -> list[Fraction]:
    """Choose the times [s] of `count` frames spread evenly over a video, first and last included.

    Raises:
        ValueError: If the video holds no frame.
    """
    with av.open(str(path)) as container:
        packets = [packet for packet in container.demux(video=0) if packet.size]
    times = sorted((p.pts or 0) * Fraction(p.time_base) for p in packets)
    if not times:
        raise ValueError(f"{path}: holds no frame; give a video or a still")
    chosen = np.unique(np.rint(np.linspace(0, len(times) - 1, count)).astype(int))
    return [times[index] for index in chosen]


def frames_at(path: Path, times: list[Fraction]) -> list[np.ndarray]:
    """Give the picture [H x W x 3 uint8] that is shown at each of the ascending `times` [s].

    Raises:
        ValueError: If the video holds no frame.
    """
    shown: list[np.ndarray] = []
    latest = None
    for time, pixels in read_frames(path):
        while len(shown) < len(times) and latest is not None and time > times[len(shown)]:
            shown.append(latest)
        if len(shown) == len(times):
            return shown
        latest = pixels
    if latest is None:
        raise ValueError(f"{path}: holds no frame; give a video or a still")
    return shown + [latest] * (len(times) - len(shown))


def draw_sheet(source: Path, result: Path, count: int) -> np.ndarray:
    """Draw the sheet: source above, result below, times [s] above the columns.

    Returns:
        RGB code values [0..255, H x W x 3 uint8].
    """
    times = pick_times(result, count)
    rows = [_row(frames_at(path, times)) for path in (source, result)]
    captions = np.full((CAPTION_HEIGHT, rows[0].shape[1], 3), 255, dtype=np.uint8)
    for column, time in enumerate(times):
        place = (GAP + column * (CELL_WIDTH + GAP), CAPTION_HEIGHT - 6)
        text = f"{float(time):.2f} s"
        cv2.putText(captions, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, (40, 40, 40), 1)
    gap = np.full((GAP, rows[0].shape[1], 3), 255, dtype=np.uint8)
    return np.concatenate([captions, rows[0], gap, rows[1], gap])


def _row(pictures: list[np.ndarray]) -> np.ndarray:
    """Shrink pictures of one size to the width of a cell and set them side by side."""
    height = max(1, round(CELL_WIDTH * pictures[0].shape[0] / pictures[0].shape[1]))
    gap = np.full((height, GAP, 3), 255, dtype=np.uint8)
    parts = [gap]
    for picture in pictures:
        parts += [cv2.resize(picture, (CELL_WIDTH, height), interpolation=cv2.INTER_AREA), gap]
    return np.concatenate(parts, axis=1)


def main() -> int:
    """Write the sheet; exit code 1 with one line when a file cannot be read or written."""
    parser = argparse.ArgumentParser(description="Draw frames of a source above its result.")
    parser.add_argument("source", type=Path, help="the video that was converted")
    parser.add_argument("result", type=Path, help="the animation made from it")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the PNG to write")
    parser.add_argument("--frames", type=int, default=6, help="moments to show (default: 6)")
    options = parser.parse_args()
    if options.frames < 1:
        parser.error(f"--frames is {options.frames}; give 1 or more")
    try:
        sheet = draw_sheet(options.source, options.result, options.frames)
        options.output.parent.mkdir(parents=True, exist_ok=True)
        encoded = cv2.imencode(".png", cv2.cvtColor(sheet, cv2.COLOR_RGB2BGR))[1]
        options.output.write_bytes(encoded.tobytes())
    except (OSError, ValueError, av.FFmpegError) as error:
        print(f"contact_sheet: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
