"""README and the pages of docs/: links, pictures, options, commands and figures hold."""

import argparse
import re
import shlex
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from pipeline.commands.grammar import OneLineParser, build_parser

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "benchmarks"))

import doc_commands  # noqa: E402
import readme_figures  # noqa: E402
import readme_pictures  # noqa: E402
import style_tables  # noqa: E402

README = ROOT / "README.md"
OPTIONS = ROOT / "docs" / "options.md"
MOST_LINES = 250
"""README sells and starts; everything else is a page of docs/."""
PAGES = doc_commands.pages()
LINKED = [
    *PAGES,
    *(ROOT / name for name in ("CHANGELOG.md", "sample_videos/README.md")),
    ROOT / "stages/focus/models/README.md",
]
PICTURE_ENDINGS = {".jpg", ".png", ".gif"}


@cache
def prose(page: Path) -> str:
    """A page without its blocks of code and its comments."""
    text = re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)


@cache
def anchors(page: Path) -> set[str]:
    """What can be pointed at in a page: its headings, as GitHub names them."""
    headings = re.findall(r"^#+ (.*)$", prose(page), flags=re.MULTILINE)
    plain = (re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", one.lower()).strip().replace(" ", "-") for one in plain}


def targets(page: Path) -> Iterator[tuple[Path, str]]:
    """Files of this repository that a page points at, each with the anchor or ''."""
    without_code = re.sub(r"`[^`\n]*`", "", prose(page))
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code):
        if not re.match(r"[a-z]+:", target):
            name, _, anchor = target.partition("#")
            yield (page.parent / name).resolve() if name else page, anchor


def relative(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("page", LINKED, ids=relative)
def test_links_lead_somewhere(page: Path) -> None:
    broken = [
        f"{relative(target)}#{anchor}" if anchor else str(target)
        for target, anchor in targets(page)
        if not target.exists() or (anchor and anchor not in anchors(target))
    ]
    assert not broken


def test_every_page_is_reached_from_readme() -> None:
    reached, waiting = set(), [README]
    while waiting:
        page = waiting.pop()
        if page not in reached:
            reached.add(page)
            waiting += [other for other, _ in targets(page) if other in PAGES]
    assert sorted(map(relative, set(PAGES) - reached)) == []


def test_every_picture_is_shown() -> None:
    shown = {target for page in PAGES for target, _ in targets(page)}
    pictures = {path for path in (ROOT / "docs").rglob("*") if path.suffix in PICTURE_ENDINGS}
    assert sorted(map(relative, pictures - shown)) == []


def test_readme_stays_short() -> None:
    assert len(README.read_text("utf-8").splitlines()) < MOST_LINES


def parsers() -> list[OneLineParser]:
    """The program's parser and those of its commands."""
    parser = build_parser()
    return [parser, *parser.commands().values()]


def test_every_option_is_told_of() -> None:
    text = "\n".join(page.read_text("utf-8") for page in PAGES)
    told = set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", text))
    options = {
        option
        for parser in parsers()
        for action in parser.options()
        if action.help != argparse.SUPPRESS
        for option in action.option_strings
        if option.startswith("--")
    }
    assert sorted(options - told) == []


def test_options_have_the_defaults_that_their_page_says() -> None:
    """The help says `(default: 1500)`; the row of the option in docs/options.md ends with that."""
    rows = re.findall(r"^\| (`--.*?) \| .* \| (.*?) \|$", prose(OPTIONS), flags=re.MULTILINE)
    said = {flag: last for flags, last in rows for flag in re.findall(r"--[\w-]+", flags)}
    differing = {
        option: default[1]
        for parser in parsers()
        for action in parser.options()
        for option in action.option_strings
        if (default := re.search(r"\(default: ([\w.]+)\)", action.help or ""))
        and option in said
        and not re.search(rf"(?<![\w.]){re.escape(default[1])}(?![\w.])", said[option])
    }
    assert differing == {}


@pytest.mark.parametrize("page", PAGES, ids=relative)
def test_commands_are_commands(page: Path) -> None:
    """What stands in blocks of `sh` is understood as it stands."""
    parser = build_parser()
    for command in doc_commands.commands_of(page):
        if command.startswith("trimotion "):
            parser.parse_args(shlex.split(command)[1:])


def test_commands_write_into_out_and_can_be_run_again() -> None:
    """Nothing is left beside `out/`, and nobody is told that an output exists already."""
    for command in (line for page in PAGES for line in doc_commands.shown_by(page)):
        written = doc_commands.written_by(command)
        if command.startswith("trimotion ") and written:
            assert written.startswith("out/"), command
            assert "--overwrite" in command or "--resume" in command, command


def test_styles_are_told_of_as_the_registry_has_them() -> None:
    for page, moves in ((style_tables.PAGE, False), (style_tables.MOVES_PAGE, True)):
        text = page.read_text("utf-8")
        assert style_tables.renewed(text, moves) == text, "run benchmarks/style_tables.py --write"


def assert_can_be_made(file: str) -> None:
    """A command writes it, and others all that this one reads."""
    for other in doc_commands.read_by(doc_commands.command_for(file)):
        assert_can_be_made(other)


@pytest.mark.parametrize("page", PAGES, ids=relative)
def test_figures_name_files_that_a_command_makes(page: Path) -> None:
    figures = list(readme_figures.figures(page))
    assert len(figures) == len(re.findall(r"<!--[^>]*within", page.read_text("utf-8")))
    for figure in figures:
        assert figure.what in {*readme_figures.TOLD, *readme_figures.MEASURED}
        for file in figure.files:
            assert_can_be_made(file)


def test_pictures_are_made_by_commands_of_the_pages() -> None:
    """Those of docs/images but a few, and each from files that a page's command writes."""
    painted = {
        "face_weights",
        "rabbit",
        "relief",
        "editor",
        "editor_texture",
    }  # two by own programs
    drawn = {*readme_pictures.PICTURES, *readme_pictures.COPIED}
    assert drawn == {path.stem for path in readme_pictures.IMAGES.iterdir()} - painted
    for picture in readme_pictures.PICTURES.values():
        for file in {file for row in picture.rows for file, _ in row if file.startswith("out/")}:
            assert_can_be_made(file)
    for file in readme_pictures.COPIED.values():
        assert_can_be_made(file)
