"""Written files: exact times, sizes, formats, and nothing half-finished under a name."""

import re
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
import media_samples as samples
import numpy as np
import pytest
from PIL import Image

from stages.media import (
    EncodeOptions,
    FrameRange,
    MediaInfo,
    check_output,
    open_decoder,
    open_encoder,
    probe,
)
from stages.media.writing.commit import PendingFile, output_error
from warp_kernels.errors import OptionError, OutputError

WHOLE = FrameRange()
ROOT = Path(__file__).parent.parent


def convert(
    source: Path,
    target: Path,
    options: EncodeOptions | None = None,
    wanted: FrameRange = WHOLE,
) -> list[str]:
    """Copy frames from a source to an output; returns the encoder's notes."""
    with open_decoder(source, wanted) as decoder:
        size = (decoder.info.width, decoder.info.height)
        options = options or EncodeOptions()
        with open_encoder(target, decoder.info, size, options, wanted) as encoder:
            for frame in decoder:
                encoder.write(frame.pixels, frame.pts, frame.time_base, frame.index)
    return encoder.notes


def times_of(path: Path) -> list[Fraction]:
    """Times of all frames of a file [s]."""
    with open_decoder(path) as decoder:
        return [frame.pts * frame.time_base for frame in decoder]


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Six frames of 64 x 48 at uneven times."""
    pictures = [samples.picture(64, 48, n) for n in range(6)]
    pts = [0, 40, 90, 91, 400, 440]
    return samples.write_video(
        tmp_path / "in.mp4", pictures, pts=pts, time_base=samples.MILLISECOND
    )


@pytest.mark.parametrize("ending", ["mp4", "mov", "mkv", "webm"])
def test_uneven_times_survive(clip: Path, ending: str) -> None:
    """Every frame is shown exactly when the source shows it."""
    target = clip.with_name(f"out.{ending}")
    convert(clip, target)
    assert times_of(target) == times_of(clip)


@pytest.mark.parametrize("base", [Fraction(1, 30000), Fraction(417, 78125), Fraction(1, 3)])
def test_any_time_base_survives_in_mp4(clip: Path, base: Fraction) -> None:
    """The clock of the file is chosen so that no time is rounded, even of a late start."""
    target = clip.with_name("out.mp4")
    pts = [7, 8, 10, 11, 12, 19, 100]
    with open_encoder(target, probe(clip), (64, 48), EncodeOptions(audio=False)) as encoder:
        for number, time in enumerate(pts):
            encoder.write(samples.picture(64, 48, number), time, base)
    assert times_of(target) == [time * base for time in pts]


@pytest.mark.parametrize("ending", ["mp4", "mov", "mkv", "webm", "gif"])
def test_the_same_frames_make_the_same_file(clip: Path, ending: str) -> None:
    """To the bit: Matroska files bore random numbers once."""
    first, second = (clip.with_name(f"{name}.{ending}") for name in ("first", "second"))
    convert(clip, first)
    convert(clip, second)
    assert first.read_bytes() == second.read_bytes()


def test_last_frame_keeps_its_length(clip: Path) -> None:
    """The file ends when the source ends."""
    target = clip.with_name("out.mp4")
    convert(clip, target)
    assert probe(target).duration == probe(clip).duration


def test_huge_gap_is_not_filled(clip: Path) -> None:
    """A million seconds between two frames stay two frames."""
    target = clip.with_name("out.mkv")
    with open_encoder(target, probe(clip), (64, 48), EncodeOptions(audio=False)) as encoder:
        for time in (0, 40, 1_000_000_000):
            encoder.write(samples.picture(64, 48), time, samples.MILLISECOND)
    assert times_of(target) == [0, Fraction(1, 25), 1_000_000]


@pytest.mark.parametrize("ending", ["mp4", "gif"])
def test_gap_that_a_format_cannot_state_is_told(clip: Path, ending: str) -> None:
    """It is an error with a remedy, not a shorter gap."""
    info, before = probe(clip), sorted(clip.parent.iterdir())
    encoder = open_encoder(clip.with_name(f"a.{ending}"), info, (64, 48), EncodeOptions())
    encoder.write(samples.picture(64, 48), 0, Fraction(1, 90000))
    with pytest.raises(OutputError, match=r"write \.mkv"):
        encoder.write(samples.picture(64, 48), 10**12, Fraction(1, 90000))
    encoder.abort()
    assert sorted(clip.parent.iterdir()) == before


def test_a_range_starts_at_zero(clip: Path) -> None:
    """A part of a clip keeps its distances and starts at time 0."""
    target = clip.with_name("out.mp4")
    convert(clip, target, wanted=FrameRange(2, 4))
    assert times_of(target) == [0, Fraction(1, 1000), Fraction(310, 1000)]


def test_odd_size_is_padded(clip: Path) -> None:
    """4:2:0 needs even sizes: a border pixel is repeated, and a note says so."""
    target = clip.with_name("out.mp4")
    info = probe(clip)
    with open_encoder(target, info, (33, 17), EncodeOptions(audio=False, crf=0)) as encoder:
        encoder.write(samples.picture(33, 17), 0, samples.MILLISECOND)
    assert (probe(target).width, probe(target).height) == (34, 18)
    assert any("34x18" in note for note in encoder.notes)


def test_444_keeps_odd_sizes_and_colours(clip: Path) -> None:
    """With yuv444p nothing is padded."""
    target = clip.with_name("out.mp4")
    options = EncodeOptions(audio=False, pixel_format="yuv444p")
    with open_encoder(target, probe(clip), (33, 17), options) as encoder:
        encoder.write(samples.picture(33, 17), 0, samples.MILLISECOND)
    assert (probe(target).width, probe(target).pixel_format) == (33, "yuv444p")


def test_pixel_aspect_is_copied(tmp_path: Path) -> None:
    """Non-square pixels stay so, and turn with the picture."""
    pictures = [samples.picture(64, 48)]
    source = samples.write_video(
        tmp_path / "in.mp4", pictures, aspect=Fraction(32, 27), rotation=90
    )
    convert(source, tmp_path / "out.mp4")
    assert probe(tmp_path / "out.mp4").sample_aspect == Fraction(27, 32)
    assert probe(tmp_path / "out.mp4").rotation == 0


def test_four_tags_are_written(clip: Path) -> None:
    """Matrix, range, primaries and transfer are all stated."""
    target = clip.with_name("out.mp4")
    convert(clip, target)
    with av.open(str(target)) as written:
        codec = written.streams.video[0].codec_context
        tags = (codec.colorspace, codec.color_range, codec.color_primaries, codec.color_trc)
    assert tags == (1, 1, 1, 1)


@pytest.mark.parametrize("name", ["out_###.png", "out_%03d.tiff", "out_$F3.webp"])
def test_numbered_stills_keep_pixels_and_numbers(clip: Path, name: str) -> None:
    """Lossless stills are equal to the frames and named after them."""
    convert(clip, clip.with_name(name), wanted=FrameRange(1, 5, 2))
    ending = name.split(".")[1]
    found = sorted(p.name for p in clip.parent.glob("out_*"))
    assert found == [f"out_{n:03d}.{ending}" for n in (1, 3, 5)]
    with open_decoder(clip, FrameRange(3, 3)) as a, open_decoder(clip.with_name(found[1])) as b:
        assert np.array_equal(next(a).pixels, next(b).pixels)


def test_jpeg_colours(clip: Path) -> None:
    """A JPEG is full-range BT.601 and comes back within a few code values."""
    target = clip.with_name("a.jpg")
    pixels = samples.chart(256, 128)
    with open_encoder(target, probe(clip), (256, 128), EncodeOptions(), FrameRange(0, 0)) as out:
        out.write(pixels, 0, samples.MILLISECOND)
    with open_decoder(target) as decoder:
        found = samples.patch_colors(next(decoder).pixels)
    assert np.abs(found - samples.CHART).max() <= 4


def test_gif(clip: Path) -> None:
    """A GIF has every frame there is time for, in hundredths of a second, nearly as coloured."""
    target = clip.with_name("out.gif")
    convert(clip, target, EncodeOptions(audio=False))
    assert times_of(target) == [Fraction(n, 100) for n in (0, 4, 9, 11, 40, 44)]
    with open_decoder(clip) as a, open_decoder(target) as b:
        assert np.abs(next(a).pixels.astype(int) - next(b).pixels).mean() < 4


def test_transparency_is_kept_where_it_can_be(clip: Path) -> None:
    """PNG keeps alpha; mp4 shows white there."""
    pixels = np.zeros((48, 64, 4), np.uint8)
    pixels[:24] = (0, 0, 255, 255)
    still, video = clip.with_name("a.png"), clip.with_name("a.mp4")
    for target in (still, video):
        with open_encoder(target, probe(clip), (64, 48), EncodeOptions(), FrameRange(0, 0)) as out:
            out.write(pixels, 0, samples.MILLISECOND)
    assert probe(still).pixel_format == "rgba"
    with open_decoder(video) as decoder:
        assert next(decoder).pixels[40, 30].min() >= 254


def test_existing_output_is_refused(clip: Path) -> None:
    """Nothing is replaced unless that is asked for."""
    target = clip.with_name("out.mp4")
    target.write_bytes(b"precious")
    with pytest.raises(OutputError, match="exists already"):
        convert(clip, target)
    assert target.read_bytes() == b"precious"
    convert(clip, target, EncodeOptions(overwrite=True))
    assert probe(target).frame_count == 6


def test_input_is_never_overwritten(clip: Path) -> None:
    """Not even when replacing is asked for."""
    with pytest.raises(OutputError, match="the input itself"):
        convert(clip, clip, EncodeOptions(overwrite=True))


def test_missing_folder_and_folder_as_output(clip: Path) -> None:
    """Both are told before any work is done."""
    info = probe(clip)
    with pytest.raises(OutputError, match="no folder"):
        check_output(clip.parent / "none" / "a.mp4", info, (64, 48), EncodeOptions())
    (clip.parent / "folder.mp4").mkdir()
    with pytest.raises(OutputError, match="is a folder"):
        check_output(clip.parent / "folder.mp4", info, (64, 48), EncodeOptions())


def test_unwritable_output(clip: Path) -> None:
    """A folder that takes no files is told before any work is done."""
    with pytest.raises(OutputError):
        check_output("/proc/out.mp4", probe(clip), (64, 48), EncodeOptions())


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("a.xyz", EncodeOptions()),
        ("noending", EncodeOptions()),
        ("a_##.mp4", EncodeOptions()),
        ("a.webm", EncodeOptions(codec="h264")),
        ("a.mp4", EncodeOptions(codec="nonsense")),
        ("a.mp4", EncodeOptions(crf=99)),
        ("a.mp4", EncodeOptions(pixel_format="rgb565")),
        ("a.mp4", EncodeOptions(encoder_preset="warp")),
        ("a.mov", EncodeOptions(codec="prores", crf=3)),
        ("a_##.png", EncodeOptions(codec="h264")),
        ("a.png", EncodeOptions()),
    ],
)
def test_impossible_wishes_are_refused_early(clip: Path, name: str, options: EncodeOptions) -> None:
    """What does not go together is an error before any work is done."""
    with pytest.raises(OptionError):
        check_output(clip.parent / name, probe(clip), (64, 48), options)


@pytest.mark.parametrize(
    ("name", "remedy"),
    [("noending", "has no ending"), ("a_#.png", "write a_####.png,"), ("%d.png", "frame_####.png")],
)
def test_names_that_hold_no_clip_are_told_one_that_does(clip: Path, name: str, remedy: str) -> None:
    """A number field that is none does not stay in it."""
    with pytest.raises(OptionError, match=remedy):
        check_output(clip.with_name(name), probe(clip), (64, 48), EncodeOptions())


def test_a_quality_that_there_is_not_is_told_one_that_works(clip: Path) -> None:
    """With the bounds."""
    given = clip.with_name("a.mp4"), probe(clip), (64, 48)
    with pytest.raises(OptionError, match="takes 0 to 51, the best first; try 18"):
        check_output(*given, EncodeOptions(crf=200))
    check_output(*given, EncodeOptions(crf=18))


@pytest.mark.parametrize(("codec", "ending"), [("prores", ".mov"), ("h264", ".mp4")])
def test_a_codec_is_told_what_usually_carries_it(clip: Path, codec: str, ending: str) -> None:
    """The remedy works."""
    given = probe(clip), (64, 48), EncodeOptions(codec=codec)
    with pytest.raises(OptionError, match=rf"cannot hold it; use \{ending} or another codec"):
        check_output(clip.with_name("a.webm"), *given)
    check_output(clip.with_name(f"a{ending}"), *given)


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
@pytest.mark.parametrize("name", ["out.mp4", "out.mkv", "out.gif", "out.png"])
def test_interruption_leaves_nothing(clip: Path, name: str, error: type[BaseException]) -> None:
    """Whatever ends the work early, no file appears, not even a temporary one."""
    before = sorted(clip.parent.iterdir())
    info = probe(clip)
    wanted = FrameRange(0, 0) if name.endswith("png") else WHOLE

    def break_off() -> None:
        target = clip.with_name(name)
        with open_encoder(target, info, (64, 48), EncodeOptions(), wanted) as encoder:
            encoder.write(samples.picture(64, 48), 0, samples.MILLISECOND)
            raise error

    with pytest.raises(error):
        break_off()
    assert sorted(clip.parent.iterdir()) == before


def test_error_of_the_system_is_an_output_error(clip: Path) -> None:
    """What the system says while the file is moved is told, and nothing is left."""
    target = clip.with_name("out.mp4")

    def write_while_another_makes_a_folder() -> None:
        with open_encoder(target, probe(clip), (64, 48), EncodeOptions()) as encoder:
            encoder.write(samples.picture(64, 48), 0, samples.MILLISECOND)
            target.mkdir()

    with pytest.raises(OutputError, match=r"out\.mp4: .*is a directory"):
        write_while_another_makes_a_folder()
    assert not list(target.iterdir())
    assert sorted(clip.parent.iterdir()) == sorted([clip, target])


def test_no_frame_is_an_error(clip: Path) -> None:
    """An output without frames is not written."""
    target = clip.with_name("out.mp4")
    with (
        pytest.raises(OutputError, match="no frame"),
        open_encoder(target, probe(clip), (64, 48), EncodeOptions()),
    ):
        pass
    assert not target.exists()


def test_wrong_shape_and_time_are_programming_errors(clip: Path) -> None:
    """The caller's mistakes are not blamed on the user's file."""
    info: MediaInfo = probe(clip)
    encoder = open_encoder(clip.with_name("out.mp4"), info, (64, 48), EncodeOptions())
    with pytest.raises(ValueError, match="pixels"):
        encoder.write(samples.picture(10, 10), 0, samples.MILLISECOND)
    encoder.write(samples.picture(64, 48), 5, samples.MILLISECOND)
    with pytest.raises(ValueError, match="increase"):
        encoder.write(samples.picture(64, 48), 5, samples.MILLISECOND)
    encoder.abort()


FULL_DISK = """
import resource, signal, sys
from pathlib import Path
from stages.media import EncodeOptions, open_decoder, open_encoder
from warp_kernels.errors import OutputError

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
source, target = sys.argv[1:]
try:
    with open_decoder(source) as decoder:
        info = decoder.info
        with open_encoder(target, info, (64, 48), EncodeOptions()) as encoder:
            for frame in decoder:
                encoder.write(frame.pixels, frame.pts, frame.time_base)
