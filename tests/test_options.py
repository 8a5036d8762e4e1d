"""Options: declared once in dataclasses, read for the command line, presets and specifications."""

import dataclasses
import re
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.commands.grammar import build_parser
from pipeline.options.build import build_job
from pipeline.options.command_line import job_options, with_preset
from pipeline.options.look import Look
from pipeline.options.members import parse_member
from pipeline.options.presets import blamed, read_preset, shipped_presets, without_effect
from stages.flows import FLOWS
from stages.flows.dis import Dis
from stages.layouts import LAYOUTS
from stages.layouts.importance import Importance
from tests.jobs import changed, job_of
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

MEMBERS = [
    (flag, name, registry)
    for flag, registry in (("--layout", LAYOUTS), ("--flow", FLOWS), ("--style", STYLES))
    for name in registry
]


def parse(*options: str) -> dict:
    """Values that the command line gives."""
    line = ["animate", "in.mp4", "-o", "out.mp4", *options]
    return {**vars(build_parser().parse_args(line)), "source": "in.mp4"}


def write_preset(folder: Path, text: str) -> str:
    """Write a preset and give its name."""
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_defaults_are_those_of_the_dataclasses() -> None:
    """The command line without options is the job without arguments."""
    job = build_job(parse())
    plain = job_of(Path("in.mp4"), Path("out.mp4"))
    assert type(job.solve.layout) is type(plain.solve.layout)
    assert changed(job, layout=plain.solve.layout) == plain  # it may hold an array


def test_every_option_has_help_and_its_own_name() -> None:
    """Flags are unique and explained."""
    flags = [option.flag for option in job_options()]
    assert len(set(flags)) == len(flags)
    assert all(option.help for option in job_options())


def test_options_reach_their_dataclass() -> None:
    """Values of all depths."""
    options = "--iterations 5 --regularity 0.25 --error 1.5 --crf 30 --size 40x30 --frames 2-8x3"
    job = build_job(parse(*options.split(), "--independent", "--overwrite", "--end", "0:02"))
    solve, encode = job.solve, job.output.encode
    assert solve.triangulate.iterations == 5
    assert solve.triangulate.optimize.regularity == 0.25
    assert solve.triangulate.refine.error == 1.5
    assert (encode.crf, encode.overwrite, solve.independent) == (30, True, True)
    assert job.look.output_size == (40, 30)
    wanted = solve.frame_range
    assert (wanted.first, wanted.last, wanted.step, wanted.end_time) == (2, 8, 3, 2)


@pytest.mark.parametrize(
    ("options", "size"),
    [
        ({}, (640, 361)),
        ({"scale": 0.5}, (320, 180)),
        ({"scale": 0.001}, None),
        ({"scale": 100.0}, None),
        ({"output_size": (7, 9)}, (7, 9)),
    ],
)
def test_output_size(options: dict, size: tuple[int, int] | None) -> None:
    """By size or scale; a picture without pixels, or too large, is refused with the numbers."""
    look = Look(**options)
    if size is None:
        with pytest.raises(OptionError, match=r"--scale .* of 640x361: sides must lie between"):
            look.framing_for((640, 361), Fraction(1))
    else:
        assert look.framing_for((640, 361), Fraction(1)).canvas == size


@pytest.mark.parametrize("name", shipped_presets())
def test_shipped_presets_make_jobs(name: str) -> None:
    """By name alone; every value is possible."""
    build_job(with_preset(parse(), read_preset(name)))


def test_preset_gives_any_option(tmp_path: Path) -> None:
    """Numbers, texts, switches and lists, with dashes or underscores."""
    preset = write_preset(
        tmp_path,
        'triangles = 90\nframe_iterations = 3\nscale = 2\nflow = "none"\n'
        'no-audio = true\nindependent = false\nstyle = ["flat", "edges:width=3"]\nstart = 1.5\n',
    )
    job = build_job(with_preset(parse(), read_preset(preset)))
    assert job.solve.triangulate.refine.triangles == 90
    assert job.solve.triangulate.frame_iterations == 3
    assert job.look.scale == 2.0
    assert isinstance(job.solve.flow, FLOWS["none"])
    assert (job.output.encode.audio, job.solve.independent) == (False, False)
    assert job.look.styles == (STYLES["flat"](), STYLES["edges"](width=3.0))
    assert job.solve.frame_range.start_time == 1.5


def test_command_line_beats_preset(tmp_path: Path) -> None:
    """Given values win, even the default's own; a size drives a preset's scale out."""
    preset = read_preset(write_preset(tmp_path, 'triangles = 90\nscale = 2\nstyle = "edges"'))
    job = build_job(with_preset(parse("--triangles", "1500", "--size", "8x6"), preset))
    assert job.solve.triangulate.refine.triangles == 1500
    assert (job.look.output_size, job.look.scale) == ((8, 6), None)
    assert job.look.styles == (STYLES["edges"](),)
    styled = build_job(with_preset(parse("--style", "flat"), preset))
    assert styled.look.styles == (STYLES["flat"](),)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("trianglez = 3", ["trianglez", "triangles"]),
        ("[more]\ntriangles = 3", ["more"]),
        ("triangles = 3.5", ["3.5", "whole number"]),
        ("triangles = true", ["triangles = true", "number"]),
        ("independent = 1", ["independent", "true or false"]),
        ("style = [[1]]", ["style"]),
        ("size = 'big'", ["big", "WxH"]),
        ("color = 'pink'", ["pink", "constant"]),
        ("scale = nan", ["nan"]),
        ("triangles = ", ["TOML"]),
        ("scale = 2\nsize = '8x6'", ["--size", "--scale"]),
        ("preset = 'fine'", ["preset"]),
    ],
)
def test_bad_preset_is_an_error(text: str, words: list[str], tmp_path: Path) -> None:
    """One line that names the key, the value and what is allowed."""
    with pytest.raises(OptionError) as caught:
        build_job(with_preset(parse(), read_preset(write_preset(tmp_path, text))))
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(("flag", "name", "registry"), MEMBERS, ids=[m[1] for m in MEMBERS])
def test_member_by_name_and_by_its_own_defaults(flag: str, name: str, registry: dict) -> None:
    """The name alone gives the defaults; writing every default out gives the same."""
    plain = registry[name]()
    assert type(parse_member(flag, name, registry)) is type(plain)
    pairs = [
        f"{field.name}={getattr(plain, field.name)}"
        for field in dataclasses.fields(plain)
        if getattr(plain, field.name) is not None
    ]
    spelled = parse_member(flag, ":".join([name, *filter(None, [",".join(pairs)])]), registry)
    for field in dataclasses.fields(plain):
        assert getattr(spelled, field.name) == getattr(plain, field.name)


