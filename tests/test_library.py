"""`import trimotion`: light, complete, and in step with the options of the command line."""

import inspect
import re
import subprocess
import sys
import typing
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from types import NoneType

import pytest

import trimotion
from pipeline.library.keywords import KEYWORDS, PRESET, TAKEN, Name, keyword_of, options_of
from pipeline.library.wording import in_keywords
from pipeline.options.command_line import RANGE_OPTIONS, Option, job_options
from tests.test_cli import USAGE_ERRORS

ROOT = Path(__file__).parents[1]
PUBLIC = {"animate", "solve", "render", "measure", "triangulate"}

# Types of keywords, without None, by the type that an option is declared with.
TYPES = {
    "int": {int},
    "float": {float},
    "seconds": {str, float},
    "bool": {bool},
    "tuple[int, int]": {str, tuple[int, int]},
}

HOMES = {
    "range": "RangeKeywords",
    "triangles": "ShapeKeywords",
    "motion": "AnimatorKeywords",
    "look": "LookKeywords",
    "output": "OutputKeywords",
    "run": "DeviceKeywords",
    "processes": "SolveKeywords",
}
"""Where options of a group belong, unless they are of some functions only."""

# (message of the command line, the same for a program)
MESSAGES = [
    ("--triangles 0: a picture has two or more", "triangles=0: a picture has two or more"),
    ("--size and --scale exclude each other; give one", "size and scale exclude each other"),
    ("too few; ask for --triangles 400 or more", "ask for triangles=400 or more"),
    ("--region my mask.png@5: black there", "regions=my mask.png@5: black there"),
    ("with --independent no triangle outlives", "with independent=True no triangle outlives"),
    ("a.mp4: exists already; --resume or --overwrite", "resume=True or overwrite=True"),
    ("no sound fits; use --no-audio", "use audio=False"),
    ("--resume --frames 3-9: in step", "resume=True frames=3-9: in step"),
    ("the rmse counts errors by --weights; all", "counts errors by weights; all"),
    ("run again with --jobs 1 --debug and report it", "run again with jobs=1 and report it"),
    ("say with --source where it is", "say with source where it is"),
    ("--max-area 1: must be 8 or more", "max_area=1: must be 8 or more"),
    ("a - b -- c: nothing", "a - b -- c: nothing"),
]


def modules_after(statements: str) -> set[str]:
    """Names of the modules that are there after some statements in a new process."""
    code = f"import sys\n{statements}\nprint(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


def test_a_conversion_starts_without_scipy() -> None:
    """It takes as long to import as the first frame of a small picture takes to solve."""
    names = modules_after("import pipeline.loop.animate, pipeline.loop.convert, pipeline.cli")
    assert not {name for name in names if name.split(".")[0] == "scipy"}


def test_import_is_light() -> None:
    """Importing it brings nothing else; looking at a function brings nothing heavy."""
    bare = modules_after("")
    new = modules_after("import trimotion") - bare
    assert not {name for name in new if name.split(".")[0] in ("pipeline", "stages", "typing")}
    looked = modules_after("import trimotion; trimotion.animate, trimotion.TrimotionError")
    assert not looked & {"warp", "numpy", "cv2", "av", "scipy"}


def test_every_public_name_is_there_and_documented() -> None:
    """`__all__`, `dir` and what can be asked for are the same; unknown names are refused."""
    assert set(trimotion.__all__) <= set(dir(trimotion))
    for name in trimotion.__all__:
        assert inspect.getdoc(getattr(trimotion, name))
    assert re.match(r"\d|\(", trimotion.__version__)
    with pytest.raises(AttributeError, match="'nothing'"):
        _ = trimotion.nothing


@pytest.mark.parametrize("function", KEYWORDS)
def test_keywords_are_the_options(function: str) -> None:
    """A new option of the command line has its line in `pipeline/library/keywords.py`."""
    hints = typing.get_type_hints(KEYWORDS[function])
    options = options_of(function)
    preset = {"preset"} if function in PRESET else set()
    advice = f"{KEYWORDS[function].__name__} in pipeline/library/keywords.py"
    missing = options.keys() - hints.keys()
    lines = [f"{name}: {type_of(options[name])} in {home_of(options[name])}" for name in missing]
    assert not missing, f"add to {advice}, or leave out of TAKEN[{function!r}]: {lines}"
    surplus = hints.keys() - options.keys() - preset
    assert not surplus, f"remove from {advice}: {surplus}"
    for keyword, option in options.items():
        assert agrees(hints[keyword], option), f"{keyword} in {advice}: {option.kind}"


def home_of(option: Option) -> str:
    """Where an option most likely belongs."""
    return HOMES.get(option.group, "a class of its own")


def type_of(option: Option) -> str:
    """Type of an option's keyword, as it is written."""
    if option.is_repeatable:
        return "str | Sequence[str]"
    return option.kind


