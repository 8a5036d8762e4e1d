"""Beats as a scale, and the files that tell of them."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from stages.hearing.beats_file import read_beats, write_beats, write_labels
from stages.hearing.contour import Contour
from stages.hearing.heard import MOST_BEATS, Heard, Mark
from warp_kernels.errors import MediaError, OptionError


def speeding_up() -> Heard:
    """Sixteen beats, each a little nearer to the next, in bars of three from the second on."""
    beats = 2 + np.cumsum(np.linspace(0.6, 0.4, 16))
    loud = Contour(100.0, np.linspace(0, 1, 1000, dtype=np.float32))
    return Heard(
        10.0, 120.0, beats, beats[1::3], beats[::2] + 0.1, {"low": loud}, (Mark(3.0, "verse"),), 3
    )


def test_beats_and_times_are_each_others_inverse() -> None:
    """Also before the first beat and after the last one, where the tempo there goes on."""
    heard = speeding_up()
    times = np.linspace(-5, 20, 333)
    assert np.allclose(heard.time_of_beat(heard.beat_at(times)), times)
    assert np.allclose(heard.beat_at(heard.beats), np.arange(16))
    assert (np.diff(heard.beat_at(times)) > 0).all()
    late = heard.time_of_beat(17) - heard.time_of_beat(16)
    assert late == pytest.approx(np.diff(heard.beats)[-8:].mean())


def test_bars_count_from_the_first_downbeat() -> None:
    """Bar 1 begins there; before it lies bar 0, with the upbeat."""
    heard = speeding_up()
    assert [heard.time_of_bar(n + 1) for n in range(5)] == pytest.approx(heard.downbeats)
    assert heard.time_of_bar(2, 3) == pytest.approx(heard.beats[6])
    assert heard.bar_at(heard.beats[0]) == pytest.approx(2 / 3)
    assert heard.time_of_bar(7) == pytest.approx(heard.time_of_beat(19))


def test_a_tempo_alone_is_enough() -> None:
    """Without beats those of the tempo are counted; without both there is a remedy."""
    assert Heard(10, 120).time_of_bar(3) == pytest.approx(4.0)
    assert Heard.steady(10, 90, 3, 1.0).time_of_bar(2, 2) == pytest.approx(1 + 4 * 60 / 90)
    with pytest.raises(OptionError, match="no beat; give"):
        Heard(10).beat_at(1.0)


def test_envelopes_are_silent_beyond_the_sound() -> None:
    """Between values they are even, and `since` counts from the last beat."""
    heard = speeding_up()
    low = heard.envelope("low")
    assert low.at(5.0) == pytest.approx(500 / 999)
    assert list(low.at(np.array([-1.0, 11.0]))) == [0, 0]
    assert heard.since("beats", heard.beats[3] + 0.25) == pytest.approx(0.25)
    assert heard.since("beats", 0.0) == np.inf
    with pytest.raises(OptionError, match=r"loudness: nothing tells .*low"):
        heard.envelope("loudness")


def test_a_sound_that_starts_later_takes_all_along() -> None:
    """Beats, bars, sections and envelopes, and back."""
    heard = speeding_up()
    later = heard.moved(1.5)
    assert np.allclose(later.beats, heard.beats + 1.5)
    assert later.envelope("low").at(6.5) == pytest.approx(heard.envelope("low").at(5.0), abs=1e-6)
    assert later.moved(-1.5).time_of_bar(2) == pytest.approx(heard.time_of_bar(2))


def test_our_own_files_come_back(tmp_path: Path) -> None:
    """JSON holds everything, labels the beats, the bars and the sections."""
    heard = speeding_up()
    write_beats(heard, tmp_path / "a.json")
    again = read_beats(tmp_path / "a.json")
    for name in ("beats", "downbeats", "onsets"):
        assert np.allclose(getattr(again, name), getattr(heard, name), atol=1e-4)
    assert (again.duration, again.bpm, again.meter, again.sections) == (10, 120, 3, heard.sections)
    assert np.allclose(again.envelope("low").values, heard.envelope("low").values, atol=1e-4)
    write_labels(heard, tmp_path / "a.txt")
    again = read_beats(tmp_path / "a.txt")
    assert np.allclose(again.beats, heard.beats, atol=1e-5)
    assert np.allclose(again.downbeats, heard.downbeats, atol=1e-5)
    assert (again.sections, again.meter) == (heard.sections, 3)


MIDI = bytes.fromhex(
    "4d546864 00000006 0001 0001 0060 4d54726b 0000002b"
    "00ff5103 07a120"  # 120 bpm
    "00ff5804 03021808"  # 3/4
    "00ff0605 496e74726f"  # marker Intro
    "8300ff5103 0f4240"  # after four quarters 60 bpm
    "8140ff0601 42"  # after two more, marker B
    "8140903c40"
    "00ff2f00"
)

FORMS = {
    "beat_this.beats": ("0.50\t1\n1.00\t2\n1.50\t3\n2.00\t1\n", [0.5, 2.0], 3),
    "madmom.txt": ("0.500 1\n1.000 2\n1.500 3\n2.000 1\n", [0.5, 2.0], 3),
    "bare.txt": ("# beats\n\n0.5\n1.0\n1.5\n2\n", [], 4),
    "audacity.txt": (
        "0.500000\t0.500000\tdownbeat\n1.0\t1.0\tB\n\\\t100\t200\n1.5\t1.5\t\n2.0\t2.0\tdb\n",
        [0.5, 2.0],
        4,
    ),
    "same.txt": ("0.5\t0.5\tClap\n1.0\t1.0\tClap\n1.5\t1.5\tClap\n2.0\t2.0\tClap\n", [], 4),
    "sonic.csv": ('TIME,LABEL\n0.5,"1"\n1.0,"2"\n1.5,"3"\n2.0,"1"\n', [0.5, 2.0], 3),
    "counted.csv": ("time,beat\n0.5,15\n1.0,16\n1.5,17\n2.0,18\n", [], 4),
    "comma.csv": ("0,5;1\r\n1,0;2\r\n1,5;3\r\n2,0;1\r\n", [0.5, 2.0], 3),
    "clock.csv": ("0:00.5,beat\n0:01,beat\n0:01.5,beat\n0:02.0,beat\n", [], 4),
    "list.json": ("[0.5, 1.0, 1.5, 2.0]", [], 4),
}


@pytest.mark.parametrize("name", FORMS)
def test_beats_of_other_programs(tmp_path: Path, name: str) -> None:
    """Whatever wrote them: the same four beats, and downbeats where the file knows of them."""
    text, downbeats, meter = FORMS[name]
    (tmp_path / name).write_text(text, encoding="utf-8")
    heard = read_beats(tmp_path / name)
    assert list(heard.beats) == [0.5, 1.0, 1.5, 2.0]
    assert (list(heard.downbeats), heard.meter, heard.bpm) == (downbeats, meter, 120)


def test_tempos_and_markers_of_midi(tmp_path: Path) -> None:
    """Beats follow the tempos, bars the time signature, markers name sections."""
    (tmp_path / "a.mid").write_bytes(MIDI)
    heard = read_beats(tmp_path / "a.mid")
    assert np.allclose(heard.beats, [0, 0.5, 1, 1.5, 2, 3, 4, 5, 6])
    assert np.allclose(heard.downbeats, [0, 1.5, 4])
    assert heard.sections == (Mark(0.0, "Intro"), Mark(4.0, "B"))
    assert heard.meter == 3


EDL = """TITLE: SONG
FCM: NON-DROP FRAME

