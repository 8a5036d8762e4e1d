"""Names of files and folders are names: only a number field has a meaning of its own."""

from pathlib import Path

import media_samples as samples
import numpy as np
import pytest
from test_encode import convert

from stages.media import NumberedPattern, input_pattern, open_decoder, probe
from warp_kernels.errors import MediaError, OptionError

NAMES = [
    "song #1",
    "100%done",
    "50% off %d",
    "poster [2]",
    "{a,b}",
    "what?*",
    "a:b",
    "file:c",
    "$F $HOME",
    'it\'s "quoted"',
    "back\\slash",
    " blank ",
    "-dash",
    "~home",
    "Größe 影",
    "line\nbreak",
    "pipe|tee",
    "dots...",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ending", ["mp4", "png"])
def test_any_name_is_read_and_written(tmp_path: Path, name: str, ending: str) -> None:
    """The very name, in a folder of the same one, and no other file beside it."""
    folder = tmp_path / name
    folder.mkdir()
    path, target = folder / f"{name}.{ending}", folder / f"out {name}.{ending}"
    if ending == "png":
        samples.write_still(tmp_path / "a.png", samples.picture(16, 8)).rename(path)
    else:
        pictures = [samples.picture(64, 48, n) for n in range(2)]
        samples.write_video(tmp_path / "a.mp4", pictures, sound=1).rename(path)
    convert(path, target)
    assert sorted(folder.iterdir()) == sorted([path, target])
    assert probe(target).audio_codec == probe(path).audio_codec


@pytest.mark.parametrize("name", ["a#b.png", "a%d.png", "a%1d.png", "$F.png", "a%.png", "a$4.png"])
def test_what_is_no_number_field(name: str) -> None:
    """A single # and a printf field without its zero are parts of a name."""
    assert NumberedPattern.parse(name) is None


def test_a_file_of_the_name_of_a_pattern_is_that_file(tmp_path: Path) -> None:
    """Its number field is not read as one."""
    path = samples.write_still(tmp_path / "s_##.png", samples.picture(16, 8))
    samples.write_still(tmp_path / "s_01.png", samples.picture(32, 8))
    assert input_pattern(path) is None
    assert probe(path).width == 16


def test_a_name_that_looks_like_an_address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file is a file; only where there is none the name is taken for an address."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "http:"
    folder.mkdir()
    samples.write_still(folder / "a.png", samples.picture(16, 8))
    assert probe("http:/a.png").width == 16
    with pytest.raises(MediaError, match="network address"):
        probe("https://localhost/a.png")


def test_a_mistyped_field_is_explained(tmp_path: Path) -> None:
    """Somebody who meant a pattern learns how one is written."""
    for name in ("s_#.png", "s_%d.png"):
        with pytest.raises(MediaError, match="numbered stills are written"):
            probe(tmp_path / name)


@pytest.fixture
def uneven(tmp_path: Path) -> Path:
    """Stills 8 to 11 without zeros in front."""
    for number in range(8, 12):
        samples.write_still(tmp_path / f"s_{number}.png", samples.picture(16, 8, number))
    return tmp_path


def test_stills_without_zeros_are_not_left_out_in_silence(uneven: Path) -> None:
    """The pattern that takes all is told, and takes all."""
    (note,) = [note for note in probe(uneven / "s_##.png").notes if "left out" in note]
    assert "s_8.png and s_9.png" in note
    assert "s_%01d.png takes all" in note
    with open_decoder(uneven / "s_%01d.png") as decoder:
        frames = list(decoder)
    assert [frame.index for frame in frames] == [8, 9, 10, 11]
    assert np.array_equal(frames[0].pixels, samples.picture(16, 8, 8))


def test_stills_with_other_zeros(uneven: Path) -> None:
    """Where no pattern takes all, none is told; where none fits, the one that does is."""
    with pytest.raises(MediaError, match=r"write s_%01d\.png"):
        probe(uneven / "s_####.png")
    samples.write_still(uneven / "s_0012.png", samples.picture(16, 8))
    notes = [note for note in probe(uneven / "s_##.png").notes if "left out" in note]
    assert "3 stills" in notes[0]
    assert "takes all" not in notes[0]


def test_numbered_videos_cannot_be_written(tmp_path: Path) -> None:
    """A number field in the name of a video is a mistake, and told as one."""
    source = samples.write_still(tmp_path / "a.png", samples.picture(16, 8))
    with pytest.raises(OptionError, match="numbered"):
        convert(source, tmp_path / "a_##.mp4")