except OutputError as error:
    sys.exit(error.exit_code)
"""


@pytest.mark.parametrize("ending", ["mp4", "mkv", "gif"])
def test_file_that_cannot_grow(tmp_path: Path, ending: str) -> None:
    """When the disk takes no more, that is an OutputError and nothing is left."""
    noise = np.random.default_rng(2).integers(0, 255, (60, 48, 64, 3), dtype=np.uint8)
    source = samples.write_video(tmp_path / "in.mp4", list(noise))
    before = sorted(tmp_path.iterdir())
    script = [sys.executable, "-c", FULL_DISK, str(source), str(tmp_path / f"out.{ending}")]
    done = subprocess.run(script, cwd=ROOT, timeout=60, capture_output=True, text=True)
    assert done.returncode == OutputError.exit_code, done.stderr
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("rate", [24, 25, 30, 48, 50, 60, 100, 120, Fraction(60000, 1001)])
def test_gif_lasts_as_long_as_its_source(tmp_path: Path, rate: Fraction) -> None:
    """No delay is under 2/100 s, which players show as 10/100; frames are dropped evenly."""
    base = 1 / Fraction(rate)
    info = replace(
        probe(samples.write_still(tmp_path / "a.png", samples.picture(32, 24))),
        average_rate=Fraction(rate),
    )
    count = round(rate)
    with open_encoder(tmp_path / "a.gif", info, (32, 24), EncodeOptions()) as encoder:
        for number in range(count):
            encoder.write(samples.picture(32, 24, number), number, base)
    with Image.open(tmp_path / "a.gif") as picture:
        delays = []
        for page in range(picture.n_frames):
            picture.seek(page)
            delays.append(picture.info["duration"])
    assert min(delays) >= 20
    assert max(delays) - min(delays) <= 10
    assert abs(sum(delays) - 1000 * count * base) <= 10
    dropped = count - len(delays)
    assert (dropped > 0) == (rate > 50)
    assert any(f"{dropped} are left out" in note for note in encoder.notes) == (rate > 50)


def test_gif_of_a_burst_of_frames(tmp_path: Path) -> None:
    """Frames of uneven times: the last of a burst is not lost for longer than a moment."""
    info = probe(samples.write_still(tmp_path / "a.png", samples.picture(64, 48)))
    times = [0, 1, 2, 3, 500, 501, 502, 1000]
    with open_encoder(tmp_path / "a.gif", info, (64, 48), EncodeOptions()) as encoder:
        for number, time in enumerate(times):
            encoder.write(samples.picture(64, 48, number), time, samples.MILLISECOND)
    shown = [0, 2, 50, 52, 100]
    assert times_of(tmp_path / "a.gif") == [Fraction(time, 100) for time in shown]


@pytest.fixture
def linked(clip: Path) -> tuple[Path, Path]:
    """A link to a file in another folder, and that file's name; there is no such file yet."""
    folder = clip.parent / "other"
    folder.mkdir()
    link = clip.with_name("link.mp4")
    link.symlink_to(Path("other") / "true.mp4")
    return link, folder / "true.mp4"