001  AX       V     C        00:00:00:00 00:00:08:00 01:00:00:00 01:00:08:00
* FROM CLIP NAME: Intro
002  AX       V     D    012 00:00:10:00 00:00:18:00 01:00:08:12 01:00:16:00
 |C:ResolveColorBlue |M:Chorus |D:1
* LOC: 01:00:12:00 RED     drop
"""


def test_sections_of_an_edit_decision_list(tmp_path: Path) -> None:
    """Frames count at the film's rate; the hour at which films begin is left out."""
    (tmp_path / "a.edl").write_text(EDL, encoding="utf-8")
    heard = read_beats(tmp_path / "a.edl", Fraction(24))
    assert heard.sections == (Mark(0.0, "Intro"), Mark(8.5, "Chorus"), Mark(12.0, "drop"))
    assert heard.duration == 16
    dropped = EDL.replace("NON-DROP", "DROP").replace("01:00:12:00", "01:10:00;00")
    (tmp_path / "b.edl").write_text(dropped, encoding="utf-8")
    assert read_beats(tmp_path / "b.edl").sections[-1].time == pytest.approx(600, abs=0.02)


@pytest.mark.parametrize(
    ("text", "beats"),
    [
        ("0,5\n1,0\n1,5\n", [0.5, 1.0, 1.5]),
        ("1,1\n2,2\n3,3\n", [1.0, 2.0, 3.0]),
        ("0;1\n0,5;2\n", [0.0, 0.5]),
    ],
)
def test_a_comma_is_a_decimal_or_parts_time_and_place(
    tmp_path: Path, text: str, beats: list[float]
) -> None:
    """A file of `0,5`, `1,0` was read as times 0 and 1 with places in a bar."""
    (tmp_path / "a.txt").write_text(text)
    assert read_beats(tmp_path / "a.txt").beats.tolist() == beats


