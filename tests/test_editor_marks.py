"""What the editor's page gives to parts of the picture: textures, styles, focus, pins."""

import base64
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from pipeline.edit_log.journal import EditJournal
from pipeline.editor.bench.sketch import SIDE, Sketch, drawing_of, embedded_drawing, keep_drawing
from stages.hand.regions.texture_region import TextureRegion
from stages.masks.gray import read_gray
from stages.media.embedded import read_embedded
from tests.browsing import find, keep, keep_page, log_of, place, shot, wait_for_edits
from tests.editing import Served
from warp_kernels.errors import OptionError

CHANGE = 20
"""By so much one sees that something is drawn [code values]."""


def seen(page: Page, name: str, *others: np.ndarray) -> np.ndarray:
    """The picture's part of the page; waited for until it differs from others and stays."""
    box = page.locator("#stage").bounding_box()
    assert box is not None
    rows = slice(int(box["y"]), int(box["y"] + box["height"]))
    columns = slice(int(box["x"]), int(box["x"] + box["width"]))
    last = None
    for _ in range(300):
        expect(page.locator("#preparing")).to_be_hidden()
        found = shot(page)
        stays = last is not None and np.abs(found - last)[rows, columns].max() <= CHANGE
        if stays and all(np.abs(found[rows, columns] - other).max() > CHANGE for other in others):
            break
        last = found
        page.wait_for_timeout(50 if others else 250)
    keep(name, found)
    return found[rows, columns]


def around(page: Page, x: float, y: float) -> tuple[slice, slice]:
    """The surroundings of a place of the picture in what `seen` returns."""
    box = page.locator("#stage").bounding_box()
    assert box is not None
    left, top = place(page, x, y)
    column, row = int(left - box["x"]), int(top - box["y"])
    return np.s_[row - 25 : row + 25, column - 25 : column + 25]


def hide_mesh(page: Page) -> None:
    """Leave the drawn picture alone on the stage, and the pointer away from it."""
    page.evaluate("() => trimotion.setOpacity('mesh', 0)")


def scribble(page: Page) -> None:
    """Draw a dark line across the texture's canvas, with the mouse."""
    page.locator("#texture").scroll_into_view_if_needed()
    sheet = page.locator("#texture").bounding_box()
    assert sheet is not None
    page.mouse.move(sheet["x"] + 20, sheet["y"] + 170)
    page.mouse.down()
    page.mouse.move(sheet["x"] + 180, sheet["y"] + 170, steps=4)
    page.mouse.up()


def drag_around(page: Page, corners: list[tuple[float, float]]) -> None:
    """Draw a region in one go."""
    page.mouse.move(*place(page, *corners[0]))
    page.mouse.down()
    for corner in corners[1:]:
        page.mouse.move(*place(page, *corner))
    page.mouse.up()


REGION = [(20.0, 12.0), (76.0, 12.0), (76.0, 52.0), (20.0, 52.0)]


def test_a_texture_is_drawn_seen_and_given_to_a_region(page: Page, server: Served) -> None:
    """The canvas: all triangles show it at once; then those of a region keep it; undo."""
    hide_mesh(page)
    plain = seen(page, "plain")
    page.locator("#texture-panel summary").click()
    scribble(page)
    expect(page.locator("#texture-show")).to_have_attribute("aria-pressed", "true")
    everywhere = seen(page, "texture_everywhere", plain)
    page.locator("#set-region").select_option("texture")
    drag_around(page, REGION)
    wait_for_edits(page, 1)
    expect(page.locator("#texture-show")).to_have_attribute("aria-pressed", "false")
    page.mouse.move(5, 5)
    here = seen(page, "texture_region", everywhere, plain)
    inside, outside = around(page, 48, 32), around(page, 5, 5)
    assert np.abs(here[inside] - plain[inside]).max() > CHANGE
    assert np.abs(here[outside] - plain[outside]).max() <= CHANGE
    with EditJournal(server.studio.session.path) as journal:
        (edit,) = journal.log.edits
    assert isinstance(edit, TextureRegion)
    assert read_embedded(edit.file).shape == (SIDE, SIDE, 3)
    page.keyboard.press("Control+z")
    wait_for_edits(page, 0)
    assert np.abs(seen(page, "undone", here) - plain)[inside].max() <= CHANGE