def test_a_link_is_written_through(clip: Path, linked: tuple[Path, Path]) -> None:
    """The link stays, what it points to is replaced, and the temporary file lies there."""
    link, true = linked
    true.write_bytes(b"before")
    assert PendingFile(link).path.parent.samefile(true.parent)
    with pytest.raises(OutputError, match="exists already"):
        convert(clip, link)
    assert true.read_bytes() == b"before"
    with open_encoder(link, probe(clip), (64, 48), EncodeOptions(overwrite=True)) as encoder:
        for time in (0, 40):
            encoder.write(samples.picture(64, 48), time, samples.MILLISECOND)
    assert link.is_symlink()
    assert list(true.parent.iterdir()) == [true]
    assert len(times_of(true)) == 2


def test_a_link_that_leads_nowhere(clip: Path, linked: tuple[Path, Path]) -> None:
    """It is not replaced without being asked, and then makes the file it names."""
    link, true = linked
    with pytest.raises(OutputError, match="exists already"):
        convert(clip, link)
    convert(clip, link, EncodeOptions(overwrite=True))
    assert link.is_symlink()
    assert times_of(true) == times_of(clip)


@pytest.mark.parametrize("name", ["a.png", "s_##.png"])
def test_links_of_stills(clip: Path, name: str) -> None:
    """Chains of links, for a single still and for numbered ones."""
    folder = clip.parent / "other"
    folder.mkdir()
    written = clip.with_name(name.replace("##", "00"))
    written.symlink_to("second.png")
    clip.with_name("second.png").symlink_to(folder / "true.png")
    still = FrameRange(0, 0)
    with pytest.raises(OutputError, match="exists already"):
        convert(clip, clip.with_name(name), wanted=still)
    convert(clip, clip.with_name(name), EncodeOptions(overwrite=True), still)
    assert written.is_symlink()
    assert not (folder / "true.png").is_symlink()


