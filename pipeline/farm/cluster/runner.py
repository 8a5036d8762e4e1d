"""A runner of ranges whose places are the workers of a cluster."""

import secrets
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pipeline.farm.cluster.address import connected
from pipeline.farm.cluster.crew import Crew
from pipeline.farm.cluster.worker import Errand
from pipeline.loop.ranges import InThisProcess, Part, Together, Work
from pipeline.loop.result import Animated
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import identity_of
from stages.focus.picture import Picture


class OnCluster:
    """Solves ranges on the workers of a Dask cluster, the longest first.

    Args:
        address: Where it is.
        streams: Whether the source is sent to all workers, even to those that see it.
    """

    places = 2
    """More than one: how many there are is known only once somebody answers, and may change."""

    def __init__(self, address: str, *, streams: bool = False) -> None:
        self._address, self._streams = address, streams

    def run(self, work: Work, parts: Sequence[Part], progress: Progress) -> Sequence[Animated]:
        """Solve ranges beside each other.

        Args:
            work: How.
            parts: The ranges and their tracks.
            progress: Told of every finished frame.

        Raises:
            TrimotionError: If nothing answers, versions differ or a range cannot be solved.
        """
        if len(parts) == 1:  # which nobody can share
            return InThisProcess().run(work, parts, progress)
        named = work.options.source
        source = identity_of(named)
        parts = [_absolute_part(part) for part in parts]
        folder = parts[0].output.track
        assert folder is not None
        token = secrets.token_hex(8)
        mark = folder.with_name(f"{token}.mark")
        mark.write_text("" if self._streams else token)
        try:
            errand = Errand(token, source, mark, named)
            sent = replace(work, options=_absolute(work.options))
            with connected(self._address) as client:
                crew = Crew(client, errand, sent, parts)
                with crew.at_work():
                    found = crew.results(Together(progress, parts))
        finally:
            mark.unlink(missing_ok=True)
        return [found[number] for number in range(len(parts))]


def _absolute(options: SolveOptions) -> SolveOptions:
    """Options whose files are found from everywhere."""
    cuts = options.cuts
    focus = tuple(
        replace(member, file=str(Path(member.file).absolute()))
        if isinstance(member, Picture) and member.file
        else member
        for member in options.focus
    )
    return replace(
        options,
        source=options.source.absolute(),
        weights=None if options.weights is None else str(Path(options.weights).absolute()),
        cuts=cuts if cuts in ("auto", "none") else str(Path(cuts).absolute()),
        focus=focus,
    )


def _absolute_part(part: Part) -> Part:
    """A part whose track is found from everywhere."""
    assert part.output.track is not None
    return Part(part.frames, replace(part.output, track=part.output.track.absolute()))