def test_a_texture_turns_with_the_base_edge(page: Page, server: Served) -> None:
    """Shift and a click: what lay along one edge of the triangle lies along another."""
    hide_mesh(page)
    plain = seen(page, "turn_plain")
    page.locator("#texture-panel summary").click()
    scribble(page)
    before = seen(page, "turn_before", plain)
    face = find(page, "face")
    page.keyboard.down("Shift")
    page.mouse.click(*place(page, *face))
    page.keyboard.up("Shift")
    wait_for_edits(page, 1)
    assert log_of(server) == ["turn_base_edge"]
    page.mouse.move(5, 5)
    after = seen(page, "turn_done", before)
    inside, outside = around(page, *face), around(page, 5, 5)
    assert np.abs(after[inside] - before[inside]).max() > CHANGE
    assert np.abs(after[outside] - before[outside]).max() <= CHANGE


def test_a_texture_is_drawn_by_keys_and_seen_over_regions(page: Page, server: Served) -> None:
    """Arrows lead the pen; what is drawn lies over regions that have a texture already."""
    hide_mesh(page)
    page.locator("#texture-panel summary").click()
    page.locator("#set-texture-name").select_option("cushion")
    page.locator("#set-region").select_option("texture")
    drag_around(page, REGION)
    wait_for_edits(page, 1)
    page.locator("#set-texture-name").select_option("drawn here")
    page.locator("#texture-clear").click()
    page.mouse.move(5, 5)
    painted = seen(page, "before_the_pen")
    page.locator("#texture").focus()
    for key in ("Enter", *["ArrowDown"] * 12, *["ArrowRight"] * 6, "Enter", "ArrowUp"):
        page.keyboard.press(key)
    inside = around(page, 48, 32)
    for _ in range(40):  # on a busy machine what was asked for before is shown first
        found = seen(page, "pen_by_keys")
        if np.abs(found[inside] - painted[inside]).max() > CHANGE:
            break
        page.wait_for_timeout(250)
    else:
        raise AssertionError("the pen's line is not seen")
    dark = page.evaluate(
        "() => [...document.querySelector('#texture').getContext('2d')"
        ".getImageData(128, 180, 1, 1).data]"
    )
    assert dark[0] < 64
    assert log_of(server) == ["texture_region"]


def test_a_texture_is_painted_and_laid_over_the_film(page: Page, server: Served) -> None:
    page.locator("#texture-panel summary").click()
    page.locator("#set-texture-name").select_option("cushion")
    page.locator("#set-paints").select_option("texture")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 1)
    assert log_of(server) == ["texture_region"]
    page.keyboard.press("Control+z")  # fewer kinds of stacks are compiled so
    page.locator("#set-texture-name").select_option("drawn here")
    scribble(page)
    page.locator("#texture-use").click()
    expect(page.locator("#command-render")).to_contain_text("--style texture:file=")


REGIONS = [
    ("style", "style_region"),
    ("focus", "set_focus"),
    ("lock vertices", "lock"),
    ("unlock vertices", "unlock"),
    ("lock edges", "lock"),
    ("unlock edges", "unlock"),
    ("retriangulate", "retriangulate"),
]


def test_a_region_gets_what_the_panel_says(page: Page, server: Served) -> None:
    """Dragged around; each is one edit, and pins are seen in the mesh."""
    page.keyboard.press("r")
    page.locator("#set-paint").select_option("texture")  # whose kernels there are already
    held = "() => trimotion.mesh.held.reduce((sum, one) => sum + one, 0)"
    for count, (what, kind) in enumerate(REGIONS, start=1):
        page.locator("#set-region").select_option(what)
        drag_around(page, REGION)
        wait_for_edits(page, count)
        assert log_of(server)[-1] == kind
        keep_page(page, f"region_{what.replace(' ', '_')}")
        if what == "lock vertices":
            page.wait_for_function(f"() => ({held})() > 0")
        if what == "unlock vertices":
            page.wait_for_function(f"() => ({held})() === 0")


