"""Films that cards decode and encode: what can be known of them without a card."""

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

import trimotion
from stages.media import open_decoder
from stages.media.card_decoder import EXACT
from stages.media.color.yuv import RgbReader, read_color
from stages.media.reading.read_options import ReadOptions
from stages.media.writing.codecs import CARD_CODECS, find_encoder
from stages.media.writing.encode_options import EncodeOptions
from stages.media.writing.encoder_setup import settings_of
from tests import media_samples as samples
from trimotion import OptionError


def opens(codec: str, settings: dict[str, str]) -> bool:
    """Whether an encoder opens; options are read before a card is looked for."""
    context = av.CodecContext.create(codec, "w")
    context.width, context.height, context.pix_fmt = 256, 256, "yuv420p"
    context.time_base, context.options = Fraction(1, 25), settings
    try:
        context.open()
    except av.ArgumentError:
        raise
    except av.FFmpegError:
        return False
    return True


def has_card() -> bool:
    """Whether FFmpeg opens one."""
    return opens("h264_nvenc", {})


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pictures = [samples.picture(256, 144, number) for number in range(4)]
    return samples.write_video(tmp_path_factory.mktemp("card") / "in.mp4", pictures)


@pytest.mark.parametrize("codec", CARD_CODECS)
def test_encoders_know_their_settings(codec: str) -> None:
    """FFmpeg refuses another value of each, and takes theirs."""
    encoder = find_encoder(codec)
    for preset in encoder.presets:
        settings = settings_of(encoder, EncodeOptions(crf=30, encoder_preset=preset))
        assert (settings["cq"], settings["b"]) == ("30", "0")
        assert opens(encoder.name, settings) is has_card()
    for name in settings:
        with pytest.raises(av.ArgumentError):
            opens(encoder.name, {**settings, name: "none of its"})
    formats = {one.name for one in av.Codec(encoder.name, "w").video_formats or ()}
    assert set(encoder.pixel_formats) <= formats
    assert find_encoder(str(encoder.twin)).twin is None


@pytest.mark.skipif(has_card(), reason="there is a card")
@pytest.mark.parametrize("codec", CARD_CODECS)
def test_without_a_card_an_encoder_says_what_to_take(
    codec: str, clip: Path, tmp_path: Path
) -> None:
    done: list[object] = []
    with pytest.raises(OptionError, match=f"codec {codec}: no NVIDIA card here .*; choose [hav]+"):
        trimotion.animate(clip, tmp_path / "a.mp4", codec=codec, progress=done.append)
    assert not done
    assert not list(tmp_path.iterdir())


def test_frames_are_the_same_whoever_decodes_them(clip: Path) -> None:
    """With a card by it, without one by the CPU, which is told; photos and others never."""
    with open_decoder(clip) as plain, open_decoder(clip, read=ReadOptions(decoder="cuda")) as card:
        for one, other in zip(plain, card, strict=True):
            np.testing.assert_array_equal(one.pixels, other.pixels)
            assert one.pts == other.pts
        told = [note for note in card.notes if "--decoder cuda: the CPU decodes: " in note]
        assert len(told) == (0 if has_card() else 1)
    with pytest.raises(OptionError, match="--decoder gpu"):
        ReadOptions(decoder="gpu")


def test_pixels_as_cards_store_them_become_the_same_colours(clip: Path) -> None:
    with av.open(str(clip)) as container:
        frame = next(container.decode(video=0))
    color, size = read_color(frame), (frame.width, frame.height)
    expected = RgbReader().read8(frame, color, size)
    stored = frame.reformat(format="nv12")
    assert read_color(stored) == color
    np.testing.assert_array_equal(RgbReader().read8(stored, color, size), expected)


def test_codecs_for_cards_are_those_that_ffmpeg_decodes_there() -> None:
    for name in EXACT:
        assert any(one.is_supported for one in av.Codec(name, "r").hardware_configs or ())