def agrees(hint: object, option: Option) -> bool:
    """Whether a keyword's type is that of its option."""
    if hint is typing.Any:
        return True
    kinds = set(typing.get_args(hint)) or {hint}
    is_optional = option.default is None and option not in RANGE_OPTIONS
    if option.is_repeatable:
        return kinds == {str, Sequence[str]}
    wanted = TYPES.get(option.kind, {str})
    may_be = [wanted, wanted | set(typing.get_args(Name))]
    if option.kind == "Fraction":
        may_be = [{str, float, Fraction}]
    elif option in RANGE_OPTIONS:
        may_be = [{str, int}, {str, float}]
    return (kinds - {NoneType}) in may_be and (NoneType in kinds) == is_optional


def test_every_option_of_a_job_is_a_keyword() -> None:
    """None is lost on its way from the command line, and no two have the same keyword."""
    keywords = [keyword_of(option) for option in job_options()]
    assert len(set(keywords)) == len(keywords)
    assert set(options_of("animate")) == set(keywords)
    assert set(TAKEN) == set(KEYWORDS)


@pytest.mark.parametrize("name", sorted(PUBLIC | {"Animator"}))
def test_help_shows_every_keyword(name: str) -> None:
    """Signatures carry keywords with their defaults, and texts their help, without flags."""
    function = getattr(trimotion, name)
    parameters = inspect.signature(function).parameters
    assert set(options_of(name)) <= set(parameters)
    if name != "measure":
        assert parameters["threads"].default == 0
    described = function.__init__ if isinstance(function, type) else function
    for keyword in options_of(name):
        assert f"    {keyword}: " in described.__doc__
    assert "--" not in described.__doc__


@pytest.mark.parametrize(("text", "wanted"), MESSAGES)
def test_messages_speak_of_keywords(text: str, wanted: str) -> None:
    """Flags become keywords, joined with a value where one follows; twice is as once."""
    assert wanted in in_keywords(text)
    assert in_keywords(in_keywords(text)) == in_keywords(text)


@pytest.mark.parametrize("options", [options for options, _ in USAGE_ERRORS if "=" not in options])
def test_impossible_options_are_told_as_keywords(options: str, tmp_path: Path) -> None:
    """What the command line refuses is refused here, in one line without a flag."""
    flags = {option.flag: option for option in job_options()}
    words = options.split()
    keywords: dict[str, list[str]] = {}
    for flag, value in zip(words[::2], words[1::2], strict=False):
        option = flags.get(flag.removeprefix("--"))
        keywords.setdefault(keyword_of(option) if option else flag.lstrip("-"), []).append(value)
    if not keywords or {"progress"} & keywords.keys():
        pytest.skip("no option of a function")
    values = {k: v if len(v) > 1 else v[0] for k, v in keywords.items()}
    with pytest.raises(trimotion.OptionError) as caught:
        trimotion.animate("in.mp4", tmp_path / "out.mp4", **values)
    text = str(caught.value)
    assert "\n" not in text
    assert not re.search(r"--[a-z]", text)


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"trianglez": 3}, ["trianglez", "animate", "did you mean triangles?"]),
        ({"style": "flat"}, ["style", "did you mean styles?"]),
        ({"quiet": True}, ["quiet", "progress", "leave it out"]),
        ({"no_audio": True}, ["did you mean audio?"]),
        ({"qqqqqq": 1}, ["qqqqqq", "there are frames,", "preset"]),
        ({"audio": "no"}, ["audio='no'", "True or False"]),
        ({"audio": Path("a.ogg")}, ["audio='a.ogg'", "audio_mode='a.ogg'"]),
        ({"triangles": True}, ["triangles=True"]),
        ({"triangles": [1]}, ["triangles=[1]"]),
        ({"triangles": 2.5}, ["triangles", "2.5", "whole number"]),
        ({"styles": [["flat"]]}, ["styles"]),
        ({"size": (3.5, 2)}, ["size"]),
        ({"size": (1, 2, 3)}, ["size"]),
        ({"weights": object()}, ["weights"]),
        ({"preset": 3}, ["preset", "name of a file"]),
        ({"progress": "loud"}, ["progress='loud'", "function"]),
    ],
)
def test_wrong_keyword_or_kind(keywords: dict, words: list[str]) -> None:
    """The message names the keyword and what it may be."""
    with pytest.raises(trimotion.OptionError) as caught:
        trimotion.animate("in.mp4", "out.mp4", **keywords)
    for word in words:
        assert word in str(caught.value)


def test_keyword_of_another_function() -> None:
    """Looks do not belong to a track: the message says who has them."""
    with pytest.raises(trimotion.OptionError, match="styles: solve has no such option, only"):
        trimotion.solve("in.mp4", "out.mtrk", styles="flat")  # type: ignore[call-arg]


@pytest.mark.parametrize("source", ["", 3, b"in.mp4", None])
def test_name_of_a_file_is_checked(source: object) -> None:
    """Empty names and other things are refused before anything is opened."""
    with pytest.raises(trimotion.OptionError, match="source"):
        trimotion.animate(source, "out.mp4")  # type: ignore[arg-type]


def test_module_is_the_command() -> None:
    """`python -m trimotion` does what `trimotion` does."""
    done = subprocess.run(
        [sys.executable, "-m", "trimotion", "--version"], cwd=ROOT, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout.split()[0]) == (0, "trimotion")
