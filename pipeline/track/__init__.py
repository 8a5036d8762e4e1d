"""The mesh track: what was solved, frame by frame, in one SQLite file.

It is the seam between solving and shading: solve once, draw in ten styles, continue a killed job.
"""

from pipeline.track.header import Header
from pipeline.track.identity import SourceIdentity, identity_of
from pipeline.track.join import join
from pipeline.track.not_a_source import refuse_track
from pipeline.track.reader import FrameRow, TrackReader, is_track
from pipeline.track.writer import TrackWriter

__all__ = [
    "FrameRow",
    "Header",
    "SourceIdentity",
    "TrackReader",
    "TrackWriter",
    "identity_of",
    "is_track",
    "join",
    "refuse_track",
]
