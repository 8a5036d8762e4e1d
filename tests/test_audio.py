"""Sound on its way from the source to the output."""

from fractions import Fraction
from pathlib import Path

import av
import media_samples as samples
import pytest
from test_encode import convert

from stages.media import EncodeOptions, FrameRange, probe


def clip_with_sound(folder: Path, seconds: int = 1, **how: object) -> Path:
    """25 frames of 64 x 48 with a tone."""
    pictures = [samples.picture(64, 48, n) for n in range(25)]
    return samples.write_video(folder / "in.mp4", pictures, sound=seconds, **how)


@pytest.mark.parametrize("ending", ["mp4", "mov", "mkv"])
def test_packets_are_copied(tmp_path: Path, ending: str) -> None:
    """Every packet arrives unchanged, at its time (mkv rounds to milliseconds)."""
    source = clip_with_sound(tmp_path)
    target = tmp_path / f"out.{ending}"
    convert(source, target)
    before, after = samples.sound_packets(source), samples.sound_packets(target)
    assert [content for _, content in before] == [content for _, content in after]
    slack = Fraction(1, 1000) if ending == "mkv" else 0
    assert all(abs(a[0] - b[0]) <= slack for a, b in zip(before, after, strict=True))


def test_late_and_long_sound_is_kept(tmp_path: Path) -> None:
    """Sound that starts late and outlasts the pictures stays where it is."""
    source = clip_with_sound(tmp_path, 2, sound_start=Fraction(1, 2))
    convert(source, tmp_path / "out.mp4")
    assert samples.sound_packets(tmp_path / "out.mp4") == samples.sound_packets(source)


def test_range_cuts_sound(tmp_path: Path) -> None:
    """Only packets within the range are kept, moved with the pictures."""
    source = clip_with_sound(tmp_path)
    convert(source, tmp_path / "out.mp4", wanted=FrameRange(5, 14))
    kept = samples.sound_packets(tmp_path / "out.mp4")
    whole = samples.sound_packets(source)
    expected = [(t - Fraction(1, 5), c) for t, c in whole if Fraction(1, 5) <= t < Fraction(3, 5)]
    assert [content for _, content in kept] == [content for _, content in expected]
    offsets = [abs(a[0] - b[0]) for a, b in zip(kept, expected, strict=True)]
    assert max(offsets) <= Fraction(1, 1000)


def test_sound_is_converted_for_webm(tmp_path: Path) -> None:
    """WebM cannot hold AAC: it becomes Opus, of the same length, and a note says so."""
    source = clip_with_sound(tmp_path)
    notes = convert(source, tmp_path / "out.webm")
    assert probe(tmp_path / "out.webm").audio_codec == "opus"
    assert any("converted to opus" in note for note in notes)
    times = [time for time, _ in samples.sound_packets(tmp_path / "out.webm")]
    assert abs(times[-1] - 1) < Fraction(1, 10)


def test_sound_can_be_dropped(tmp_path: Path) -> None:
    """Without audio there is no stream for it."""
    source = clip_with_sound(tmp_path)
    convert(source, tmp_path / "out.mp4", EncodeOptions(audio=False))
    with av.open(str(tmp_path / "out.mp4")) as written:
        assert not written.streams.audio


@pytest.mark.parametrize("name", ["out.gif", "out_##.png"])
def test_silent_formats_say_so(tmp_path: Path, name: str) -> None:
    """Where there is no place for sound a note tells that it is left out."""
    source = clip_with_sound(tmp_path)
    notes = convert(source, tmp_path / name)
    assert any("audio is left out" in note for note in notes)