@pytest.mark.parametrize(("flag", "name", "registry"), MEMBERS, ids=[m[1] for m in MEMBERS])
def test_unknown_parameter_lists_what_is_allowed(flag: str, name: str, registry: dict) -> None:
    """The message names the parameter and all that exist."""
    with pytest.raises(OptionError) as caught:
        parse_member(flag, f"{name}:nonsense=1", registry)
    assert "'nonsense'" in str(caught.value)
    for field in dataclasses.fields(registry[name]):
        assert field.name in str(caught.value)


def test_mistyped_preset_is_told_the_near_one() -> None:
    """Of those that come with the program."""
    with pytest.raises(OptionError, match=r"did you mean fine\? Else give a TOML file or one of"):
        read_preset("fin")


@pytest.mark.parametrize(
    ("key", "remedy"), [("trangles", "did you mean triangles?"), ("zzz", "trimotion help")]
)
def test_an_unknown_key_of_a_preset_is_told_the_near_one(
    key: str, remedy: str, tmp_path: Path
) -> None:
    """In place of sixty names."""
    with pytest.raises(OptionError, match=f"unknown option '{key}'; {re.escape(remedy)}"):
        read_preset(write_preset(tmp_path, f"{key} = 3"))


def test_errors_name_a_preset_only_where_it_gave_the_value() -> None:
    """What the command line says itself is told as before."""
    for given, prefix in (({}, "--preset fine: "), ({"triangles": 1}, "")):
        with pytest.raises(OptionError) as failure, blamed({"preset": "fine", **given}):
            raise OptionError("--triangles 1: a picture has two or more; try 1500")
        assert str(failure.value).startswith(f"{prefix}--triangles 1: ")
    with pytest.raises(OptionError) as failure, blamed({"preset": "fine"}):
        raise OptionError("--crf 99: is too much; try --triangles")
    assert str(failure.value).startswith("--crf")


def test_what_a_preset_gives_a_command_in_vain_is_told() -> None:
    """Nothing where all of it counts."""
    assert without_effect("animate", "fine", read_preset("fine")) is None
    told = without_effect("render", "preview", read_preset("preview"))
    assert told is not None
    assert told.endswith("flow, iterations, frame-iterations, triangles")
    assert str(without_effect("solve", "preview", read_preset("preview"))).endswith(" out scale")


def test_message_of_a_member_is_not_doubled() -> None:
    """A member that names itself in its error does so once."""
    with pytest.raises(OptionError) as caught:
        parse_member("--style", "edges:width=99", STYLES)
    assert str(caught.value).count("edges:width=99") == 1


def test_parameters_are_typed() -> None:
    """Whole numbers, texts; spaces and dashes do not matter."""
    flow = parse_member("--flow", "dis:preset=fast, lines=240", FLOWS)
    assert flow == Dis(lines=240, preset="fast")
    assert parse_member("--layout", "importance:even-share=0.5", LAYOUTS).even_share == 0.5


@pytest.mark.parametrize("name", ["map.png", "my map, old=1.png"])
def test_importance_map_is_read_as_grey(name: str, tmp_path: Path) -> None:
    """White is 1; the name may hold what separates parameters."""
    picture = np.zeros((4, 6, 3), np.uint8)
    picture[:, 3:] = 255
    cv2.imwrite(str(tmp_path / name), picture)
    layout = parse_member("--layout", f"importance:{tmp_path / name}", LAYOUTS)
    assert isinstance(layout, Importance)
    np.testing.assert_allclose(layout.importance_map, picture[..., 0] / 255.0, atol=1e-12)


@pytest.mark.parametrize(
    ("stack", "told"),
    [
        ("paper hatching", "hatching hides paper below it; hatching:paper=none lets it through"),
        ("paper hatching:paper=none", None),
        ("circles flat edges", "flat hides circles below it"),
        ("flat paper:color=#fff,blend=multiply", None),
        ("flat texture:cushion", None),
        ("flat gradient:opacity=0.5", None),
        ("hatching", None),
    ],
)
def test_styles_that_cannot_be_seen_are_told(stack: str, told: str | None) -> None:
    """What lies below an opaque one is drawn for nothing."""
    styles = [word for spec in stack.split() for word in ("--style", spec)]
    notes = build_job(parse(*styles)).look.hidden
    assert [note for note in notes if told and told in note] == notes
    assert len(notes) == (told is not None)
