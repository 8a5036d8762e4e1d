"""What a machine has that conversions need, and whether one works here: `trimotion doctor`."""

import os
import platform
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter

import numpy as np

from pipeline.library.result import Result
from pipeline.library.runs import animate
from pipeline.printable import printable
from pipeline.version import library_versions, program_version
from stages.media import probe
from stages.media.writing.codecs import VIDEO_CODECS, find_encoder
from stages.media.writing.still_writer import encode_still
from warp_kernels.device.cache_place import cache_place, is_first_run
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError, TrimotionError

EXTRAS = {
    "dask": "distributed",
    "editor": "starlette",
    "dxf": "ezdxf",
    "usd": "pxr",
}
"""What can be installed beside the program, and a module by which it is known."""
SIZE = (96, 64)
"""Of the pictures of the test [px]."""
FRAMES = 3
"""And their number."""
WORST = 25.0
"""Error that a film of them may have [code values]: it has half of it, and a grey one 70."""
LEAST_SPACE = 1 << 30
"""Free space below which it is said to be little [bytes]."""


@dataclass(frozen=True)
class Examination:
    """What was found."""

    facts: dict[str, str]
    """By name, in order."""
    troubles: tuple[str, ...]
    """What is wrong or missing, one line each, the test's among them."""
    works: bool
    """Whether a film was made here."""

    def as_dict(self) -> dict[str, object]:
        """For programs."""
        return {**self.facts, "troubles": list(self.troubles), "works": self.works}

    def as_lines(self) -> str:
        """For people, with a yes or no at the end."""
        width = max(map(len, self.facts))
        lines = [f"{name:<{width}}  {printable(value)}" for name, value in self.facts.items()]
        lines += [f"{'note':<{width}}  {printable(trouble)}" for trouble in self.troubles]
        return "\n".join([*lines, f"{'works':<{width}}  {'yes' if self.works else 'no'}"])


def examine() -> Examination:
    """Look at this machine, and make a film of three small pictures on it."""
    device, notes = _device()
    missing = [codec for codec in VIDEO_CODECS if not _has(codec)]
    facts = {
        "program": f"trimotion {program_version()}, Python {platform.python_version()}",
        "system": platform.platform(),
        "libraries": ", ".join(f"{name} {v}" for name, v in library_versions().items()),
        "extras": ", ".join(k for k, module in EXTRAS.items() if find_spec(module)) or "none",
        "device": device,
        "encoders": ", ".join(codec for codec in VIDEO_CODECS if codec not in missing),
        "kernels": _kernels(),
        "free space": ", ".join(f"{free >> 20} MiB in {place}" for place, free in _places()),
    }
    troubles = [*notes, *(f"FFmpeg has no encoder for {codec}" for codec in missing)]
    troubles += [f"little space is free in {p}" for p, free in _places() if free < LEAST_SPACE]
    begun = perf_counter()
    trouble = _trial()
    facts["test"] = f"a film of {FRAMES} pictures in {perf_counter() - begun:.1f} s"
    return Examination(facts, (*troubles, *trouble), works=not trouble)


def _device() -> tuple[str, list[str]]:
    """What kernels run on by default, and what is noted of it."""
    try:
        with Device() as device:
            threads = "" if device.is_cuda else f", {device.part_count} threads"
            return f"{device.name}{threads}", list(device.notes)
    except TrimotionError as error:
        return "none", [str(error)]


def _has(codec: str) -> bool:
    try:
        find_encoder(codec)
    except OptionError:
        return False
    return True


def _kernels() -> str:
    """Where compiled kernels are, and whether more may be put there."""
    place = cache_place()
    known = "none yet: a first run compiles them" if is_first_run() else "some are compiled"
    at = place
    while not at.exists() and at != at.parent:
        at = at.parent
    shut = "" if os.access(at, os.W_OK) else ", which can only be read"
    return f"{known}, in {place}{shut}"


def _places() -> Iterator[tuple[Path, int]]:
    """Folders in which files come to lie, and the free space there [bytes]."""
    for place in dict.fromkeys((Path.cwd(), Path(tempfile.gettempdir()))):
        yield place, shutil.disk_usage(place).free


def _trial() -> tuple[str, ...]:
    """What hinders a conversion; nothing if a film of three pictures is one."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            film = Path(folder) / "film.mp4"
            result = _film(Path(folder), film)
            found = probe(film).frame_count
    except (TrimotionError, OSError) as error:
        return (f"no film can be made: {error}",)
    if found != FRAMES:
        return (f"a film of {FRAMES} pictures has {found}",)
    if not result.mean_rmse < WORST:
        return (f"a film is off by {result.mean_rmse:.1f} code values",)
    return ()


def _film(folder: Path, film: Path) -> Result:
    """Convert a square that moves over a slope."""
    width, height = SIZE
    slope = np.linspace(0, 255, width * height * 3).reshape(height, width, 3).astype(np.uint8)
    for number in range(FRAMES):
        picture = slope.copy()
        picture[20:40, 10 + 4 * number : 40 + 4 * number] = (220, 60, 30)
        (folder / f"in_{number:04d}.png").write_bytes(encode_still(picture, "png", None))
    stills = folder / "in_####.png"
    return animate(stills, film, triangles=60, iterations=20, frame_iterations=10)
