"""Timelines: times, keys and expressions; what is drawn at a frame, whatever range it is in."""

import re
import sys
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from pipeline.cli import main
from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.easings import EASINGS, easing_name
from pipeline.timeline.expression import parse_expression
from pipeline.timeline.keyframes import Keyed, parse_keys
from pipeline.timeline.mixing import mixed
from pipeline.timeline.show import Show
from pipeline.timeline.show_file import parse_timeline, read_timeline
from pipeline.timeline.signals import Signals
from pipeline.timeline.timeline import TEMPLATES, shipped_timelines
from pipeline.timeline.times import parse_when
from pipeline.timeline.written.place import Place
from stages.hearing.heard import Heard, Mark
from stages.media import probe
from tests import media_samples as samples
from warp_kernels.errors import OptionError
from warp_kernels.styles.color import parse_color

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))

import broken_timelines

HERE = Place("show.toml", 7, 11)
CLOCK = Clock(Fraction(24), 0, 480, Heard.steady(20.0, 120.0))
"""20 s at 24 frames a second; a beat each half second, a bar each 2 s."""


def show_of_text(text: str, look: Look | None = None, clock: Clock = CLOCK) -> Show:
    """A timeline at the times of a film."""
    base = look or Look()
    timeline = parse_timeline(text, "show.toml", base)
    return Show(timeline, clock, (base, *(section.look for section in timeline.sections)))


def signals_at(frames: np.ndarray, clock: Clock = CLOCK) -> Signals:
    """All that expressions may look at, at some frames."""
    times = np.array([clock.time_of_frame(int(frame)) for frame in frames])
    return Signals(clock, frames, times, np.zeros_like(frames), (0.0, 20.0))


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("12.5s", 12.5),
        ("250ms", 0.25),
        ("1:02.5", 62.5),
        ("0:01:02.5", 62.5),
        ("f240", 10.0),
        ("b32", 16.0),
        ("bar 1", 0.0),
        ("bar 9", 16.0),
        ("bar 9.3", 17.0),
        ("BAR 9.2.5", 16.75),
        ("+4 bars", 11.0),
        ("+ 2 beats", 4.0),
        ("+12 frames", 3.5),
        ("start", 0.0),
        ("end", 20.0),
        ("25%", 5.0),
        ("bar at 26%", 6.0),
    ],
)
def test_times(text: str, seconds: float) -> None:
    assert CLOCK.time_of(parse_when(text), before=3.0) == pytest.approx(seconds, abs=1e-9)


def test_sections_of_a_song_are_times() -> None:
    """By their names, in any letters; the second of a name by its number."""
    marks = (Mark(4.0, "Chorus"), Mark(9.0, "Verse 1"), Mark(12.0, "chorus"))
    clock = Clock(Fraction(24), 0, 480, replace(Heard.steady(20.0, 120.0), sections=marks))
    for text, seconds in (("at chorus", 4.0), ("at Verse 1", 9.0), ("at CHORUS 2", 12.0)):
        assert clock.time_of(parse_when(text)) == seconds
    with pytest.raises(OptionError, match=r"no such section \(Chorus, Verse 1, chorus\); name it"):
        clock.time_of(parse_when("at chorus 3"))
    with pytest.raises(OptionError, match="none is named"):
        CLOCK.time_of(parse_when("at verse"))


HUGE = ("{}s", "f{}", "b{}", "bar {}", "bar 1.{}", "{}%", "{}:00", "+{} bars")


@pytest.mark.parametrize(
    "text",
    ["12", "4 bars", "bar 0", "bar 1.0", "f1.5", "1:75", "noon", ""]
    + [form.format("9" * count) for form in HUGE for count in (12, 400, 5000)],
)
def test_what_is_no_time_is_told_with_a_remedy(text: str) -> None:
    with pytest.raises(ValueError, match="write"):
        parse_when(text)


