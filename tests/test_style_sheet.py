"""The command `styles`: a list that holds everything, and a sheet that shows everything."""

import dataclasses
import json
from functools import partial
from pathlib import Path

import cv2
import numpy as np

from pipeline.cli import main
from pipeline.commands.styles.style_sheet import COLUMNS, OVER, WIDTH, draw_sheet
from pipeline.options.members import parse_member
from stages.look.sheet import CAPTION, GAP, sheet_of
from stages.moves import MOVES
from tests.golden_images import write_png
from tests.kernel_samples import waves
from warp_kernels.styles import STYLES


def test_list_holds_every_style_and_parameter(capsys) -> None:
    """With defaults; a parameter that has a range or choices says so."""
    assert main(["styles"]) == 0
    text = capsys.readouterr().out
    assert main(["styles", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert list(facts) == [*STYLES, "--move"]
    assert list(facts["--move"]) == list(MOVES)
    for name, style in STYLES.items():
        assert f"\n{name}  " in text
        assert facts[name]["summary"]
        listed = {parameter["name"]: parameter for parameter in facts[name]["parameters"]}
        for field in dataclasses.fields(style):
            assert listed[field.name]["default"] == field.default
            assert field.metadata["help"] in text
            if isinstance(field.default, float):
                assert len(listed[field.name]["range"]) == 2


def test_every_style_has_a_portrait_that_can_be_drawn() -> None:
    """Stacks of registered styles, the style itself among them."""
    for name, style in STYLES.items():
        for stack in style.portraits or (name,):
            specs = stack.split(OVER)
            assert style in [type(parse_member("--style", spec, STYLES)) for spec in specs]


def test_sheet_is_written(tmp_path: Path, capsys) -> None:
    """One cell a portrait; an existing sheet is not replaced unless that is wanted."""
    picture, sheet = tmp_path / "in.png", tmp_path / "sheet.png"
    write_png(picture, waves(48, 32))
    few = partial(draw_sheet, str(picture), str(sheet), triangles=30)
    few(names=("circles", "flat", "paper"))
    height = round(WIDTH * 32 / 48)
    columns = COLUMNS * (WIDTH + GAP) + GAP
    assert cv2.imread(str(sheet)).shape == (GAP + height + CAPTION + GAP, columns, 3)
    assert main(["styles", str(picture), "--sheet", str(sheet)]) == 4
    assert "exists already" in capsys.readouterr().err
    few(names=("flat",), overwrite=True)
    assert cv2.imread(str(sheet)).shape == (GAP + height + CAPTION + GAP, columns, 3)


def test_captions_stay_below_their_picture() -> None:
    """However long they are."""
    pictures = [np.full((40, 60, 3), 90, np.uint8)] * 3
    sheet = sheet_of(pictures, ["a", "a very long caption " * 9, "c"], 2)
    for top in (GAP, GAP + 40 + CAPTION + GAP):
        assert (sheet[top : top + 40, GAP : GAP + 60] == 90).all()
    between = sheet[:, GAP + 60 : 2 * GAP + 60]
    assert (between == 255).mean() > 0.97
    assert (sheet[GAP + 40 : GAP + 40 + CAPTION, GAP : GAP + 60] < 128).any()
