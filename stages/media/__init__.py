"""Reading and writing media files; the only package that knows FFmpeg."""

from stages.media.frame_range import FrameRange, parse_time
from stages.media.naming import NumberedPattern, input_pattern
from stages.media.reading.count import count_frames
from stages.media.reading.decode import Decoder, open_decoder
from stages.media.reading.info import MediaInfo
from stages.media.reading.probe import probe
from stages.media.reading.read_options import ReadOptions
from stages.media.writing.encode import Encoder, open_encoder
from stages.media.writing.encoder_setup import EncodeOptions
from stages.media.writing.output_plan import OutputPlan, check_output

__all__ = [
    "Decoder",
    "EncodeOptions",
    "Encoder",
    "FrameRange",
    "MediaInfo",
    "NumberedPattern",
    "OutputPlan",
    "ReadOptions",
    "check_output",
    "count_frames",
    "input_pattern",
    "open_decoder",
    "open_encoder",
    "parse_time",
    "probe",
]
