"""Which containers and codecs can be written, and how each encoder is set up."""

from dataclasses import dataclass, field

import av

from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class Container:
    """A file format that can be written."""

    format: str
    """FFmpeg's name of its muxer."""
    codec: str
    """Codec that is used unless another is asked for, a key of `ENCODERS`."""
    audio: str | None
    """Encoder for audio that the format cannot hold as it is; None if it holds no audio."""
    options: dict[str, str] = field(default_factory=dict)
    """Options of the muxer."""

    @property
    def audio_name(self) -> str:
        """Name of the codec that audio is converted to."""
        return (self.audio or "none").removeprefix("lib")


@dataclass(frozen=True)
class VideoCodec:
    """A video encoder and its settings."""

    name: str
    """FFmpeg's name."""
    pixel_formats: tuple[str, ...]
    """Formats that may be chosen; the first is the default."""
    quality: int | None
    """Default of its constant-quality option, smaller is better; None if it has none."""
    best_quality: int
    """Least value of that option."""
    worst_quality: int
    """Largest value of that option."""
    options: dict[str, str]
    """Other options: a balance of speed and size."""
    tuning: dict[str, str] = field(default_factory=dict)
    """Options that go with the preset among these; one that is asked for is left as it is."""
    presets: tuple[str, ...] = ()
    """Values of its option `preset`, from fast to slow."""
    alpha_format: str | None = None
    """Format for pictures with transparency; None if the codec has none."""
    odd_sizes: bool = False
    """Whether it takes odd sizes although colour is stored at half the size."""
    quality_name: str = "crf"
    """Name of its constant-quality option."""
    twin: str | None = None
    """Codec that needs no card, where this one does."""
    tag: str | None = None
    """Four letters in mp4 and mov, where the muxer's own choice does not play everywhere."""
    usual: str = ".mkv"
    """Ending of what it is most often carried in; Matroska holds them all."""


_AS_GIVEN = {"avoid_negative_ts": "disabled"}
"""Else sound that starts before 0, as coded sound does, moves the pictures as well."""

CONTAINERS = {
    ".mp4": Container("mp4", "h264", "aac", {"movflags": "+faststart"}),
    ".m4v": Container("mp4", "h264", "aac", {"movflags": "+faststart"}),
    ".mov": Container("mov", "h264", "aac", {"movflags": "+faststart"}),
    ".mkv": Container("matroska", "h264", "aac", _AS_GIVEN),
    ".webm": Container("webm", "vp9", "libopus", _AS_GIVEN),
    ".gif": Container("gif", "gif", None),
}
"""By ending, in lower case."""

_PRESETS = (
    *("ultrafast", "superfast", "veryfast", "faster", "fast"),
    *("medium", "slow", "slower", "veryslow", "placebo"),
)
_PLAIN = {"x264-params": "aq-mode=0:b-adapt=0"}
"""Areas of one colour leave nothing to mask errors by, and B-frames pay wherever they may stand:
without looking for either an encoder works 0.7 of the time for files that are 0.8 to 0.95 as large
at the same crf, see docs/speed.md."""
_YUV = ("yuv420p", "yuv422p", "yuv444p")
_DEEP = ("yuv420p10le", "yuv422p10le", "yuv444p10le")


def _on_card(name: str, twin: str, quality: int, tag: str | None = None) -> VideoCodec:
    """An encoder of an NVIDIA card.

    Source: FFmpeg's options of NVENC: a constant quality is a variable rate without a target.
    """
    return VideoCodec(
        name,
        ("yuv420p",) if name == "av1_nvenc" else ("yuv420p", "yuv444p"),
        quality,
        0,
        63 if name == "av1_nvenc" else 51,
        {"preset": "p4", "rc": "vbr", "b": "0"},
        presets=tuple(f"p{number}" for number in range(1, 8)),
        quality_name="cq",
        twin=twin,
        tag=tag,
        usual=".mp4",
    )


ENCODERS = {
    "h264": VideoCodec(
        "libx264",
        _YUV + _DEEP,
        18,
        0,
        51,
        {"preset": "superfast"},
        _PLAIN,
        _PRESETS,
        usual=".mp4",
    ),
    "h265": VideoCodec(
        "libx265",
        _YUV + _DEEP,
        20,
        0,
        51,
        {"preset": "fast", "x265-params": "log-level=error"},
        presets=_PRESETS,
        tag="hvc1",
        usual=".mp4",
    ),
    "av1": VideoCodec(
        "libsvtav1",
        ("yuv420p", "yuv420p10le"),
        28,
        0,
        63,
        {"preset": "8"},
        presets=tuple(str(n) for n in range(13, -1, -1)),
    ),
    "vp9": VideoCodec(
        "libvpx-vp9",
        _YUV,
        24,
        0,
        63,
        {"deadline": "realtime", "cpu-used": "5", "row-mt": "1", "tile-columns": "1"},
        alpha_format="yuva420p",
        odd_sizes=True,
        usual=".webm",
    ),
    "prores": VideoCodec(
        "prores_ks",
        ("yuv422p10le", "yuv444p10le"),
        None,
        0,
        0,
        {},
        alpha_format="yuva444p10le",
        usual=".mov",
    ),
    "ffv1": VideoCodec(
        "ffv1",
        ("yuv444p", "yuv420p", "yuv422p", "bgr0"),
        None,
        0,
        0,
        {},
        alpha_format="bgra",
        odd_sizes=True,
    ),
    "gif": VideoCodec("gif", ("pal8",), None, 0, 0, {}),
    "h264_nvenc": _on_card("h264_nvenc", "h264", 19),
    "hevc_nvenc": _on_card("hevc_nvenc", "h265", 22, tag="hvc1"),
    "av1_nvenc": _on_card("av1_nvenc", "av1", 28),
}
"""By the name that users give."""
CARD_CODECS = sorted(name for name, encoder in ENCODERS.items() if encoder.twin is not None)
"""Those that users choose from where there is an NVIDIA card."""
VIDEO_CODECS = sorted(ENCODERS.keys() - {"gif"} - set(CARD_CODECS))
"""Those that users choose from; a GIF has its own."""

_ALIASES = {
    "avc": "h264",
    "x264": "h264",
    "libx264": "h264",
    "hevc": "h265",
    "h265_nvenc": "hevc_nvenc",
    "x265": "h265",
    "libx265": "h265",
    "libsvtav1": "av1",
    "libvpx-vp9": "vp9",
    "prores_ks": "prores",
}


def find_encoder(codec: str) -> VideoCodec:
    """Look an encoder up.

    Args:
        codec: Name of a codec or of one of its encoders.

    Raises:
        OptionError: If it is not known, or this FFmpeg lacks it.
    """
    key = _ALIASES.get(codec.lower(), codec.lower())
    if key not in ENCODERS:
        raise OptionError(
            f"codec {codec!r}: not known; choose one of {', '.join(VIDEO_CODECS)}, "
            f"with an NVIDIA card also {', '.join(CARD_CODECS)}"
        )
    encoder = ENCODERS[key]
    if encoder.name not in av.codecs_available:
        raise OptionError(
            f"codec {codec!r}: this build of FFmpeg has no {encoder.name}; choose another codec"
        )
    return encoder
