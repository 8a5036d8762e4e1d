"""Sound on its way from the source to the output."""

import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import av
import media_samples as samples
import pytest
from test_encode import ROOT, convert

from stages.media import EncodeOptions, FrameRange, check_output, probe
from warp_kernels.errors import OptionError


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


def with_tones(folder: Path, name: str, layout: str, codec: str = "pcm_s16le") -> Path:
    """A clip whose every channel has a tone of its own."""
    plain = samples.write_video(
        folder / "plain.mp4", [samples.picture(64, 48, n) for n in range(9)]
    )
    return samples.add_tones(plain, folder / name, layout, codec)


CUSTOM = {"5.1": 122 << 16 | 6, "6.1": 125 << 16 | 7, "7.1": 128 << 16 | 8}
"""Apple's numbers of orders that FFmpeg holds as custom ones: MPEG 5.1 B, 6.1 A and 7.1 C."""


def test_sound_of_a_custom_order_is_told_and_left_alone(tmp_path: Path) -> None:
    """PyAV 18.1 frees the order of such a sound twice, and the process aborted."""
    sources = [
        samples.set_order(with_tones(tmp_path, f"{layout}.mov", layout), number)
        for layout, number in CUSTOM.items()
    ]
    script = (
        "import sys, gc\n"
        "from stages.media import probe\n"
        "for name in sys.argv[1:]:\n"
        "    for _ in range(3): print(probe(name).audio_channels, flush=True); gc.collect()\n"
    )
    run = [sys.executable, "-c", script, *map(str, sources)]
    told = subprocess.run(run, capture_output=True, text=True, cwd=ROOT)
    counts = [str(av.AudioLayout(layout).nb_channels) for layout in CUSTOM for _ in range(3)]
    assert (told.returncode, told.stdout.split()) == (0, counts)


@pytest.mark.parametrize("custom", [False, True])
@pytest.mark.parametrize("layout", CUSTOM)
@pytest.mark.parametrize("ending", ["webm", "mp4", "mkv", "mov"])
def test_channels_arrive_where_they_belong(
    tmp_path: Path, layout: str, ending: str, custom: bool
) -> None:
    """Copied, converted, mixed down or up: the front and the bass keep their places."""
    source = with_tones(tmp_path, "in.mov", layout)
    if custom:
        samples.set_order(source, CUSTOM[layout])
    before = samples.loudest_tones(source)
    convert(source, tmp_path / f"out.{ending}")
    after = samples.loudest_tones(tmp_path / f"out.{ending}")
    if "NONE" in after:  # Matroska states no order; FFmpeg's own is understood
        assert not custom
        return
    common = before if set(before) == set(after) else ("FL", "FR", "FC", "LFE")
    assert {name: after[name] for name in common} == {name: before[name] for name in common}


@pytest.mark.parametrize(
    ("layout", "ending", "expected"),
    [
        ("6.1", "webm", 8),
        ("7.1", "webm", 8),
        ("quad", "webm", 4),
        ("5.0", "webm", 6),
        ("6.1", "mov", 6),
        ("7.1", "mov", 6),
        ("2.1", "mov", 3),
    ],
)
def test_many_channels_are_carried_or_mixed_down(
    tmp_path: Path, layout: str, ending: str, expected: int
) -> None:
    """Opus takes up to eight channels, AAC six that every player knows; a note tells of a mix."""
    source = with_tones(tmp_path, "in.mkv", layout, "flac")
    notes = convert(source, tmp_path / f"out.{ending}")
    written = probe(tmp_path / f"out.{ending}")
    assert written.audio_channels == expected
    mixed = expected < av.AudioLayout(layout).nb_channels
    assert any("mixed down" in note for note in notes) == mixed


@pytest.mark.parametrize(("mode", "codec"), [("auto", "aac"), ("copy", "pcm_s16le")])
def test_camera_sound_in_mp4(tmp_path: Path, mode: str, codec: str) -> None:
    """Uncompressed sound in mp4 plays nearly nowhere: AAC, unless a copy is asked for."""
    source = with_tones(tmp_path, "in.mov", "stereo")
    convert(source, tmp_path / "out.mp4", EncodeOptions(audio_mode=mode))
    assert probe(tmp_path / "out.mp4").audio_codec == codec


def test_what_cannot_be_copied_is_told_at_once(tmp_path: Path) -> None:
    """Before any picture is made."""
    source = with_tones(tmp_path, "in.mkv", "stereo", "flac")
    info, options = probe(source), EncodeOptions(audio_mode="copy")
    with pytest.raises(OptionError, match=r"--audio copy: webm cannot hold flac"):
        check_output(tmp_path / "out.webm", info, (64, 48), options)


def test_sound_that_changes_its_channels_goes_on(tmp_path: Path) -> None:
    """Stereo that becomes mono in the middle is converted throughout."""
    parts = [with_tones(tmp_path, f"{n}.ts", n, "mp2") for n in ("stereo", "mono")]
    joined = tmp_path / "in.ts"
    joined.write_bytes(b"".join(part.read_bytes() for part in parts))
    convert(joined, tmp_path / "out.webm")
    times = [time for time, _ in samples.sound_packets(tmp_path / "out.webm")]
    assert Fraction(8, 10) < times[-1] < Fraction(11, 10)


@pytest.mark.parametrize("ending", ["mp4", "mkv", "webm"])
def test_sound_of_a_trimmed_clip_is_trimmed(tmp_path: Path, ending: str) -> None:
    """What an edit list hides, a second at either end, is not carried into the output."""
    pictures = [samples.picture(64, 48, n) for n in range(75)]
    source = samples.write_video(tmp_path / "in.mp4", pictures, sound=3)
    samples.trim(source, Fraction(1), Fraction(1))
    convert(source, tmp_path / f"out.{ending}")
    times = [float(time) for time, _ in samples.sound_packets(tmp_path / f"out.{ending}")]
    assert times[0] >= -0.13
    assert 0.9 < times[-1] < 1.1
