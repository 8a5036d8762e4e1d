"""Small media of every container, damaged and read."""

import random
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import av

from benchmarks.fuzz.mutate import mutant
from stages.media import FrameRange, open_decoder, probe
from stages.media.sound.samples import SampleForm, samples_of
from tests.media_samples import picture, write_sound, write_still, write_video
from warp_kernels.errors import MediaError

FILMS = {
    "mp4": {"sound": 1},
    "mov": {"sound": 1, "codec": "prores_ks", "pixel_format": "yuv422p10le"},
    "mkv": {"sound": 1},
    "ts": {"codec": "mpeg2video"},
    "avi": {"codec": "mpeg4"},
    "webm": {"codec": "libvpx-vp9", "sound": 1, "audio_codec": "libopus"},
    "flv": {"codec": "flv"},
    "nut": {"codec": "ffv1", "pixel_format": "bgr0"},
    "gif": {"codec": "gif", "pixel_format": "rgb8"},
    "mxf": {"codec": "mpeg2video"},
    "ogv": {"codec": "libvpx"},
    "h264": {},
    "mpg": {"codec": "mpeg1video"},
    "asf": {"codec": "msmpeg4"},
    "y4m": {"codec": "rawvideo"},
    "mjpeg": {"codec": "mjpeg", "pixel_format": "yuvj420p"},
    "apng": {"codec": "apng", "pixel_format": "rgb24"},
    "ivf": {"codec": "libvpx"},
}
"""Films by ending, and how they are written."""
STILLS = ("png", "jpg", "tif", "webp", "bmp", "ppm", "tga", "jp2")
"""Stills by ending."""
FRAMES = 6
"""Frames of a film."""
SOUNDS = (".m4a", ".wav")
"""Endings of what is listened to."""
RATE = 8000
"""Samples a second that are listened to."""
MOST_READ = 400
"""Frames, and pieces of sound, of a mutant that are read: what is cut in pieces may have more."""


@dataclass(frozen=True)
class Sample:
    """A good file."""

    ending: str
    """Its ending."""
    content: bytes
    """What it holds."""


def samples_in(folder: Path) -> list[Sample]:
    """Write good files of every kind that this FFmpeg writes.

    Args:
        folder: Where they may be written.
    """
    paths = []
    for ending, how in FILMS.items():
        path = folder / f"good.{ending}"
        try:
            write_video(path, [picture(48, 32, number) for number in range(FRAMES)], **how)  # type: ignore[arg-type]
        except (av.FFmpegError, ValueError):
            continue  # built without it
        paths.append(path)
    for ending in STILLS:
        path = folder / f"good.{ending}"
        try:
            write_still(path, picture(48, 32))
        except (av.FFmpegError, ValueError, KeyError):
            continue
        paths.append(path)
    paths.append(write_sound(folder / "good.m4a"))
    return [Sample(path.suffix, path.read_bytes()) for path in paths]


def mutants(folder: Path, seed: int) -> Iterator[Path]:
    """Damaged files, without end; each replaces the one before it.

    Args:
        folder: Where they are written.
        seed: Chooses the damage.
    """
    good = samples_in(folder)
    chance = random.Random(seed)
    others = [one.content for one in good]
    number = 0
    while True:
        sample = good[number % len(good)]
        path = folder / f"broken{number}{sample.ending}"
        path.write_bytes(mutant(sample.content, others, chance))
        yield path
        path.unlink(missing_ok=True)
        number += 1


def read(path: Path) -> int:
    """Read all of a file as `animate` and `listen` do; gives the number of frames.

    Args:
        path: The file.

    Raises:
        TrimotionError: If it cannot be read.
    """
    if path.suffix in SOUNDS:
        return sum(1 for _ in islice(samples_of(path, SampleForm(RATE)), MOST_READ))
    if probe(path).audio_codec is not None:
        with suppress(MediaError):
            for _ in islice(samples_of(path, SampleForm(RATE)), MOST_READ):
                pass
    last = None
    with open_decoder(path, FrameRange()) as decoder:
        count = 0
        for frame in islice(decoder, MOST_READ):
            assert last is None or frame.pts > last, "times do not increase"
            assert frame.pixels.shape[2] == 3
            last = frame.pts
            count += 1
    return count
