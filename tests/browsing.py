"""A real browser on the editor's page: where things are on it, and what it shows.

Where no Chromium is found tests are skipped, unless FAIL_WITHOUT_CHROMIUM=1.
"""

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, expect, sync_playwright

from pipeline.edit_log.journal import EditJournal
from stages.hand import EDITS
from tests.editing import Served, browser_path

ARGUMENTS = ["--no-sandbox", "--enable-unsafe-swiftshader"]
SIZE = {"width": 1000, "height": 640}
PATIENCE = 60_000
"""A machine may be busy with other tests [ms]."""
SHOTS = os.environ.get("TRIMOTION_SHOTS")
"""Where a person wants the pictures of the page that these tests take, or nothing."""
SETTLED = 500
"""By then what was drawn anew has come [ms]."""
expect.set_options(timeout=PATIENCE)


@contextmanager
def launched() -> Iterator[Browser]:
    """A browser without a window."""
    path = browser_path()
    if path is None:
        absent = "no Chromium on this machine"
        if os.environ.get("FAIL_WITHOUT_CHROMIUM") == "1":
            pytest.fail(f"{absent}, and FAIL_WITHOUT_CHROMIUM=1")
        pytest.skip(absent)
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield found
        found.close()


@contextmanager
def opened_page(browser: Browser, server: Served) -> Iterator[Page]:
    """The page, open, with all earlier edits undone; what it complains of fails."""
    with EditJournal(server.studio.session.path) as journal:
        journal.go_to(0)
    page = browser.new_page(viewport=SIZE)
    page.set_default_timeout(PATIENCE)
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.on("console", lambda told: problems.append(told.text) if told.type == "error" else None)
    page.goto(server.address.url)
    expect(page.locator("#loading")).to_be_hidden()
    page.wait_for_function("() => trimotion.painter.textures.drawn && trimotion.painter.isReady")
    yield page
    page.close()
    assert problems == []


FINDERS = {
    "vertex": """m => {
        for (let v = 0; v < m.vertexCount; v++) {
            const {x, y} = m.at(v);
            if (x > 8 && y > 8 && x < m.width - 8 && y < m.height - 8) return [x, y];
        } }""",
    "edge": """m => {
        const side = (a, b, c) => (b.x-a.x)*(c.y-a.y) - (b.y-a.y)*(c.x-a.x);
        let best = null, most = 0;
        for (let e = 0; e < m.edgeCount; e++) {
            const facing = m.opposite(e).map(v => m.at(v));
            if (facing.length < 2) continue;
            const [a, b] = m.ends(e).map(v => m.at(v)), [c, d] = facing;
            const [one, other] = [side(c, d, a), side(c, d, b)];
            const least = Math.min(Math.abs(one), Math.abs(other));
            if (one * other < 0 && least > most)
                [most, best] = [least, [(a.x + b.x) / 2, (a.y + b.y) / 2]];
        }
        return best; }""",
    "face": """m => {
        let best = null, most = 0;
        for (let t = 0; t < m.triangleCount; t++) {
            const [a, b, c] = m.corners(t).map(v => m.at(v));
            const area = (b.x-a.x)*(c.y-a.y) - (b.y-a.y)*(c.x-a.x);
            if (area > most) [most, best] = [area, [(a.x+b.x+c.x)/3, (a.y+b.y+c.y)/3]];
        }
        return best; }""",
}
"""Places of a mesh to point at, by what is there: far from everything else."""


def place(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where a place of the picture is on the page [px]."""
    found: list[float] = page.evaluate(
        "([x, y]) => { const {left, top} = trimotion.canvas.getBoundingClientRect();"
        " const at = trimotion.camera.toScreen({x, y}); return [at.x + left, at.y + top]; }",
        [x, y],
    )
    return found[0], found[1]


def find(page: Page, what: str) -> Any:
    """A vertex inside, an edge inside that can be flipped, or a triangle, away from others."""
    return page.evaluate(f"() => ({FINDERS[what]})(trimotion.mesh)")


def wait_for_edits(page: Page, count: int) -> None:
    """Wait until the page says how many edits there are."""
    told = {0: "no edits yet", 1: "1 edit, all saved"}.get(count, f"{count} edits, all saved")
    expect(page.locator("#saved")).to_have_text(told)


def log_of(server: Served) -> list[str]:
    """Kinds of the edits in force, as the track has them."""
    with EditJournal(server.studio.session.path) as journal:
        return [EDITS.name_of(type(edit)) for edit in journal.log.edits]


def assert_shows_the_mesh(page: Page, server: Served) -> None:
    """The mesh on the page is that of the session, to the bit."""
    expected = server.studio.session.worked(0).mesh
    page.wait_for_function(  # a flip leaves all but the triangles' corners as they are
        "wanted => String(trimotion.mesh.triangles) === wanted",
        arg=",".join(map(str, expected.triangles.ravel().tolist())),
    )
    found = page.evaluate("() => [...trimotion.mesh.vertices]")
    assert np.array_equal(np.array(found).reshape(-1, 2), expected.vertices)


def shot(page: Page) -> np.ndarray:
    """What is on the page, once all that was asked for is painted, [rows, columns, 3] int64."""
    page.evaluate(
        "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)


def keep(name: str, found: np.ndarray) -> None:
    """Save what a page showed, where a person wants to judge it.

    Args:
        name: Name of the file, without its ending.
        found: What `shot` returned.
    """
    if SHOTS:
        Path(SHOTS).mkdir(parents=True, exist_ok=True)
        Image.fromarray(found.astype(np.uint8)).save(Path(SHOTS) / f"{name}.png")


def keep_page(page: Page, name: str) -> None:
    """Save what the page shows once it is drawn, where a person wants to judge it.

    Args:
        page: The page.
        name: Name of the file, without its ending.
    """
    if SHOTS:
        expect(page.locator("#preparing")).to_be_hidden()
        page.wait_for_timeout(SETTLED)
        keep(name, shot(page))
