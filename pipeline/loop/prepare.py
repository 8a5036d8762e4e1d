"""What frames go through before they are solved: cuts, weights, motion."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace

from pipeline.envelope import MeshFrom, Prepared
from pipeline.loop.attention import Attention
from pipeline.loop.motion import with_motion
from pipeline.loop.shots import with_shots
from pipeline.options.solve_options import SolveOptions
from pipeline.track.resume import Reached
from stages.frame import Frame
from stages.masks.weight_maps import WeightMap
from stages.media import MediaInfo


def prepared(
    frames: Iterable[Frame],
    info: MediaInfo,
    attention: Attention,
    maps: Sequence[WeightMap],
    options: SolveOptions,
    reached: Reached | None,
    notes: list[str],
) -> Iterator[Prepared]:
    """Find cuts, weigh and estimate motion: all that frames go through before they are solved.

    Args:
        frames: The frames of the range and around it.
        info: Their source.
        attention: Weighs them by what `--focus` names.
        maps: Weigh them by pictures; closed after the last frame.
        options: Say what is wanted.
        reached: Where an earlier run ended, or None.
        notes: Receives what the user of a track should know, one sentence each.
    """
    weighed = attention.beside(with_shots(frames, options.cuts))
    found = with_motion(weighed, info, options, reached, notes)
    return _beneath(maps, found) if maps else found


def _beneath(maps: Sequence[WeightMap], found: Iterable[Prepared]) -> Iterator[Prepared]:
    """Weigh frames by pictures; one that is solved already needs no weights."""
    with ExitStack() as stack:
        for weights in maps:
            stack.callback(weights.close)
        for prepared in found:
            frame = prepared.frame
            if prepared.mesh_from is not MeshFrom.TRACK:
                for weights in maps:
                    frame = weights.weighed(frame)
            yield replace(prepared, frame=frame)