def test_links_that_cannot_be_written(clip: Path) -> None:
    """To a missing folder, in a circle, to the input, to a device."""
    overwrite = EncodeOptions(overwrite=True)
    circle, away, own, device = (clip.with_name(f"{name}.mp4") for name in "abcd")
    circle.symlink_to(circle.name)
    away.symlink_to("nowhere/a.mp4")
    own.symlink_to(clip.name)
    device.symlink_to("/dev/null")
    for link in (circle, away, own, device):
        with pytest.raises(OutputError):
            convert(clip, link, overwrite)
        assert link.is_symlink()


def test_what_killed_runs_left_is_removed(clip: Path) -> None:
    """Temporary files of dead processes of this machine, and of nobody else."""
    live = PendingFile(clip).path
    (dead,) = (live.with_name(re.sub(r"-\d+-", "-999999999-", live.name)),)
    foreign = live.with_name(".trimotion-elsewhere-999999999-0123456789ab.part")
    other = live.with_name(".trimotion-notes")
    for path in (live, dead, foreign, other):
        path.write_bytes(b"x")
    (dead.with_suffix(".mtrk.parts")).mkdir()
    convert(clip, clip.with_name("out.mp4"))
    left = {entry.name for entry in clip.parent.iterdir() if entry.name.startswith(".")}
    assert left == {live.name, foreign.name, other.name}


def test_lack_of_memory_is_told_as_such(clip: Path) -> None:
    """Not as a matter of rights, whether Python or the system says so."""
    for error in (MemoryError(), OSError(12, "Cannot allocate memory")):
        told = str(output_error(clip, error))
        assert "out of memory" in told
        assert "ulimit" in told
        assert "rights" not in told
