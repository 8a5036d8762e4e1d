"""A few small pictures of a film that is finished: they are read from it, not kept on the way."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np

from pipeline.look.wardrobe import Posed, Wardrobe
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.track import TrackReader
from stages.exchange import is_exchange
from stages.look.sheet import of_width
from stages.media import FrameRange, open_decoder
from stages.media.naming import NumberedPattern
from stages.media.writing.still_writer import encode_still
from warp_kernels.device.device import Device
from warp_kernels.errors import TrimotionError

COUNT = 8
"""Pictures of a strip."""
WIDTH = 200
"""Columns of each [px]."""
WIDTH_ALONE = 640
"""Columns where there is but one [px]."""
QUALITY = 12
"""Of their JPEG, from 0 (best) to 51."""


@dataclass(frozen=True)
class Thumbnail:
    """A small picture of a frame."""

    frame: int
    """Its number in the source."""
    size: tuple[int, int]
    """Width and height [px]."""
    jpeg: bytes
    """The picture."""


def strip_of(job: Job, track: Path | None, frames: Sequence[int]) -> tuple[Thumbnail, ...]:
    """Some pictures of a film, evenly spread.

    Args:
        job: What was done; its output is looked at if it is one of pictures.
        track: The track that it was drawn from or solved to, which is drawn else; None for none.
        frames: Numbers of its frames in the source, in order.

    Returns:
        None of them where there is nothing to look at.
    """
    places = np.unique(np.linspace(0, len(frames) - 1, COUNT).round().astype(int)).tolist()
    path, width = job.output.path, WIDTH if len(places) > 1 else WIDTH_ALONE
    try:
        if path is not None and not is_exchange(path):
            return tuple(_read(path, frames, places, width))
        if track is not None:
            return tuple(_drawn(job, track, [frames[place] for place in places], width))
    except TrimotionError:
        pass  # the film is whole; a report without pictures says enough
    return ()


def _read(
    path: Path, frames: Sequence[int], places: Sequence[int], width: int
) -> Iterator[Thumbnail]:
    """Pictures of a film, or of numbered stills."""
    pattern = NumberedPattern.parse(path)
    for place in places:
        number = frames[place]
        name = path if pattern is None else pattern.path_for(number)
        wanted = FrameRange(place, place) if pattern is None else FrameRange()
        with open_decoder(name, wanted) as decoder:
            for frame in decoder:
                yield _thumbnail(number, frame.pixels, width)
                break


def _drawn(job: Job, path: Path, numbers: Sequence[int], width: int) -> Iterator[Thumbnail]:
    """Pictures of a track, in its triangles' own colours."""
    with TrackReader(path) as track, Device(job.run.device, job.run.threads) as device:
        info, model = track.header.info, track.header.model
        size = (info.width, info.height)
        look = Look(scale=min(1.0, 2 * width / info.width))
        framing = look.framing_for(size, Fraction(1))
        wardrobe = Wardrobe(device, size, framing.picture, look, model)
        for number in numbers:
            view = Posed(track.snapshot(number), None, None, {}, None, None, {})
            yield _thumbnail(number, wardrobe.draw(look, view), width)


def _thumbnail(number: int, pixels: np.ndarray, width: int) -> Thumbnail:
    (small,) = of_width([pixels], min(width, pixels.shape[1]))
    jpeg = encode_still(np.ascontiguousarray(small), "mjpeg", QUALITY)
    return Thumbnail(number, (small.shape[1], small.shape[0]), jpeg)
