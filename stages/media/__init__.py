"""Reading and writing media files; the only package that knows FFmpeg.

What it names is imported when it is first asked for: options need no FFmpeg.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stages.media.frame_range import FrameRange as FrameRange
    from stages.media.frame_range import parse_time as parse_time
    from stages.media.naming import NumberedPattern as NumberedPattern
    from stages.media.naming import input_pattern as input_pattern
    from stages.media.reading.count import count_frames as count_frames
    from stages.media.reading.decode import Decoder as Decoder
    from stages.media.reading.decode import open_decoder as open_decoder
    from stages.media.reading.info import MediaInfo as MediaInfo
    from stages.media.reading.probe import probe as probe
    from stages.media.reading.read_options import ReadOptions as ReadOptions
    from stages.media.writing.encode import Encoder as Encoder
    from stages.media.writing.encode import open_encoder as open_encoder
    from stages.media.writing.encode_options import EncodeOptions as EncodeOptions
    from stages.media.writing.output_plan import OutputPlan as OutputPlan
    from stages.media.writing.output_plan import check_output as check_output
    from stages.media.writing.output_plan import keeps_alpha as keeps_alpha

_HOMES = {
    "FrameRange": "stages.media.frame_range",
    "parse_time": "stages.media.frame_range",
    "NumberedPattern": "stages.media.naming",
    "input_pattern": "stages.media.naming",
    "count_frames": "stages.media.reading.count",
    "Decoder": "stages.media.reading.decode",
    "open_decoder": "stages.media.reading.decode",
    "MediaInfo": "stages.media.reading.info",
    "probe": "stages.media.reading.probe",
    "ReadOptions": "stages.media.reading.read_options",
    "Encoder": "stages.media.writing.encode",
    "open_encoder": "stages.media.writing.encode",
    "EncodeOptions": "stages.media.writing.encode_options",
    "OutputPlan": "stages.media.writing.output_plan",
    "check_output": "stages.media.writing.output_plan",
    "keeps_alpha": "stages.media.writing.output_plan",
}
"""Where the names live."""

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value
