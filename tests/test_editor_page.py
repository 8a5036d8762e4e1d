"""The editor's page in a real browser: hands, keys, what is shown and what is saved."""

import re
from collections.abc import Iterator
from dataclasses import fields

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from pipeline.edit_log.journal import EditJournal
from tests.browsing import (
    PATIENCE,
    SIZE,
    assert_shows_the_mesh,
    find,
    keep_page,
    log_of,
    place,
    shot,
    wait_for_edits,
)
from tests.editing import Served, served, write_clip_job
from warp_kernels.styles import STYLES


@pytest.fixture(scope="module")
def clip_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server with a clip of two shots."""
    with served(write_clip_job(tmp_path_factory.mktemp("film"))) as found:
        yield found


CLICKS = [
    ("edge", "left", [], "split_edge"),
    ("face", "left", [], "split_triangle"),
    ("vertex", "right", [], "collapse_vertex"),
    ("edge", "right", [], "flip_edge"),
    ("face", "left", ["Shift"], "turn_base_edge"),
]


def test_the_mouse_of_the_paper(page: Page, server: Served) -> None:
    """Each click is one edit of the log, shown, undone and done again."""
    for count, (what, button, modifiers, kind) in enumerate(CLICKS, start=1):
        x, y = place(page, *find(page, what))
        page.mouse.move(x, y)
        page.keyboard.down("Shift") if modifiers else None
        keep_page(page, f"{count}_{kind}_before")
        page.mouse.click(x, y, button=button)
        page.keyboard.up("Shift") if modifiers else None
        wait_for_edits(page, count)
        assert log_of(server)[-1] == kind
        assert_shows_the_mesh(page, server)
        keep_page(page, f"{count}_{kind}_done")
    page.keyboard.press("Control+z")
    wait_for_edits(page, 4)
    keep_page(page, "6_undone")
    page.locator("#undo").click()
    wait_for_edits(page, 3)
    page.keyboard.press("Control+Shift+z")
    wait_for_edits(page, 4)
    page.keyboard.press("Control+z")
    wait_for_edits(page, 3)
    page.keyboard.press("Control+y")
    wait_for_edits(page, 4)
    assert log_of(server) == [kind for *_, kind in CLICKS[:4]]
    keep_page(page, "7_undone_twice_and_done_again")
    assert_shows_the_mesh(page, server)


def test_a_vertex_is_dragged_and_typed(page: Page, server: Served) -> None:
    """By hand, and by G with numbers; Shift makes a tenth of the way; Esc leaves it."""
    x, y = find(page, "vertex")
    (left, top), (right, bottom) = place(page, x, y), place(page, x + 2, y + 1)
    page.mouse.move(left, top)
    page.mouse.down()
    keep_page(page, "move_before")
    page.mouse.move((left + right) / 2, (top + bottom) / 2)
    page.mouse.move(right, bottom)
    assert "put the vertex here" in page.locator("#hint").inner_text()
    keep_page(page, "move_on_the_way")
    page.mouse.up()
    wait_for_edits(page, 1)
    keep_page(page, "move_done")
    with EditJournal(server.studio.session.path) as journal:
        (moved,) = journal.log.edits
    assert np.allclose(np.array(moved.to) - moved.at, (2, 1), atol=1e-6)  # type: ignore[attr-defined]
    page.keyboard.press("g")
    page.keyboard.type("-1.5, 0.25")
    page.keyboard.press("Enter")
    wait_for_edits(page, 2)
    with EditJournal(server.studio.session.path) as journal:
        typed = journal.log.edits[-1]
    assert np.allclose(np.array(typed.to) - typed.at, (-1.5, 0.25))  # type: ignore[attr-defined]
    page.keyboard.press("g")
    page.keyboard.press("Escape")
    assert log_of(server) == ["move_vertex", "move_vertex"]


def test_the_brush_shows_what_it_does(page: Page, server: Served) -> None:
    """Dots come before the click, and the vertices are where they were; right takes away."""
    page.keyboard.press("b")
    page.locator("#set-count").fill("5")
    page.locator("#set-radius").fill("15")
    page.mouse.move(*place(page, 48, 32))
    page.wait_for_function("() => trimotion.ghost?.fresh.length > 0")
    ghost = page.evaluate("() => trimotion.ghost.fresh.map(p => [p.x, p.y])")
    keep_page(page, "brush_preview")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 1)
    keep_page(page, "brush_inserted")
    mesh = server.studio.session.worked(0).mesh
    assert {tuple(at) for at in ghost} <= {tuple(at) for at in mesh.vertices.tolist()}
    page.mouse.click(*place(page, 48, 32), button="right")
    wait_for_edits(page, 2)
    keep_page(page, "brush_removed")
    assert log_of(server) == ["insert", "remove"]
    page.mouse.wheel(0, -240)
    page.wait_for_function("() => trimotion.brush.radius > 15")
    page.keyboard.press("o")
    expect(page.locator("#set-spread")).to_have_value("normal")
    page.mouse.move(*place(page, 50, 30))
    keep_page(page, "brush_preview_normal")


def test_a_region_is_triangulated_anew_and_pinned(page: Page, server: Served) -> None:
    page.keyboard.press("r")
    keep_page(page, "retriangulate_before")
    page.mouse.move(*place(page, 20, 15))
    page.mouse.down()
    for x, y in ((75, 15), (75, 50), (20, 50)):
        page.mouse.move(*place(page, x, y))
    keep_page(page, "retriangulate_drawn")
    page.mouse.up()
    wait_for_edits(page, 1)
    keep_page(page, "retriangulate_done")
    page.keyboard.press("a")
    page.mouse.move(*place(page, *find(page, "vertex")))
    page.keyboard.press("p")
    page.mouse.click(*place(page, *find(page, "vertex")))
    wait_for_edits(page, 2)
    assert log_of(server)[0] == "retriangulate"
    assert log_of(server)[1] in ("lock", "unlock")
    keep_page(page, "pinned")


def test_what_cannot_be_done_is_told_in_one_line(page: Page, server: Served) -> None:
    page.mouse.click(*place(page, 0.2, 0.2), button="right")
    expect(page.locator("#toast")).to_contain_text("corner of the picture")
    assert log_of(server) == []


def test_keys_alone_reach_the_picture(page: Page, server: Served) -> None:
    """The cursor moves by arrows, Enter splits, X collapses, J flips, Tab hides the mesh."""
    page.locator("#stage").focus()
    for key in ("ArrowRight", "ArrowDown", "Shift+ArrowLeft", "f", "Enter"):
        page.keyboard.press(key)
    wait_for_edits(page, 1)
    page.keyboard.press("x")
    wait_for_edits(page, 2)
    assert log_of(server) == ["split_triangle", "collapse_vertex"]
    page.keyboard.press("Tab")
    page.wait_for_function("() => trimotion.opacities.mesh === 0")
    page.keyboard.press("?")
    expect(page.locator("#keys")).to_be_visible()
    assert "flip the edge" in page.locator("#keys").inner_text()
    page.keyboard.press("Escape")
    expect(page.locator("#keys")).to_be_hidden()


def test_zoom_leaves_what_is_under_the_pointer(page: Page) -> None:
    x, y = place(page, 30, 20)
    page.mouse.move(x, y)
    page.mouse.wheel(0, -200)
    page.wait_for_function("() => trimotion.camera.zoom > 8")
    assert np.allclose(place(page, 30, 20), (x, y), atol=1)
    page.mouse.down(button="middle")
    page.mouse.move(x + 40, y - 10)
    page.mouse.up(button="middle")
    assert np.allclose(place(page, 30, 20), (x + 40, y - 10), atol=1)


def test_a_window_of_another_size_shows_the_same(page: Page) -> None:
    """What was seen whole is; and what one looked at stays in the middle."""
    for width, height in ((700, 420), (1300, 900), (1000, 640)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_function("() => trimotion.hasRoom.down === trimotion.canvas.clientHeight")
        box = page.locator("#stage").bounding_box()
        assert box is not None
        (left, top), (right, bottom) = place(page, 0, 0), place(page, 96, 64)
        gaps = (left - box["x"], box["x"] + box["width"] - right)
        gaps += (top - box["y"], box["y"] + box["height"] - bottom)
        assert min(gaps) == pytest.approx(12, abs=1)
        assert gaps[0] == pytest.approx(gaps[1], abs=1)
    page.mouse.move(*place(page, 30, 20))
    page.mouse.wheel(0, -200)
    middle = "() => { const c = trimotion.canvas; return Object.values("
    middle += "trimotion.camera.toPicture({x: c.clientWidth / 2, y: c.clientHeight / 2})); }"
    before = page.evaluate(middle)
    page.set_viewport_size({"width": 700, "height": 420})
    page.wait_for_function("() => trimotion.hasRoom.down === trimotion.canvas.clientHeight")
    assert np.allclose(page.evaluate(middle), before, atol=0.2)


def test_a_reload_and_another_window(page: Page, browser: Browser, server: Served) -> None:
    other = browser.new_page(viewport=SIZE)
    other.goto(server.address.url)
    expect(other.locator("#loading")).to_be_hidden()
    page.mouse.click(*place(page, *find(page, "face")))
    wait_for_edits(other, 1)
    assert_shows_the_mesh(other, server)
    other.close()
    page.reload()
    wait_for_edits(page, 1)
    expect(page.locator("#loading")).to_be_hidden()
    assert_shows_the_mesh(page, server)


def test_all_is_named_for_those_who_do_not_see(page: Page) -> None:
    """Every button and slider has a name, and the picture says how it is used."""
    nameless = page.evaluate(
        """() => [...document.querySelectorAll("button, input, select, canvas:not([aria-hidden])")]
        .filter(e => !(e.textContent.trim() || e.ariaLabel || e.labels?.length))
        .map(e => e.id)"""
    )
    assert nameless == []


def test_the_layers_are_drawn(page: Page) -> None:
    """A screenshot shows the picture, the style over it, or neither."""

    def layers(picture: float, drawn: float) -> np.ndarray:
        page.evaluate(
            "([p, d]) => { trimotion.setOpacity('mesh', 0); trimotion.setOpacity('picture', p);"
            " trimotion.setOpacity('drawn', d); }",
            [picture, drawn],
        )
        return shot(page)

    left, top = place(page, 60, 50)
    spots = np.s_[int(top) - 3 : int(top) + 3, int(left) - 3 : int(left) + 3]
    picture = layers(1, 0)[spots].mean(axis=(0, 1))
    assert np.abs(picture - (60 * 200 / 96, 50 * 200 / 64, 60)).max() < 8
    assert np.abs(layers(1, 1)[spots].mean(axis=(0, 1)) - picture).max() < 60
    assert layers(0, 0)[spots].max() < 40


def test_styles_are_stacked_and_changed(page: Page, server: Served) -> None:
    """The panel is made from the registry; what it says is what the command line says."""
    assert page.locator("#add-style option").count() == 1 + len(STYLES)
    page.locator("#add-style").select_option("edges")
    width = page.locator("#set-style-width")
    expect(width).to_be_visible()
    field = next(f for f in fields(STYLES["edges"]) if f.name == "width")
    assert [float(width.get_attribute(e) or "") for e in ("min", "max")] == [
        *field.metadata["range"]
    ]
    width.fill("3.5")
    command = page.locator("#command-render")
    expect(command).to_contain_text("--style flat --style edges:width=3.5")
    page.locator("[data-style=edges] button").first.focus()
    page.keyboard.press("Alt+ArrowDown")
    expect(command).to_contain_text("--style edges:width=3.5 --style flat")
    page.locator("[data-style=edges]").drag_to(page.locator("[data-style=flat]"))
    expect(command).to_contain_text("--style flat --style edges:width=3.5")
    page.locator("#set-style-color").fill("#zzz")
    page.locator("#set-style-color").press("Enter")
    expect(page.locator("#toast")).to_contain_text("#zzz")


def test_the_optimiser_is_watched(page: Page, server: Served) -> None:
    """Play, pause, step; errors are shown."""
    page.locator("#optimise").click()
    expect(page.locator("#optimiser-told")).to_contain_text(re.compile("step [1-9][0-9]"))
    expect(page.locator("#optimise")).to_have_text("Pause")
    page.locator("#optimise").click()
    expect(page.locator("#optimise")).to_have_text("Play")
    keep_page(page, "optimised")
    page.wait_for_timeout(500)
    before = page.locator("#optimiser-told").inner_text()
    page.keyboard.press(";")
    expect(page.locator("#optimiser-told")).not_to_have_text(before)
    page.locator("#set-errors").fill("1")
    keep_page(page, "errors_shown")


def test_edits_are_made_while_the_optimiser_runs(page: Page, server: Served) -> None:
    """Each is in the log and in the mesh that goes on being optimised; undo begins it anew."""
    told = page.locator("#optimiser-told")
    page.locator("#optimise").click()
    expect(told).to_contain_text(re.compile("step [1-9][0-9]"))
    page.keyboard.press("b")
    page.mouse.move(*place(page, 48, 32))
    page.wait_for_function("() => trimotion.ghost?.fresh.length > 0")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 1)
    page.wait_for_function("() => trimotion.view === 'live' && trimotion.mesh.held.includes(1)")
    steps = int(re.findall("step ([0-9]+)", told.inner_text())[0])
    expect(told).to_contain_text(re.compile(f"step (?!{steps}:)"))
    expect(page.locator("#optimise")).to_have_text("Pause")
    page.keyboard.press("a")
    page.mouse.click(*place(page, *find(page, "face")), button="left")
    wait_for_edits(page, 2)
    page.keyboard.press("Control+z")
    wait_for_edits(page, 1)
    expect(page.locator("#optimise")).to_have_text("Pause")
    page.locator("#optimise").click()
    assert log_of(server) == ["insert"]
    live = server.studio.session.live
    assert live is not None
    assert set(server.studio.session.worked(0).locks.vertices) <= set(live.worked.locks.vertices)


def test_a_style_is_painted_onto_triangles(page: Page, server: Served) -> None:
    page.keyboard.press("t")
    page.locator("#set-radius").fill("12")
    page.locator("#set-paint").select_option("edges")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 1)
    assert log_of(server) == ["style_region"]
    keep_page(page, "style_painted")


def test_a_painted_style_is_set_as_styles_are(page: Page, server: Served) -> None:
    """The same form as in the style panel; another style begins as it usually is."""
    page.keyboard.press("t")
    page.locator("#set-paint").select_option("edges")
    page.locator("#set-paint-width").fill("3.5")
    keep_page(page, "painted_style_form")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 1)
    page.locator("#set-paint").select_option("hatching")
    page.locator("#set-paint").select_option("edges")
    page.mouse.click(*place(page, 48, 32))
    wait_for_edits(page, 2)
    with EditJournal(server.studio.session.path) as journal:
        assert [edit.style for edit in journal.log.edits] == ["edges:width=3.5", "edges"]  # type: ignore[attr-defined]
    keep_page(page, "painted_style_set")


def test_a_small_window_shows_all_words(page: Page) -> None:
    """The header is one line, and nothing of the hint or the figures is cut off."""
    cut = """() => [...document.querySelectorAll("#hint, #facts, #saved, header, footer")]
        .filter(e => e.scrollWidth > e.clientWidth + 1 && e.clientWidth
            || e.scrollHeight > e.clientHeight + 1 && e.clientHeight).map(e => e.id || e.tagName)"""
    for width, height in ((1000, 640), (700, 420)):
        page.set_viewport_size({"width": width, "height": height})
        for key in "abrtp":
            page.keyboard.press(key)
            page.mouse.move(*place(page, 48, 32))
            shot(page)
            assert page.evaluate(cut) == []
            keep_page(page, f"window_{width}_{key}")
        heights = page.evaluate(
            "() => [...document.querySelectorAll('header > :not(.spring)')]"
            ".map(e => e.getBoundingClientRect()).filter(b => b.height).map(b => b.bottom)"
        )
        assert max(heights) < 46


def test_time_and_the_way_through_a_shot(browser: Browser, clip_server: Served) -> None:
    """Seek, edit, apply, compare, play and render: all that one does with a film."""
    page = browser.new_page(viewport=SIZE)
    page.set_default_timeout(PATIENCE)
    page.goto(clip_server.address.url)
    expect(page.locator("#loading")).to_be_hidden()
    strip = page.locator("#strip").bounding_box()
    assert strip is not None
    page.mouse.click(strip["x"] + strip["width"] * 3.5 / 12, strip["y"] + 10)
    page.wait_for_function("() => trimotion.mesh?.frame === 3")
    page.keyboard.press(".")
    page.wait_for_function("() => trimotion.mesh?.frame === 4")
    page.mouse.click(*place(page, *find(page, "face")))
    wait_for_edits(page, 1)
    expect(page.locator("#film-note")).to_contain_text("do not reach through their shots yet")
    page.locator("#apply").click()
    expect(page.locator("#film-note")).to_contain_text("The film follows all of your edits")
    shown = {}
    for view in ("before", "solved"):
        page.locator(f"[data-view={view}]").click()
        page.wait_for_function(f"() => trimotion.view === '{view}' && !trimotion.isLooking")
        shown[view] = page.evaluate("() => trimotion.mesh.held.reduce((sum, one) => sum + one, 0)")
    assert shown == {"before": 0, "solved": 1}
    page.keyboard.press(" ")
    page.wait_for_function("() => !trimotion.isPlaying && trimotion.frame === 11")
    page.locator("#render").click()
    expect(page.locator("#written")).to_contain_text(".mp4")
    expect(page.locator("#written")).to_contain_text(f"{clip_server.studio.session.path.parent}/")
    assert len(list(clip_server.studio.session.path.parent.glob("clip.2*.mp4"))) == 1
    page.close()
