"""`trimotion timeline`: what a timeline does when, as a table and a picture, without solving."""

import argparse
import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.options.build import build_job
from pipeline.timeline.clock import Clock
from pipeline.timeline.show import Placed, Show
from pipeline.timeline.staging import show_of, with_timeline
from pipeline.timeline.timeline import TEMPLATES, shipped_timelines
from pipeline.track import refuse_track
from stages.look.sheet_strip import Band, Graph, strip_of
from stages.masks.regions import Mask
from stages.media import (
    EncodeOptions,
    FrameRange,
    MediaInfo,
    check_output,
    count_frames,
    open_decoder,
    open_encoder,
    probe,
)
from stages.media.reading.read_options import ReadOptions
from warp_kernels.errors import MediaError, OptionError
from warp_kernels.styles.color import parse_color

WIDTH, PICTURES, PLACES = 1600, 12, 400
"""Columns of the strip [px], thumbnails, and places at which curves are looked at."""
ONE = FrameRange(0, 0)
"""A strip is one picture."""


@dataclass(frozen=True, eq=False)
class OverTime:
    """A target of curves over the whole film."""

    name: str
    """What changes."""
    values: list[Any]
    """What it is at even places; None where nothing shows it."""

    @property
    def numbers(self) -> np.ndarray | None:
        """Numbers, NaN where there is none, or None if it is no number."""
        if any(isinstance(value, str) for value in self.values):
            return None
        return np.array([np.nan if value is None else float(value) for value in self.values])

    @property
    def bounds(self) -> str:
        """The least and the largest value, or the texts that it has."""
        numbers = self.numbers
        if numbers is not None and np.isfinite(numbers).any():
            return f"{np.nanmin(numbers):.4g} to {np.nanmax(numbers):.4g}"
        known = list(dict.fromkeys(str(value) for value in self.values if value is not None))
        return ", ".join(known if len(known) <= 3 else [known[0], "...", known[-1]])


def check_timeline(arguments: argparse.Namespace) -> str:
    """Look at a timeline beside its film, or at the text of a shipped one.

    Args:
        arguments: What the user gave.

    Returns:
        What is told of it.

    Raises:
        TrimotionError: As `animate` does, or if there is no film where one is needed.
    """
    if arguments.source is None:
        return _text_of(arguments)
    given = {k: v for k, v in vars(arguments).items() if k not in ("show", "output", "overwrite")}
    job = with_timeline(build_job({**given, "timeline": arguments.show}))
    source = job.solve.source
    refuse_track(source)
    info = probe(source, read=job.solve.read)
    if info.frame_count is None:
        info = replace(info, frame_count=count_frames(source, job.solve.read))
    show = show_of(job.look, job.solve.model, info)
    assert show is not None
    last = info.last_frame or info.first_frame
    show.check(info.first_frame, last)
    _check_masks(show, (info.width, info.height))
    notes = (*show.notes, *show.held(info.first_frame, last))
    curves = list(_curves(show, info.first_frame, last))
    if arguments.output is not None:
        _draw(show, curves, info, job.solve.read, Path(arguments.output), arguments.overwrite)
    if arguments.json:
        return _as_json(show, curves, notes)
    return _as_table(show, curves, source, notes)


def _check_masks(show: Show, size: tuple[int, int]) -> None:
    """Refuse masks of sections that cannot be read, or have another size than the film."""
    for section in show.timeline.sections:
        for region in section.look.regions if "region" in section.entries else ():
            try:
                Mask(region.mask, size).close()
            except MediaError as error:
                raise section.place_of("region").error(f"region: {error}") from error


def _text_of(arguments: argparse.Namespace) -> str:
    """The text of a shipped timeline, from which others begin."""
    name = arguments.show
    if name not in shipped_timelines() or arguments.output is not None or arguments.json:
        raise OptionError(
            f"timeline {name}: needs the film, too: --check CLIP; without it the text of a shipped "
            f"one is printed ({', '.join(shipped_timelines())})"
        )
    return (TEMPLATES / f"{name}.toml").read_text("utf-8").rstrip("\n")


def _end_of(show: Show, number: int) -> float:
    """When a section ends [s]."""
    if number + 1 < len(show.sections):
        return show.clock.time_of_frame(show.sections[number + 1].first)
    return show.clock.end or show.clock.time_of_frame(show.sections[number].first) + 1.0


def _curves(show: Show, first: int, last: int) -> Iterator[OverTime]:
    """Everything that changes, at even places of the film."""
    frames = np.linspace(first, last, PLACES).round().astype(int)
    sections = [show.number_at(int(frame)) for frame in frames]
    lines = [{str(line.target): line for line in one.lines} for one in show.sections]
    names = dict.fromkeys(name for one in lines for name in one)
    names |= dict.fromkeys(key for one in show.sections for key in one.section.mesh)
    for name in names:
        values: list[Any] = []
        for frame, number in zip(frames.tolist(), sections, strict=True):
            line = lines[number].get(name)
            if line is None:
                values.append(show.sections[number].section.mesh.get(name))
            else:
                values.append(line.at(frame, show.clock.time_of_frame(frame), frame))
        yield OverTime(name, values)