def test_easings_lead_from_0_to_1_and_have_both_names() -> None:
    for name, ease in EASINGS.items():
        if not name.startswith("step"):
            assert ease(0.0) == pytest.approx(0.0, abs=1e-3), name
            assert ease(1.0) == pytest.approx(1.0, abs=1e-9), name
    assert easing_name("easeInOutCubic") == "ease-in-out-cubic" == easing_name("in-out-cubic")
    assert EASINGS["ease-in-out"](0.25) == pytest.approx(0.1292, abs=1e-3)  # of CSS


def test_an_easing_rules_the_segment_that_leaves_its_key() -> None:
    keys = parse_keys("0s: 0 step, 1s: 10 linear, +1s: 20", HERE, float)
    keyed = Keyed.of(keys, CLOCK)
    assert [keyed.at(t) for t in (0.0, 0.99, 1.0, 1.5, 2.0, 9.0)] == [0, 0, 10, 15, 20, 20]


def test_keys_on_beats_keep_their_beat_when_rate_and_tempo_change() -> None:
    keys = parse_keys("bar 2: 1, +2 beats: 2", HERE, float)
    for rate, bpm in ((24, 120.0), (30, 120.0), (25, 90.0)):
        heard = Heard.steady(20.0, bpm)
        clock = Clock(Fraction(rate), 0, 1000, heard)
        times = Keyed.of(keys, clock).times
        wanted = [heard.time_of_bar(2), heard.time_of_bar(2, 3)]
        assert np.abs(np.array(times) - wanted).max() <= 0.5 / rate + 1e-9


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("0s: 1, f0: 2", "two keys fall on frame 0"),
        ("2s: 1, 1s: 2", "put them in order"),
        ("0s: 1, 99s: 2", "after the end of the film"),
    ],
)
def test_keys_that_cannot_be_are_told_with_their_column(text: str, told: str) -> None:
    with pytest.raises(OptionError, match=told) as caught:
        Keyed.of(parse_keys(text, HERE, float), CLOCK)
    assert str(caught.value).startswith("show.toml:7:1")


def test_colours_mix_in_oklab() -> None:
    assert mixed("#000", "#fff", 0.0) == "#000"
    middle = np.array(parse_color(mixed("blue", "yellow", 0.5)))
    assert middle.min() > 90  # of code values the middle is a dull grey-green
    greys = [parse_color(mixed("black", "white", share))[0] for share in (0.25, 0.5, 0.75)]
    assert greys == sorted(greys)
    assert greys[1] == pytest.approx(99, abs=2)  # L = 0.5


EXPRESSIONS: Mapping[str, tuple[int, float]] = {
    "1 + 2*3 - 4/2": (0, 5.0),
    "t": (36, 1.5),
    "f % 5": (13, 3.0),
    "b": (18, 1.5),
    "floor(bar)": (49, 2.0),
    "bpm": (100, 120.0),
    "beat": (12, 1.0),
    "beat + downbeat": (13, 0.0),
    "downbeat": (48, 1.0),
    "every(2 bars)": (96, 1.0),
    "env(beat, decay=0.5s)": (12, 1.0),
    "env(beat, decay=0.25s) < 0.06": (18, 1.0),
    "env(every(1 bar), decay=1 bar)": (95, 0.05**0.979),
    "lerp(1, 3, 0.5) + clamp(7, 0, 1) + max(1, 2, 3)": (0, 6.0),
    "2 if t > 1s else 1": (25, 2.0),
    "1/f if f > 0 else 7": (0, 7.0),
    "smooth(0.5) + abs(-1) + 2**3": (0, 9.5),
    "progress": (240, 0.5),
    "not (t < 1 and f < 3)": (2, 0.0),
    "2*px": (0, 2.0),
}


def test_a_pixel_grows_with_the_shorter_side_of_the_film(tmp_path: Path) -> None:
    clip = samples.write_video(tmp_path / "clip.mp4", [samples.picture(36, 64)] * 2)
    assert Clock.of(probe(clip), None).pixel == pytest.approx(36 / 720)


