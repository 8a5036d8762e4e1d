"""Draw `shapes.mp4`: coloured shapes whose positions are known exactly in every frame.

    python sample_videos/make_shapes.py [OUTPUT.mp4]

640 x 360, 25 frames per second, 72 frames in two shots with a hard cut before frame `CUT_FRAME`.
In the first shot a red disc passes behind a turning green square while a yellow triangle bobs
across the top; in the second a white disc and a magenta square go opposite ways past a cyan
triangle that turns on the spot. A beep marks the start of every second.

Tests take the truth from `shape_positions` and `CUT_FRAME`, so it is written down only here.
Nothing is random: the same versions of the dependencies write the same file.
"""

import argparse
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from av.video.reformatter import ColorRange, Interpolation, VideoReformatter

WIDTH, HEIGHT = 640, 360
FRAME_RATE = 25
FRAME_COUNT = 72
CUT_FRAME = 42
"""Index of the first frame of the second shot."""
SAMPLE_RATE = 48_000
BEEP_SECONDS = 0.12
BEEP_HERTZ = 880.0
BT709 = 1
"""The code of BT.709 in all three of H.264's colour tags: matrix, primaries and transfer."""
# Without accurate rounding and full chroma the conversion shifts colours by about one level.
ACCURATE = Interpolation.BICUBIC | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT


@dataclass(frozen=True)
class Shape:
    """One moving shape; `t` below counts frames from the start of its shot.

    `corners` = 0 is a disc, otherwise a regular polygon.
    """

    name: str
    color: tuple[int, int, int]
    """RGB code values [0..255]."""
    corners: int
    radius: float
    """Radius of the disc, or circumscribed radius of the polygon [px]."""
    start: tuple[float, float]
    """Centre at t = 0 [px]."""
    velocity: tuple[float, float] = (0.0, 0.0)
    """[px/frame]."""
    swing: tuple[float, float] = (0.0, 0.0)
    """Amplitude of a sine added to the centre, x and y [px]."""
    period: float = 48.0
    """Period of the swing [frames]."""
    spin: float = 0.0
    """Clockwise turn [radians/frame]."""

    def center(self, t: int) -> tuple[float, float]:
        """Give the centre [px] (x right, y down, pixel (i, j) sampled at (i + 1/2, j + 1/2))."""
        sine = np.sin(2.0 * np.pi * t / self.period)
        return (
            float(self.start[0] + self.velocity[0] * t + self.swing[0] * sine),
            float(self.start[1] + self.velocity[1] * t + self.swing[1] * sine),
        )

    def coverage(self, x: np.ndarray, y: np.ndarray, t: int) -> np.ndarray:
        """Give the anti-aliased cover [0..1] of the pixels sampled at `x`, `y` [px, H x W]."""
        center_x, center_y = self.center(t)
        dx, dy = x - center_x, y - center_y
        if self.corners == 0:
            return np.clip(0.5 + self.radius - np.hypot(dx, dy), 0.0, 1.0)
        sides = 2.0 * np.pi * (np.arange(self.corners) + 0.5) / self.corners
        sides += self.spin * t - np.pi / 2.0
        inner = self.radius * np.cos(np.pi / self.corners)
        distances = [dx * np.cos(side) + dy * np.sin(side) - inner for side in sides]
        return np.clip(0.5 - np.max(distances, axis=0), 0.0, 1.0)


@dataclass(frozen=True)
class Shot:
    """A background and the shapes in front of it, the farthest first."""

    corner_colors: tuple[tuple[int, int, int], ...]
    """RGB code values of the top left, top right, bottom left and bottom right corner."""
    shapes: tuple[Shape, ...]


@dataclass(frozen=True)
class ShapePosition:
    """Where a shape is in one frame."""

    color: tuple[int, int, int]
    """RGB code values [0..255]."""
    center: tuple[float, float]
    """Centre of area [px], exact."""
    occluded: bool
    """True where a nearer shape may cover part of it: the visible part then lies elsewhere."""


SHOTS = (
    Shot(
        corner_colors=((42, 58, 96), (70, 92, 136), (88, 84, 120), (128, 120, 150)),
        shapes=(
            Shape("red disc", (214, 48, 44), 0, 46.0, (96.0, 196.0), velocity=(10.5, 0.5)),
            Shape("green square", (40, 158, 84), 4, 78.0, (344.0, 214.0), spin=np.pi / 120),
            Shape("yellow triangle", (242, 200, 48), 3, 44.0, (150.0, 70.0), (8.0, 0.0), (0, 14.0)),
        ),
    ),
    Shot(
        corner_colors=((196, 156, 110), (224, 186, 140), (150, 104, 84), (178, 128, 100)),
        shapes=(
            Shape("white disc", (248, 246, 240), 0, 38.0, (110.0, 90.0), velocity=(14.25, 0.0)),
            Shape("magenta square", (176, 40, 140), 4, 60.0, (540.0, 270.0), (-12.0, 0.0)),
            Shape("cyan triangle", (32, 150, 190), 3, 46.0, (320.0, 178.0), spin=np.pi / 60),
        ),
    ),
)


