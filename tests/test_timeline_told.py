"""Timelines that cannot be, or do something else than they say: what is told, and where."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from pipeline.cli import main
from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.show import Show
from pipeline.timeline.show_file import parse_timeline
from stages.hearing.heard import Heard
from tests import media_samples as samples
from warp_kernels.errors import OptionError

CLOCK = Clock(Fraction(25), 0, 250, Heard.steady(13.0, 120.0).moved(-3.0))
"""10 s; of a song that began 3 s before the film, so that its second bar lies at -1 s."""


def show_of(text: str, clock: Clock = CLOCK) -> Show:
    """A timeline at the times of a film."""
    timeline = parse_timeline(text, "show.toml", Look())
    return Show(timeline, clock, (Look(), *(section.look for section in timeline.sections)))


def sections(*lines: str) -> str:
    """Sections of a line each."""
    return "".join(f"[[section]]\n{line}\n" for line in lines)


EDGES = '[[section]]\nstyle = ["flat", "edges"]\n[curves]\n'


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (  # the end of the first one was left out in silence
            sections('name = "a"\nto = "2s"', 'name = "b"\nfrom = "1.5s"'),
            r":3:7: a ends at 0:02.00 bar 3.3, and b .*; end a at 1.5s, or begin b at 2s",
        ),
        (
            sections('name = "a"\nto = "2:46:40.25"', 'name = "b"\nfrom = "1.5s"'),
            r":3:7: .*; end a at 1.5s, or begin b at 10000.25s",
        ),
        (
            sections('name = "a"', 'name = "b"\nfrom = "bar 2"'),
            r":5:9: b begins at -0:01.00 bar 2, before the film .*: bar 3 is the first in it",
        ),
        (sections("", 'from = "2s"\nto = "1s"'), r':5:7: .* ends at 0:01.00 .*to = "end"'),
        (sections('transition = "fade 1s"'), r":2:15: .*nothing is before it; leave transition"),
        ('[curves]\nopacity = "start: 0, bar 2: 1"', r":2:22: .*before the film begins"),
        (EDGES + '"edges.width" = "größe + 1"', r":4:18: 'größe' is no variable"),
        (EDGES + '"edges.width" = "1 + (ä) + tim"', r":4:23: 'ä' is no variable"),
        (EDGES + f'"edges.width" = "{"(" * 90}1{")" * 90}"', r":4:18: .*nests too deeply \(90"),
        ('[[section]]\nname = "a"\nname = "b"', r":3:1: name is given twice, first in line 2;"),
        (EDGES + '"edges.width" = 1\n' * 2, r":5:1: edges.width is given twice, first in line 4"),
        ("[curves]\n[curves]", r":2: \[curves\] is given twice, first in line 1; put both in one"),
        ("bpm = 120\nx = " + "[" * 3000, r":2: brackets stand 3000 deep"),
    ],
)
def test_what_cannot_be_is_told_where_it_stands(text: str, told: str) -> None:
    with pytest.raises(OptionError, match=r"^show\.toml" + told):
        show_of(text)


def test_many_brackets_beside_one_another_are_no_deep_ones() -> None:
    show_of(f'[curves]\nopacity = " 0{" + abs(t)" * 60}\t"')


def test_times_before_the_film_are_negative_and_bars_count_from_1() -> None:
    names = {-1.0: "-0:01.00 bar 2", -61.5: "-1:01.50", -0.001: "0:00.00 bar 2.3", 9.0: "0:09.00"}
    for time, name in names.items():
        assert CLOCK.name_of(time).startswith(name)
    assert CLOCK.bar_name(-3.5) == ""


def test_a_first_section_may_begin_with_the_first_frame_however_that_is_written() -> None:
    clock = Clock(Fraction(25), 0, 250, Heard.steady(10.0, 120.0))
    for begin in ("f0", "0%", "bar 1", "b0"):
        show = show_of(sections(f'name = "a"\nfrom = "{begin}"', 'from = "bar 2"'), clock)
        assert (show.sections[0].section.name, show.sections[0].first) == ("a", 0)


def test_a_still_is_not_sent_for_a_song() -> None:
    text = sections("", 'from = "bar 2"')
    with pytest.raises(OptionError, match="one frame"):
        show_of(text, Clock(Fraction(25), 0, 1, None))


def test_an_end_after_that_of_the_film_is_told() -> None:
    assert show_of(sections('to = "end"')).notes == ()
    (note,) = show_of(sections('name = "a"\nto = "99s"')).notes
    assert note.startswith("show.toml:3:7: a would end at 1:39.00")


def test_what_leaves_the_bounds_of_a_parameter_is_told_once_with_its_first_frame() -> None:
    style = 'style = ["flat", "edges"]'
    text = sections(style, f'from = "5s"\n{style}') + '[curves]\n"edges.width" = "1 + 10*t"\n'
    show = show_of(text + 'opacity = "clamp(2*t, 0, 1)"\n')
    first = next(k for k in range(250) if 1 + 10 * k / 25 > 50)
    (note,) = show.held(0, 249)
    assert f"show.toml:7:18: edges.width would be {1 + 0.4 * first:.4g} at frame {first}" in note
    assert "held at 50, the most" in note
    assert show.held(0, first - 1) == ()


def test_what_the_check_tells(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    clip = samples.write_video(tmp_path / "clip.mp4", [samples.picture(32, 32)] * 4)
    samples.write_still(tmp_path / "small.png", np.zeros((8, 8, 3), np.uint8))
    show = tmp_path / "show.toml"

    def told(content: str | bytes, *more: str) -> tuple[int, str]:
        """Exit code and words."""
        show.write_bytes(content.encode() if isinstance(content, str) else content)
        code = main(["timeline", str(show), "--check", str(clip), *more])
        return code, "".join(capsys.readouterr())

    code, words = told(sections('to = "99s"'))
    assert (code, words.count("note: ")) == (0, 1)
    code, words = told(sections(f'region = ["{tmp_path}/nope.png:flat"]'))
    assert code == 2
    assert f"{show}:2:10: region: {tmp_path}/nope.png: no such file" in words
    code, words = told(sections(f'region = ["{tmp_path}/small.png:flat"]'))
    assert (code, "the mask is 8x8 and the source 32x32" in words) == (2, True)
    code, words = told(sections("# gr\xfcn").encode("latin-1"))
    assert (code, "is no text in UTF-8 (line 2); save it as UTF-8" in words) == (2, True)
    code, words = told('[curves]\nopacity = "rms"', "--audio", str(tmp_path / "nope.wav"))
    assert (code, words.endswith("check the name\n")) == (3, True)


def test_a_second_timeline_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    more = ["--timeline", "pulse", "--timeline", "build-up"]
    assert main(["animate", "clip.mp4", "-o", "out.mp4", *more]) == 2
    assert (
        "--timeline: is given twice, pulse and build-up; leave one out" in capsys.readouterr().err
    )