@pytest.mark.parametrize("text", EXPRESSIONS)
def test_expressions(text: str) -> None:
    frame, value = EXPRESSIONS[text]
    found = parse_expression(text, HERE).at(signals_at(np.arange(frame, frame + 1)))
    assert found[0] == pytest.approx(value, abs=2e-3)


@pytest.mark.parametrize("text", [*EXPRESSIONS, "noise(3)", "random(b)", "noise(1, 2 beats)"])
def test_an_expression_at_a_frame_does_not_depend_on_the_frames_beside_it(text: str) -> None:
    expression, frames = parse_expression(text, HERE), np.arange(40)
    together = expression.at(signals_at(frames))
    alone = [expression.at(signals_at(frames[k : k + 1]))[0] for k in frames]
    assert np.array_equal(together, alone)


@pytest.mark.parametrize(
    ("text", "column", "told"),
    [
        ("1 + wobble(t)", 15, r"'wobble\(t\)' is no function"),
        ("1 + tim", 15, "is no variable"),
        ("t.real", 11, "is not allowed"),
        ("__import__('os')", 11, "is no function"),
        ("[1][0]", 11, "is not allowed"),
        ("(lambda: 1)()", 11, "is no function"),
        ("1 +", 11, "is no expression"),
        ("4 beats", 11, "is a length of time"),
        ("env(t)", 11, "takes moments first"),
        ("'red'", 11, "is no number"),
        ("sin(1, 2)", 11, "takes 1 numbers"),
        ("1 + 1e999", 15, "is too large"),
        ("9" * 400, 11, "is too large"),
        ("noise(1e999)", 17, "is too large"),
        ("1+" * 400 + "1", 11, "operations one within another"),
        ("-" * 900 + "1", 11, "operations one within another"),
    ],
)
def test_what_is_no_expression_is_told_with_line_and_column(
    text: str, column: int, told: str
) -> None:
    with pytest.raises(OptionError, match=told) as caught:
        parse_expression(text, HERE)
    assert str(caught.value).startswith(f"show.toml:7:{column}: "), caught.value


@pytest.mark.parametrize(
    ("text", "frame"),
    [
        ("1/(f - 30)", 30),
        ("(10 - f)**0.5", 11),
        ("f % (f - 5)", 5),
        ("9.9**f", 0),
        ("sin(9.9**f)", 0),
    ],
)
def test_what_is_no_number_at_a_frame_is_told_with_the_frame(text: str, frame: int) -> None:
    with pytest.raises(OptionError, match=rf"at frame {frame or ''}"):
        parse_expression(text, HERE).at(signals_at(np.arange(480)))


TWO = """
[[section]]
from = "0s"
style = ["flat", "edges:width=1", "edges:width=2"]

[[section]]
from = "bar 3"
style = ["shrink"]
transition = "fade 1 bar"
[section.curves]
shrink.gap = "progress * 10"

[curves]
"edges[1].width" = "0s: 2, 2s: 4"
edges.color = "0s: red, bar 3: blue"
opacity = 0.5
"""


def test_the_look_of_a_frame() -> None:
    show = show_of_text(TWO)
    first = show.at(24).scene
    assert [getattr(style, "width", None) for style in first.look.styles] == [None, 1.0, 3.0]
    assert first.opacity == 0.5
    assert show.at(24).before is None
    passing = show.at(96)
    assert passing.before is not None
    assert 0 < passing.share < 0.05
    last = show.at(480 - 1)
    assert last.before is None
    assert last.scene.look.styles[0].gap == pytest.approx(10, abs=0.05)


def test_frames_that_come_unevenly_have_the_look_of_their_time() -> None:
    show = show_of_text(TWO)
    assert show.at(24, Fraction(24, 24) + Fraction(1, 1000)) == show.at(24)  # a rounded time
    assert show.at(24, Fraction(48, 24)).scene.look == show.at(48).scene.look


