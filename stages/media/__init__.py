"""Reading and writing media files; the only package that knows FFmpeg."""

from stages.media.count import count_frames
from stages.media.decode import Decoder, open_decoder
from stages.media.encode import Encoder, open_encoder
from stages.media.encoder_setup import EncodeOptions
from stages.media.frame_range import FrameRange, parse_time
from stages.media.info import MediaInfo
from stages.media.naming import NumberedPattern, input_pattern
from stages.media.output_plan import OutputPlan, check_output
from stages.media.probe import probe
from stages.media.read_options import ReadOptions

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