BROKEN = {
    "a.json": ('{"beats": [1, "2"]}', "beats holds '2', which is not a number"),
    "b.json": ('{"beats": [2, 1]}', "beats go back from 2 to 1 s"),
    "c.json": ('{"bpm": 120}', "neither beats nor sections"),
    "d.json": ("[" * 3000, "nested|Expecting"),
    "e.txt": ("0.5\n1.0\nhello\n", "line 3: 'hello' is not a time"),
    "f.txt": ("\n\n", "holds no time"),
    "g.edl": ("TITLE: X\n", "holds no event"),
    "h.mid": (MIDI[:40].decode("latin-1"), "breaks off"),
    "i.json": ('{"beats": [1e999]}', "inf, which is too large"),
    "j.json": (f'{{"beats": [0, {"9" * 400}]}}', "holds 9{20}, which is too large"),
    "k.json": ('{"beats": [0, 5e-324]}', "beats go back"),
    "l.json": ('{"beats": [0, 1], "sections": null}', "sections is not a list"),
    "m.json": ('{"beats": [0], "bpm": 1e308}', "too large"),
    "n.json": (
        '{"beats": [0], "envelopes": {"low": {"rate": 1e8, "values": [0]}}}',
        "rate of envelope low",
    ),
    "o.txt": ("9" * 400 + ":00:01\n", "holds no time"),
    "p.txt": ("nan\n1\n", "line 1: 'nan' is not a time"),
    "q.txt": ("-1\n0.5\n", "line 1: '-1' is not a time"),
    "r.txt": ("2\n1\n0.5\n", "line 2: goes back from 2 to 1 s"),
    "s.txt": ("".join(f"{n}\n" for n in range(MOST_BEATS + 1)), "holds more than 100000 times"),
    "t.json": (
        '{"beats": [0], "envelopes": {"low": {"rate": 10, "values": [0, 7]}}}',
        "low holds 7; strengths go from 0 to 1",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_no_file_of_beats(tmp_path: Path, name: str) -> None:
    """One line: the file, what is wrong, and what could be given."""
    text, problem = BROKEN[name]
    (tmp_path / name).write_text(text, encoding="latin-1")
    with pytest.raises(MediaError, match=problem) as error:
        read_beats(tmp_path / name)
    assert "give the JSON" in str(error.value)
    assert "\n" not in str(error.value)