def _as_table(show: Show, curves: list[OverTime], source: Path, notes: tuple[str, ...]) -> str:
    """For people."""
    clock = show.clock
    length = "unknown" if clock.end is None else clock.name_of(clock.end).split(" bar")[0]
    lines = [f"{show.timeline.file} over {source}: {length}, {float(clock.rate):g} frames a second"]
    if clock.heard is not None and clock.heard.bpm is not None:
        lines[0] += f", {clock.heard.bpm:.4g} beats a minute"
    lines += ["", "from      bar      frame   section"]
    for number, placed in enumerate(show.sections):
        begin = clock.time_of_frame(placed.first) if number else 0.0
        time, _, bar = clock.name_of(begin).partition(" bar ")
        told = f"{placed.section.name}: {_stack(placed)}"
        if placed.ends > placed.first:
            kind = placed.section.transition
            told += f" ({' '.join(filter(None, (kind.kind, kind.direction, str(kind.span))))})"
        lines.append(f"{time:<10}{bar or '-':<9}{placed.first if number else 0:<8}{told}")
    if curves:
        wide = max(len(curve.name) for curve in curves) + 2
        lines += ["", f"{'curve':<{wide}}values"]
        lines += [f"{curve.name:<{wide}}{curve.bounds}" for curve in curves]
    if notes:
        lines += ["", *(f"note: {note}" for note in notes)]
    return "\n".join(lines)


def _stack(placed: Placed) -> str:
    """The styles of a section, bottom to top."""
    return " + ".join(type(style).__name__.lower() for style in placed.look.styles)


def _as_json(show: Show, curves: list[OverTime], notes: tuple[str, ...]) -> str:
    """For programs."""
    sections = [
        {
            "name": placed.section.name,
            "frame": placed.first if number else 0,
            "from": show.clock.time_of_frame(placed.first) if number else 0.0,
            "to": _end_of(show, number),
            "transition": placed.section.transition.kind,
            "styles": _stack(placed).split(" + "),
        }
        for number, placed in enumerate(show.sections)
    ]
    beats = [] if show.clock.heard is None else show.clock.heard.beats.tolist()
    ranges = {curve.name: curve.bounds for curve in curves}
    found = {"sections": sections, "curves": ranges, "beats": beats, "notes": notes}
    return json.dumps(found, indent=2)


def _draw(
    show: Show,
    curves: list[OverTime],
    info: MediaInfo,
    read: ReadOptions,
    path: Path,
    overwrite: bool,
) -> None:
    """Write the strip."""
    encode = EncodeOptions(overwrite=overwrite, audio=False)
    plan = check_output(path, info, (WIDTH, WIDTH), encode, ONE)
    if plan.container is not None or plan.pattern is not None:
        raise OptionError(f"-o {path}: a strip is one picture; name it .png or .jpg")
    end = show.clock.end or 1.0
    bands = [
        Band(
            show.clock.time_of_frame(placed.first) / end if number else 0.0,
            show.clock.time_of_frame(placed.ends) / end if number else 0.0,
            _end_of(show, number) / end,
            placed.section.name,
        )
        for number, placed in enumerate(show.sections)
    ]
    graphs = [_graph(curve) for curve in curves]
    marks = [(band.begin, show.clock.name_of(band.begin * end)) for band in bands]
    strip = strip_of(bands, graphs, _ticks(show.clock), marks, _pictures(info, read), WIDTH)
    size = (strip.shape[1], strip.shape[0])
    with open_encoder(path, info, size, encode, ONE) as out:
        out.write(strip, 0, Fraction(1), 0)


def _graph(curve: OverTime) -> Graph:
    """A curve as it is drawn."""
    numbers = curve.numbers
    if numbers is not None:
        return Graph(curve.name, numbers, note=curve.bounds)
    colors = [_color(value) for value in curve.values]
    return Graph(curve.name, None, np.array(colors, np.uint8), curve.bounds)


def _color(value: Any) -> tuple[float, float, float]:
    try:
        return parse_color(str(value))
    except OptionError:
        return (235.0, 235.0, 235.0)


def _ticks(clock: Clock) -> list[tuple[float, bool]]:
    """Beats of the film."""
    if clock.heard is None or not clock.heard.has_beats or clock.end is None:
        return []
    beats = [beat for beat in clock.heard.beats.tolist() if 0 <= beat <= clock.end]
    bars = clock.heard.downbeats
    near = [bool(len(bars)) and float(np.abs(bars - beat).min()) < 1e-3 for beat in beats]
    return [(beat / clock.end, is_bar) for beat, is_bar in zip(beats, near, strict=True)]


def _pictures(info: MediaInfo, read: ReadOptions) -> list[np.ndarray]:
    """Frames of the source at even places."""
    first, last = info.first_frame, info.last_frame or info.first_frame
    count = min(PICTURES, last - first + 1)
    found: list[np.ndarray] = []
    for number in range(count):
        index = first + (2 * number + 1) * (last - first + 1) // (2 * count)
        try:
            with open_decoder(info.path, FrameRange(index, index), read=read) as decoder:
                frame = next(iter(decoder), None)
        except OptionError:  # what the file declares is an estimate
            frame = None
        if frame is not None:
            found.append(frame.pixels)
    return found or [np.full((9, 16, 3), 255, np.uint8)]
