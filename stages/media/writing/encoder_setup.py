"""Settings of a video encoder."""

import os
from fractions import Fraction

import av
from av.video.codeccontext import VideoCodecContext

from stages.media.color.yuv import tag_bt709
from stages.media.reading.container import DAMAGE, reason_of
from stages.media.writing.codecs import VideoCodec
from stages.media.writing.encode_options import EncodeOptions
from warp_kernels.errors import OptionError

SVT_LOG = "SVT_LOG"
"""Environment variable that says how much the AV1 encoder prints."""


def settings_of(encoder: VideoCodec, options: EncodeOptions) -> dict[str, str]:
    """Options for FFmpeg.

    Args:
        encoder: The encoder.
        options: What the user chose.
    """
    settings = dict(encoder.options)
    if options.encoder_preset is None:
        settings.update(encoder.tuning)
    else:
        settings["preset"] = options.encoder_preset
    quality = encoder.quality if options.crf is None else options.crf
    if quality is not None:
        settings[encoder.quality_name] = str(quality)
    return settings


def set_up(
    codec: VideoCodecContext,
    pixel_format: str,
    size: tuple[int, int],
    clock: Fraction,
    threads: int,
) -> None:
    """Fill in what every encoder needs before it is opened.

    Args:
        codec: The encoder.
        pixel_format: Format of the frames.
        size: Width and height of the frames [px].
        clock: Seconds per unit of pts.
        threads: Encoder threads, 0 for one per core.
    """
    codec.width, codec.height = size
    codec.pix_fmt = pixel_format
    codec.time_base = clock
    codec.thread_count = threads
    if pixel_format.startswith("yuv"):
        tag_bt709(codec)


def open_quietly(codec: VideoCodecContext) -> None:
    """Open an encoder that was set up; one of them prints a banner but for a variable.

    Args:
        codec: The encoder.
    """
    before = os.environ.get(SVT_LOG)
    if codec.name == "libsvtav1" and before is None:
        os.environ[SVT_LOG] = "1"
    try:
        codec.open()
    finally:
        if before is None:
            os.environ.pop(SVT_LOG, None)


def try_encoder(
    encoder: VideoCodec, pixel_format: str, size: tuple[int, int], options: EncodeOptions
) -> None:
    """Open an encoder once, so that what it refuses is known before any work is done.

    Args:
        encoder: The encoder.
        pixel_format: Format of the frames.
        size: Width and height of the frames [px].
        options: What the user chose.

    Raises:
        OptionError: If it does not open.
    """
    codec = av.CodecContext.create(encoder.name, "w")
    assert isinstance(codec, VideoCodecContext)
    codec.options = settings_of(encoder, options)
    codec.framerate = Fraction(25)
    set_up(codec, pixel_format, size, Fraction(1, 25), options.threads)
    try:
        open_quietly(codec)
    except DAMAGE as error:
        if encoder.twin is not None:
            raise OptionError(
                f"codec {encoder.name}: no NVIDIA card here encodes {size[0]}x{size[1]} in "
                f"{pixel_format} ({reason_of(error)}); choose {encoder.twin}"
            ) from error
        raise OptionError(
            f"{encoder.name} refuses {size[0]}x{size[1]} in {pixel_format} ({reason_of(error)}); "
            "choose another size, codec or pixel format"
        ) from error