def shape_positions(frame: int) -> dict[str, ShapePosition]:
    """Tell where every shape of a frame is.

    Args:
        frame: Frame of the clip, 0 to `FRAME_COUNT` - 1.

    Returns:
        One entry for each visible shape, by name, the farthest first.

    Raises:
        ValueError: If the clip has no such frame.
    """
    shot, t = _shot_at(frame)
    positions = {}
    for rank, shape in enumerate(shot.shapes):
        nearer = shot.shapes[rank + 1 :]
        occluded = any(_may_touch(shape, other, t) for other in nearer)
        positions[shape.name] = ShapePosition(shape.color, shape.center(t), occluded)
    return positions


def draw_frame(frame: int) -> np.ndarray:
    """Draw one frame: full-range RGB, shape [HEIGHT, WIDTH, 3] uint8."""
    shot, t = _shot_at(frame)
    x = np.arange(WIDTH)[None, :] + 0.5
    y = np.arange(HEIGHT)[:, None] + 0.5
    picture = _gradient(shot.corner_colors, x / WIDTH, y / HEIGHT)
    for shape in shot.shapes:
        cover = shape.coverage(x, y, t)[:, :, None]
        picture += cover * (np.array(shape.color, dtype=np.float64) - picture)
    return np.rint(picture).astype(np.uint8)


def beep_track() -> np.ndarray:
    """Make the sound: mono in -1..1, as long as the picture, shape [1, samples] float32."""
    sample_count = SAMPLE_RATE * FRAME_COUNT // FRAME_RATE
    since_second = np.arange(sample_count) % SAMPLE_RATE / SAMPLE_RATE
    # A beep fades in and out over 5 ms; a sudden edge would click.
    fade = np.clip(np.minimum(since_second, BEEP_SECONDS - since_second) / 0.005, 0.0, 1.0)
    sound = 0.3 * fade * np.sin(2.0 * np.pi * BEEP_HERTZ * since_second)
    return sound[None, :].astype(np.float32)


def write_clip(path: Path) -> None:
    """Encode the clip: H.264 and AAC in MP4, BT.709 in pixels and in tags."""
    with av.open(str(path), "w", options={"movflags": "+faststart"}) as container:
        video = _add_video(container)
        audio = container.add_stream("aac", rate=SAMPLE_RATE, layout="mono")
        audio.bit_rate = 64_000
        reformatter = VideoReformatter()
        for index in range(FRAME_COUNT):
            container.mux(video.encode(_to_yuv(reformatter, draw_frame(index), index)))
        container.mux(video.encode(None))
        sound = av.AudioFrame.from_ndarray(beep_track(), format="fltp", layout="mono")
        sound.sample_rate, sound.pts = SAMPLE_RATE, 0
        container.mux(audio.encode(sound))
        container.mux(audio.encode(None))


def _shot_at(frame: int) -> tuple[Shot, int]:
    """Give the shot of a frame and the frame's number within the shot."""
    if not 0 <= frame < FRAME_COUNT:
        raise ValueError(f"frame {frame} is not in the clip; use 0 to {FRAME_COUNT - 1}")
    return (SHOTS[0], frame) if frame < CUT_FRAME else (SHOTS[1], frame - CUT_FRAME)


def _may_touch(first: Shape, second: Shape, t: int) -> bool:
    """Say whether the circles around two shapes come within two pixels of each other."""
    distance = np.hypot(*np.subtract(first.center(t), second.center(t)))
    return bool(distance < first.radius + second.radius + 2.0)


def _gradient(colors: tuple[tuple[int, int, int], ...], u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Blend four corner colours over the picture: u [1 x W], v [H x 1] -> [H, W, 3] float64."""
    top_left, top_right, bottom_left, bottom_right = np.array(colors, dtype=np.float64)
    u, v = u[:, :, None], v[:, :, None]
    top = top_left + u * (top_right - top_left)
    bottom = bottom_left + u * (bottom_right - bottom_left)
    return top + v * (bottom - top)


def _add_video(container: av.container.OutputContainer) -> av.VideoStream:
    """Add the H.264 stream with all four colour tags; untagged, each player guesses its own."""
    # One thread: x264's bytes depend on how many threads share the work.
    options = {"crf": "14", "preset": "veryslow", "threads": "1"}
    video = container.add_stream("libx264", rate=FRAME_RATE, options=options)
    video.width, video.height, video.pix_fmt = WIDTH, HEIGHT, "yuv420p"
    context = video.codec_context
    context.color_range = ColorRange.MPEG
    context.colorspace = context.color_primaries = context.color_trc = BT709
    return video


def _to_yuv(reformatter: VideoReformatter, picture: np.ndarray, index: int) -> av.VideoFrame:
    """Convert full-range RGB [H, W, 3] to limited-range BT.709 and give it its time."""
    frame = reformatter.reformat(
        av.VideoFrame.from_ndarray(picture, format="rgb24"),
        format="yuv420p",
        dst_colorspace="ITU709",
        src_color_range=ColorRange.JPEG,
        dst_color_range=ColorRange.MPEG,
        interpolation=ACCURATE,
    )
    frame.pts, frame.time_base = index, Fraction(1, FRAME_RATE)
    return frame


def main() -> None:
    """Write the clip to the path given on the command line, or beside this file."""
    parser = argparse.ArgumentParser(description="Draw the sample clip shapes.mp4.")
    default = Path(__file__).with_name("shapes.mp4")
    parser.add_argument("output", nargs="?", type=Path, default=default)
    write_clip(parser.parse_args().output)


if __name__ == "__main__":
    main()