def test_a_region_is_drawn_by_clicks_and_by_keys(page: Page, server: Served) -> None:
    """Corner by corner; the first one again closes it; Esc begins anew."""
    page.locator("#set-region").select_option("lock vertices")
    page.mouse.click(*place(page, *REGION[0]))
    page.keyboard.press("Escape")
    for corner in (*REGION, REGION[0]):
        page.mouse.click(*place(page, *corner))
    wait_for_edits(page, 1)
    page.locator("#set-region").select_option("focus")
    page.locator("#stage").focus()
    for key in ("Enter", *["ArrowRight"] * 4, "Enter", *["ArrowDown"] * 4, "Enter"):
        page.keyboard.press(key)
    for key in (*["ArrowLeft"] * 4, *["ArrowUp"] * 4, "Enter"):
        page.keyboard.press(key)
    wait_for_edits(page, 2)
    assert log_of(server) == ["lock", "set_focus"]


def test_focus_is_painted_and_seen(page: Page, server: Served) -> None:
    """Blue at once, before anything is optimised; it can be hidden, and goes when it is undone."""
    page.locator("#set-paints").select_option("focus")
    page.evaluate("() => trimotion.setBrush({radius: 12})")
    page.mouse.move(5, 5)
    plain = seen(page, "focus_before")
    spots = [(30.0, 26.0), (40.0, 30.0), (50.0, 34.0)]
    for count, spot in enumerate(spots, start=1):
        page.mouse.click(*place(page, *spot))
        wait_for_edits(page, count)
    page.locator("#set-region").select_option("focus")
    page.evaluate("() => trimotion.marks.focus = 4")
    drag_around(page, [(62.0, 20.0), (88.0, 24.0), (80.0, 50.0), (64.0, 44.0)])
    wait_for_edits(page, 4)
    page.mouse.move(5, 5)
    painted = seen(page, "focus_painted", plain)
    (spot, edge), off = (around(page, *at) for at in ((40, 30), (76, 36))), around(page, 8, 56)
    for place_of_it in (spot, edge):
        bluer = (painted - plain)[place_of_it].mean(axis=(0, 1)) * (-1, 0, 1)
        assert bluer.sum() > CHANGE
    assert np.abs(painted - plain)[off].max() <= CHANGE
    page.locator("#set-painted").fill("0")
    assert np.abs(seen(page, "focus_hidden") - plain).max() <= CHANGE
    page.locator("#set-painted").fill("0.6")
    page.keyboard.press("Control+z")
    wait_for_edits(page, 3)
    fewer = seen(page, "focus_undone", painted)
    assert np.abs(fewer - plain)[edge].max() <= CHANGE
    assert np.abs(fewer - painted)[spot].max() <= CHANGE
    page.reload()
    expect(page.locator("#loading")).to_be_hidden()
    page.wait_for_function("() => trimotion.painter.textures.painted")
    assert log_of(server) == ["set_focus"] * 3


def test_a_drawing_is_kept_once(tmp_path: Path) -> None:
    """What is kept is what was drawn; another drawing is another file; nonsense is refused."""
    drawing = bytes(range(256)) * SIDE
    assert drawing_of(base64.b64encode(drawing).decode()) == drawing
    kept = keep_drawing(drawing, tmp_path / "job.mtrk")
    assert keep_drawing(drawing, tmp_path / "job.mtrk") == kept
    assert keep_drawing(drawing[::-1], tmp_path / "job.mtrk") != kept
    gray = np.asarray(Image.open(kept).convert("L"))
    inside = embedded_drawing(drawing)
    assert np.array_equal(read_gray(inside), read_gray(str(kept)))
    for broken in (inside[:60], inside[:-9] + "*", inside.replace("iVBOR", "AAAAA")):
        with pytest.raises(OptionError, match="no PNG"):
            read_gray(broken)
    assert gray.tobytes() == drawing
    read = Sketch(file=str(kept)).texture(lambda _: gray / 255.0)
    drawn = Sketch(file="drawing", drawing=drawing).texture(lambda _: np.empty(0))
    assert read is not None
    assert drawn is not None
    assert np.array_equal(drawn.levels[0], read.levels[0])
    for text in ("", "AAAA", "*" * 87384):
        with pytest.raises(OptionError, match="256 x 256"):
            drawing_of(text)