@pytest.mark.parametrize(
    ("wrong", "right", "told"),
    [
        ("bar 3", "bar 300", r":7:9: .*the film ends"),
        ('"shrink"', '"shrimp"', r":8:11: .*no 'shrimp'; did you mean shrink"),
        ("fade 1 bar", "fade 99 bars", r":9:15: .*longer than the section"),
        ("fade 1", "dissolve 1", r":9:15: transition: no 'dissolve'"),
        ("transition", "transitoin", r":9:\d+: unknown key 'transitoin'.*did you mean transition"),
        ("edges[1]", "edges[5]", r":14:\d+: .*there are 2 of edges"),
        ("edges[1].width", "edges[1].wdith", r":14:\d+: .*no parameter 'wdith'; did you mean"),
        ("edges.color", "opal.color", r":15:\d+: .*nothing shows opal"),
        ("2s: 4", "2s: 400", r":14:\d+: 400: must lie between 0.1 and 50"),
        ("0s: 2", "x: 2", r":14:\d+: 'x' is no time"),
        ("blue", "blau", r":15:\d+: colour 'blau'"),
        ("progress *", "progress %% *", r":11:\d+: .*is no expression"),
        ("[curves]", "[curve]", r":13: unknown key 'curve'; did you mean curves"),
        ("opacity = 0.5", "opacity = ", r":16:\d+: no TOML"),
        ("opacity = 0.5", "opacity = " + "9" * 5000, r":\d+: no TOML \(exceeds the limit"),
        ('"0s"', '"0s"\nname = "a\u2028b"\nfro = 1', r":5:\d+: unknown key 'fro'"),
        ('from = "bar 3"', "", r":6: a section needs a time"),
    ],
)
def test_mistakes_are_told_with_their_line(wrong: str, right: str, told: str) -> None:
    assert wrong in TWO
    with pytest.raises(OptionError, match=r"^show\.toml" + told):
        show_of_text(TWO.replace(wrong, right, 1))


def test_the_page_shows_what_can_be_read() -> None:
    page = Path(__file__).parents[1] / "docs" / "timeline.md"
    (example,) = re.findall(r"^```toml\n(.*?)^```", page.read_text("utf-8"), re.MULTILINE | re.S)
    clock = Clock(Fraction(24), 0, 24 * 90, Heard.steady(90.0, 120.0))
    show = show_of_text(example, clock=clock)
    assert [placed.section.name for placed in show.sections] == [
        *("verse", "chorus", "section 3", "between")
    ]
    assert show.mesh_at(0, "triangles") == 60


@pytest.mark.parametrize("name", shipped_timelines())
@pytest.mark.parametrize("seconds", [1, 3, 20, 240])
def test_shipped_timelines_fit_films_of_any_length(name: str, seconds: int) -> None:
    timeline = read_timeline(name, Look())
    clock = Clock(Fraction(25), 0, 25 * seconds, Heard.steady(seconds, timeline.bpm or 120))
    show = Show(timeline, clock, (Look(), *(one.look for one in timeline.sections)))
    show.check(0, 25 * min(seconds, 20) - 1)
    assert show.held(0, 25 * min(seconds, 20) - 1) == ()  # nothing leaves its bounds
    assert len(show.sections) == len(timeline.sections)


