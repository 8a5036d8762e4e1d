"""Listening: beats and bars of known music, and sounds in which there is nothing to hear."""

import json
import wave
from pathlib import Path

import numpy as np
import pytest

from benchmarks.listening import f_measure
from benchmarks.made_music import RATE, Piece, play
from pipeline.cli import main
from stages.hearing.beats_file import read_beats
from stages.hearing.heard import Heard
from stages.hearing.listening.listen import listen
from stages.media.sound.samples import SampleForm, samples_of


def save(path: Path, sound: np.ndarray, rate: int = RATE) -> Path:
    """Write samples, [channels, N], as a WAV of 16 bits."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(len(sound))
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes((np.clip(sound.T, -1, 1) * 32767).astype("<i2").tobytes())
    return path


@pytest.mark.parametrize(
    "piece",
    [
        Piece(140, is_band=False, seconds=14),
        Piece(92, seconds=16, swing=0.62, silence=3.0),
        Piece(128, seconds=16, drift=0.08, noise=True),
        Piece(174, meter=3, seconds=14),
    ],
)
def test_beats_and_bars_of_known_music(piece: Piece, tmp_path: Path) -> None:
    """Clicks, swing after silence, a tempo that drifts in noise, a fast waltz."""
    played = play(piece)
    heard = listen(save(tmp_path / "song.wav", played.sound[None]), meter=piece.meter).heard
    assert f_measure(played.beats, heard.beats) >= 0.93
    assert f_measure(played.downbeats, heard.downbeats) >= 0.85
    assert heard.beats[0] > piece.silence - 0.1


def test_nothing_before_it_changes_what_is_heard(tmp_path: Path) -> None:
    """The same file, the same numbers, and as its JSON holds them: automatic and by hand agree."""
    song = save(tmp_path / "song.wav", play(Piece(120, seconds=8)).sound[None])
    first, again = listen(song).heard, listen(song).heard
    assert main(["listen", str(song), "-o", str(tmp_path / "b.json"), "-q"]) == 0
    read = read_beats(tmp_path / "b.json")
    for other in (again, read):
        assert np.array_equal(first.beats, other.beats)
        assert np.array_equal(first.onsets, other.onsets)
        for name in ("loudness", "low", "mid", "high", "centroid"):
            assert np.array_equal(first.envelopes[name].values, other.envelopes[name].values)


def noise(seconds: float, channels: int = 1, rate: int = RATE) -> np.ndarray:
    """Noise as loud as music, [channels, N]."""
    rng = np.random.default_rng(7)
    return 0.2 * rng.standard_normal((channels, round(seconds * rate)))


@pytest.mark.parametrize(
    ("sound", "rate", "why"),
    [
        (np.zeros((2, 5 * RATE)), RATE, "silent"),
        (noise(9), RATE, "no steady beat"),
        (noise(0.05), RATE, "too short"),
        (noise(5, 1, 8000), 8000, "no steady beat"),
        (noise(1, 6, 96000), 96000, "too short"),
    ],
)
def test_no_beat_is_told(sound: np.ndarray, rate: int, why: str, tmp_path: Path, capsys) -> None:
    """Silence, noise, 50 ms, 8 kHz, six channels: a note with a remedy; a tempo helps."""
    song = save(tmp_path / "song.wav", sound, rate)
    found = listen(song)
    assert not len(found.heard.beats)
    assert found.heard.bpm is None
    assert any(why in note for note in found.notes)
    assert main(["listen", str(song)]) == 0
    told = capsys.readouterr()
    assert "no beat" in told.out
    assert told.err.count("\n") == 1
    assert listen(song, bpm=100).heard.has_beats


def test_a_known_tempo_is_kept(tmp_path: Path) -> None:
    """Said to be half as fast, it is."""
    song = save(tmp_path / "song.wav", play(Piece(120, is_band=False, seconds=9)).sound[None])
    assert listen(song).heard.bpm == pytest.approx(120, rel=0.01)
    assert listen(song, bpm=60).heard.bpm == pytest.approx(60, rel=0.02)


def test_a_person_corrects_labels_and_hands_them_back(tmp_path: Path, capsys) -> None:
    """Beats and sections are those of the file, envelopes those of the sound."""
    song = save(tmp_path / "song.wav", play(Piece(120, seconds=6)).sound[None])
    labels, plot, data = (tmp_path / name for name in ("b.txt", "p.png", "b.json"))
    assert main(["listen", str(song), "--labels", str(labels)]) == 0
    labels.write_text("".join(labels.read_text().splitlines(True)[2:]) + "1.0\t1.0\tverse\n")
    given = ["listen", str(song), "--beats", str(labels), "-o", str(data), "--plot", str(plot)]
    assert main(given) == 0
    heard = read_beats(data)
    assert len(heard.beats) == len(read_beats(labels).beats)
    assert [mark.name for mark in heard.sections] == ["verse"]
    assert heard.envelopes
    assert plot.read_bytes().startswith(b"\x89PNG")
    capsys.readouterr()
    assert main(given) == 4
    assert "exists already" in capsys.readouterr().err
    assert main([*given, "--overwrite", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["sections"]


@pytest.mark.parametrize(
    ("given", "code", "why"),
    [
        (["nothing.wav"], 3, "no such file"),
        (["."], 3, "is a folder"),
        (["README.md"], 3, "not a readable media file"),
        (["sample_videos/city.mp4"], 3, "holds no sound"),
        (["sample_videos/shapes.mp4", "--bpm", "1e9"], 2, "--bpm 1e+09"),
        (["sample_videos/shapes.mp4", "--meter", "0"], 2, "--meter 0"),
        (["sample_videos/shapes.mp4", "--plot", "x.txt"], 2, "is one picture"),
        (["sample_videos/shapes.mp4", "-o", "no/folder.json"], 4, "no folder"),
    ],
)
def test_mistakes_are_one_line(given: list[str], code: int, why: str, capsys) -> None:
    """Before anything is listened to, where that can be."""
    assert main(["listen", *given]) == code
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.count("\n") == 1
    assert why in told.err


def test_a_films_sound_counts_from_its_first_picture(tmp_path: Path) -> None:
    """Samples are as long as the sound, whatever the rate that is wanted."""
    clip = Path("sample_videos/shapes.mp4")
    sound = np.concatenate(list(samples_of(clip, SampleForm(24000))), axis=1)
    stereo = np.concatenate(list(samples_of(clip, SampleForm(48000, "stereo"))), axis=1)
    assert sound.shape[0] == 1
    assert stereo.shape[0] == 2
    assert abs(stereo.shape[1] - 2 * sound.shape[1]) < 200


def test_what_a_file_says_comes_before_what_is_heard() -> None:
    """A file of sections alone leaves the beats."""
    heard = Heard.steady(10, 120)
    assert np.array_equal(heard.told_by(Heard(12)).beats, heard.beats)
    assert heard.told_by(Heard.steady(9, 90)).bpm == 90
