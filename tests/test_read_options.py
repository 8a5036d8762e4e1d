"""What a source leaves open, a user can choose: rate, page, picture, stream."""

from fractions import Fraction
from pathlib import Path

import av
import heif_samples as heif
import media_samples as samples
import numpy as np
import pytest
from PIL import Image
from test_encode import times_of

from pipeline.cli import main
from stages.media import ReadOptions, open_decoder, probe
from warp_kernels.errors import OptionError

QUICK = ["--triangles", "20", "--iterations", "2", "--frame-iterations", "1", "--progress", "none"]


def stills(folder: Path) -> Path:
    """Four numbered stills."""
    for number in range(4):
        samples.write_still(folder / f"s_{number:02}.png", samples.picture(64, 48, number))
    return folder / "s_##.png"


@pytest.mark.parametrize(
    ("text", "rate"),
    [("24", Fraction(24)), ("30000/1001", Fraction(30000, 1001)), ("12.5", Fraction(25, 2))],
)
@pytest.mark.parametrize("ending", ["mp4", "mkv"])
def test_rate_of_stills(tmp_path: Path, text: str, rate: Fraction, ending: str) -> None:
    """Every still is shown when its number says, to the bit where the format can state it."""
    out = tmp_path / f"out.{ending}"
    command = ["animate", str(stills(tmp_path)), "-o", str(out), "--fps", text, *QUICK]
    assert main(command) == 0
    slack = Fraction(1, 2000) if ending == "mkv" else 0
    for number, time in enumerate(times_of(out)):
        assert abs(time - number / rate) <= slack
    assert abs(probe(out).duration - 4 / rate) <= Fraction(1, 500)


def test_rate_of_a_track(tmp_path: Path) -> None:
    """What was solved with a rate is drawn with it."""
    track, out = tmp_path / "a.mtrk", tmp_path / "out.mp4"
    source = str(stills(tmp_path))
    assert main(["solve", source, "-o", str(track), "--fps", "12", *QUICK]) == 0
    assert main(["render", str(track), "-o", str(out), "--progress", "none"]) == 0
    assert times_of(out) == [Fraction(number, 12) for number in range(4)]


def test_rate_of_a_bare_stream(tmp_path: Path) -> None:
    """H.264 without a container has no times."""
    plain = samples.write_video(
        tmp_path / "a.mp4", [samples.picture(64, 48, n) for n in range(6)], options={"bf": "0"}
    )
    bare = tmp_path / "a.h264"
    with av.open(str(plain)) as source, av.open(str(bare), "w") as output:
        stream = output.add_stream_from_template(source.streams.video[0])
        for packet in source.demux(video=0):
            if packet.size:
                packet.stream = stream
                output.mux(packet)
    for rate in (Fraction(50), Fraction(24000, 1001)):
        with open_decoder(bare, read=ReadOptions(fps=rate)) as decoder:
            times = [frame.pts * frame.time_base for frame in decoder]
        steps = np.diff([float(time) for time in times])
        assert np.abs(steps - float(1 / rate)).max() < 1e-3


def test_what_has_times_keeps_them(tmp_path: Path) -> None:
    """A rate for it is a mistake, told in one line; so are impossible rates."""
    path = samples.write_video(tmp_path / "a.mp4", [samples.picture(64, 48)])
    with pytest.raises(OptionError, match="times of its own"):
        probe(path, read=ReadOptions(fps=Fraction(24)))
    for rate in (Fraction(0), Fraction(-1), Fraction(10**6)):
        with pytest.raises(OptionError, match="--fps"):
            ReadOptions(fps=rate)
    for text in ("fast", "1/0", "nan", "24 fps"):
        assert main(["animate", str(path), "-o", str(tmp_path / "b.mp4"), "--fps", text]) == 2


def flat(value: int, size: tuple[int, int] = (16, 8)) -> Image.Image:
    """A picture of one grey."""
    return Image.new("RGB", size, (value, value, value))


@pytest.mark.parametrize("how", [{}, {"compression": "tiff_lzw"}])
def test_pages_of_a_tiff(tmp_path: Path, how: dict[str, object]) -> None:
    """The first is shown and a note tells of the others; any can be chosen."""
    path = tmp_path / "a.tif"
    pages = [flat(10), flat(90, (20, 10)), flat(200)]
    pages[0].save(path, save_all=True, append_images=pages[1:], **how)
    assert any("3 pages" in note and "--page" in note for note in probe(path).notes)
    for page, value in ((None, 10), (1, 10), (2, 90), (3, 200)):
        with open_decoder(path, read=ReadOptions(page=page)) as decoder:
            (frame,) = decoder
        assert frame.pixels[0, 0, 0] == value
        assert frame.width == (20 if page == 2 else 16)
    with pytest.raises(OptionError, match="--page 4"):
        probe(path, read=ReadOptions(page=4))


def test_one_page_is_nothing_to_tell(tmp_path: Path) -> None:
    """And nothing to choose."""
    path = tmp_path / "a.tif"
    flat(10).save(path)
    assert not any("pages" in note for note in probe(path).notes)
    with pytest.raises(OptionError, match="one page"):
        probe(path, read=ReadOptions(page=2))
    with pytest.raises(OptionError, match="from 1"):
        ReadOptions(page=0)


def test_pictures_of_a_heif(tmp_path: Path) -> None:
    """A photo with another picture beside it."""
    pixels = np.full((40, 100, 3), 200, np.uint8)
    path = heif.write_grid(tmp_path / "a.heic", pixels)
    content = path.read_bytes().replace(b"thmb", b"cdsc")  # no thumbnail any more
    path.write_bytes(content)
    assert any("2 pictures" in note for note in probe(path).notes)
    for page, value in ((None, 200), (1, 200), (2, 128)):
        with open_decoder(path, read=ReadOptions(page=page)) as decoder:
            (frame,) = decoder
        assert abs(int(frame.pixels[5, 5, 0]) - value) <= 4
    with pytest.raises(OptionError, match="--page 3"):
        probe(path, read=ReadOptions(page=3))


def test_streams_of_a_film(tmp_path: Path) -> None:
    """A note tells which of several is used; another one can be chosen."""
    parts = [
        samples.write_video(tmp_path / f"{width}.mp4", [samples.picture(width, 48)] * 3)
        for width in (64, 32)
    ]
    both = tmp_path / "both.mkv"
    with av.open(str(both), "w") as output:
        opened = [av.open(str(part)) for part in parts]
        streams = [output.add_stream_from_template(part.streams.video[0]) for part in opened]
        for part, stream in zip(opened, streams, strict=True):
            for packet in part.demux(video=0):
                if packet.size:
                    packet.stream = stream
                    output.mux(packet)
            part.close()
    assert any("--stream" in note for note in probe(both).notes)
    for number, width in ((0, 64), (1, 32)):
        info = probe(both, read=ReadOptions(stream=number))
        assert (info.width, info.notes) == (width, ())
    with pytest.raises(OptionError, match="choose from 0, 1"):
        probe(both, read=ReadOptions(stream=2))
    assert main(["animate", str(both), "-o", str(tmp_path / "o.mp4"), "--stream", "1", *QUICK]) == 0
    assert probe(tmp_path / "o.mp4").width == 32