@pytest.mark.parametrize("name", [*shipped_timelines(), "everything"])
def test_broken_timelines_are_told_in_one_line(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Some of what benchmarks/broken_timelines.py tries."""
    clip = samples.write_video(tmp_path / "clip.mp4", [samples.picture(32, 32)] * 125)
    show, refused = tmp_path / "show.toml", 0
    shipped = TEMPLATES / f"{name}.toml"
    whole = shipped.read_text("utf-8") if shipped.exists() else broken_timelines.everything()
    show.write_text(whole, "utf-8")
    assert main(["timeline", str(show), "--check", str(clip)]) == 0
    for text in islice(broken_timelines.mutants(whole, 7), 12):
        show.write_text(text, "utf-8")
        code = main(["timeline", str(show), "--check", str(clip)])
        told = capsys.readouterr().err.splitlines()
        refused += code == 2
        assert (code, told) == (0, []) or (code == 2 and len(told) == 1), (text, told)
        assert not told or broken_timelines.TOLD.fullmatch(told[0]), told
        assert not broken_timelines.PYTHON.search(" ".join(told)), told
    assert refused > 6


def test_a_switch_that_is_none_is_told() -> None:
    """A curve of a switch reads its values by the rule of switches, and says so at its place."""
    text = '[[section]]\nmove = ["jitter"]\n[curves]\n"jitter.loose" = "start: maybe"\n'
    with pytest.raises(OptionError, match=r"^show\.toml:4:19: 'maybe' is not true or false; write"):
        parse_timeline(text, "show.toml", Look())


def test_beats_of_a_name_that_no_file_can_have_are_told() -> None:
    with pytest.raises(OptionError, match=r"^show\.toml:1:10: .*; check the name"):
        parse_timeline(f'beats = "{"a" * 5000}"', "show.toml", Look())


def test_beats_come_from_a_file_that_the_timeline_names(tmp_path: Path) -> None:
    (tmp_path / "song.txt").write_text("0.5\n1.1\n1.6\n2.2\n")
    (tmp_path / "show.toml").write_text('beats = "song.txt"\n[curves]\nopacity = "b1: 1, b3: 0"\n')
    timeline = read_timeline(str(tmp_path / "show.toml"), Look())
    assert timeline.beats is not None
    clock = Clock(Fraction(10), 0, 40, timeline.beats)
    show = Show(timeline, clock, (Look(), *(section.look for section in timeline.sections)))
    assert [show.at(k).scene.opacity for k in (11, 22)] == [1.0, 0.0]


@pytest.mark.parametrize(("meter", "bars"), [("", (5, 29)), ("meter = 3\n", (5, 23))])
def test_a_list_of_beats_has_bars_that_are_heard(
    meter: str, bars: tuple[int, int], tmp_path: Path
) -> None:
    (tmp_path / "song.txt").write_text("".join(f"{0.5 + 0.6 * n:g}\n" for n in range(6)))
    text = f'{meter}beats = "song.txt"\n[curves]\nopacity = "1 - downbeat"\n'
    (tmp_path / "show.toml").write_text(text)
    timeline = read_timeline(str(tmp_path / "show.toml"), Look())
    clock = Clock(Fraction(10), 0, 40, timeline.beats)
    show = Show(timeline, clock, (Look(), *(section.look for section in timeline.sections)))
    assert tuple(k for k in range(40) if show.at(k).scene.opacity == 0.0) == bars
    assert clock.bar_name(bars[1] / 10) == "2"


def test_a_shipped_timeline_is_printed_and_can_be_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["timeline", "pulse"]) == 0
    (tmp_path / "mine.toml").write_text(capsys.readouterr().out, "utf-8")
    assert len(read_timeline(str(tmp_path / "mine.toml"), Look()).sections) == 3
    for more in (["pulse", "-o", str(tmp_path / "strip.png")], [str(tmp_path / "mine.toml")]):
        assert main(["timeline", *more]) == 2
        assert "--check CLIP" in capsys.readouterr().err


@pytest.mark.parametrize("name", shipped_timelines())
def test_a_still_has_no_second_section(name: str) -> None:
    """Shipped timelines are of films: the message says so, for nobody can put theirs in order."""
    text = (TEMPLATES / f"{name}.toml").read_text("utf-8")
    with pytest.raises(OptionError, match="one frame"):
        show_of_text(text, clock=Clock(CLOCK.rate, 0, 1, CLOCK.heard))
