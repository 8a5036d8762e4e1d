"""Another sound under a film, and the beats that a timeline hears in it."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from benchmarks.made_music import RATE
from stages.media import EncodeOptions, FrameRange, open_encoder, probe
from stages.media.sound.samples import SampleForm, samples_of
from tests.test_listening import save
from warp_kernels.errors import OptionError


def heard(path: Path) -> np.ndarray:
    """All samples of a file, [N]."""
    return np.concatenate(list(samples_of(path, SampleForm(48000))), axis=1)[0]


@pytest.mark.parametrize(
    ("offset", "first", "at"), [(0.0, 0, 0.5), (0.25, 0, 0.75), (-0.25, 0, 0.25), (0.0, 5, 0.3)]
)
def test_a_song_is_cut_moved_and_filled_up(
    offset: float, first: int, at: float, tmp_path: Path
) -> None:
    """A click after half a second of song is where it belongs in the film, and in a part of it."""
    sound = np.zeros((1, RATE))
    sound[0, RATE // 2 : RATE // 2 + 400] = 0.8 * np.sin(np.arange(400) * 0.3)
    song = save(tmp_path / "song.wav", sound)
    pixels = np.zeros((48, 64, 3), np.uint8)
    clip, out = tmp_path / "clip.mkv", tmp_path / "out.mp4"
    with open_encoder(clip, probe(Path("sample_videos/shapes.mp4")), (64, 48), SILENT) as made:
        for k in range(40):
            made.write(pixels, k, Fraction(1, 25))
    options = EncodeOptions(audio_mode=str(song), audio_offset=offset)
    wanted = FrameRange(first, 39)
    with open_encoder(out, probe(clip), (64, 48), options, wanted) as made:
        for k in range(first, 40):
            made.write(pixels, k, Fraction(1, 25))
    found = heard(out)
    assert abs(np.flatnonzero(np.abs(found) > 0.2)[0] / 48000 - at) < 0.01
    assert abs(len(found) / 48000 - (40 - first) / 25) < 0.05


SILENT = EncodeOptions(audio=False)


@pytest.mark.parametrize(("offset", "where"), [(-1.5, "over before"), (9.0, "after the film")])
def test_a_song_beside_the_film_is_told(offset: float, where: str, tmp_path: Path) -> None:
    """Nothing of it is heard, and that is no song that "ends early"."""
    song = save(tmp_path / "song.wav", np.full((1, RATE), 0.1))
    options = EncodeOptions(audio_mode=str(song), audio_offset=offset)
    shapes = probe(Path("sample_videos/shapes.mp4"))
    with open_encoder(tmp_path / "out.mp4", shapes, (64, 48), options) as made:
        for k in range(10):
            made.write(np.zeros((48, 64, 3), np.uint8), k, Fraction(1, 25))
    (told,) = made.notes
    assert where in told


def test_an_offset_needs_a_song() -> None:
    """And a day is enough."""
    with pytest.raises(OptionError, match="name one"):
        EncodeOptions(audio_offset=1.0)
    with pytest.raises(OptionError, match="within a day"):
        EncodeOptions(audio_mode="a.wav", audio_offset=1e9)
