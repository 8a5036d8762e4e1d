"""Edits on their way: what the editor's page shows before the program has answered."""

import random
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from pipeline.edit_log.journal import EditJournal
from tests.browsing import assert_shows_the_mesh, find, log_of, place, wait_for_edits
from tests.editing import Served, opened


def test_a_dropped_vertex_lies_there_at_once(page: Page, server: Served) -> None:
    """What is typed before the program has answered goes on from there, and back if refused."""
    x, y = find(page, "vertex")
    number = page.evaluate("([x, y]) => trimotion.mesh.vertices.indexOf(x) / 2", [x, y])
    with waiting(server) as answers:
        page.mouse.move(*place(page, x, y))
        press_and_type(page, "2, 1")
        assert at(page, number) == [x + 2, y + 1]
        page.mouse.move(*place(page, x + 2, y + 1))
        press_and_type(page, "-1.5, 0.25")
        assert at(page, number) == [x + 0.5, y + 1.25]
        answers.set()
        wait_for_edits(page, 2)
    with EditJournal(server.studio.session.path) as journal:
        first, second = journal.log.edits
    assert second.at == first.to  # type: ignore[attr-defined]
    assert second.to == (x + 0.5, y + 1.25)  # type: ignore[attr-defined]
    assert_shows_the_mesh(page, server)
    with waiting(server) as answers:
        page.mouse.move(*place(page, x + 0.5, y + 1.25))
        press_and_type(page, "0, 90")  # out of the picture
        page.mouse.move(*place(page, x + 0.5, y + 1.25))
        page.keyboard.press("g")  # another one, which is nearest now
        page.keyboard.press("Escape")
        page.keyboard.press("Control+z")  # of what is refused: what was made before it stays
        answers.set()
        expect(page.locator("#toast")).to_contain_text("outside")
    page.wait_for_function("() => !trimotion.underway.errands.length")
    wait_for_edits(page, 2)
    assert at(page, number) == [x + 0.5, y + 1.25]
    assert_shows_the_mesh(page, server)
    with waiting(server) as answers:
        page.mouse.move(*place(page, x + 0.5, y + 1.25))
        press_and_type(page, "60, 0")  # over others
        page.mouse.move(*place(page, x + 60.5, y + 1.25))
        page.keyboard.press("x")  # of the same vertex: it is not there
        answers.set()
        expect(page.locator("#toast")).to_contain_text("what followed was not made either")
    assert log_of(server) == ["move_vertex", "move_vertex"]
    assert_shows_the_mesh(page, server)
    with waiting(server) as answers:
        page.mouse.move(*place(page, x + 0.5, y + 1.25))
        press_and_type(page, "0, -90")
        page.mouse.click(*place(page, *far_from(page, number)))  # what lies elsewhere is made
        answers.set()
        wait_for_edits(page, 3)
    assert_shows_the_mesh(page, server)


def test_a_storm_of_hands_leaves_what_a_replay_makes(
    page: Page, server: Served, tmp_path: Path
) -> None:
    """Clicks, moves, undo and redo faster than answers come, beside the optimiser at work."""
    chance = random.Random(4)
    for number in range(60):
        if number % 15 == 5:
            page.keyboard.press("l")
        x, y = place(page, chance.uniform(4, 92), chance.uniform(4, 60))
        page.mouse.move(x, y)
        match chance.choice(("click", "click", "right", "move", "undo", "redo", "brush")):
            case "click":
                page.mouse.click(x, y)
            case "right":
                page.mouse.click(x, y, button="right")
            case "move":
                press_and_type(page, f"{chance.uniform(-6, 6):.2f}, {chance.uniform(-6, 6):.2f}")
            case "brush":
                page.keyboard.press("b")
                page.mouse.click(x, y)
                page.keyboard.press("a")
            case turn:
                for _ in range(chance.randint(1, 4)):
                    page.keyboard.press("Control+z" if turn == "undo" else "Control+Shift+z")
    page.evaluate("() => void trimotion.underway.done.then(() => trimotion.isCalm = true)")
    page.wait_for_function("() => trimotion.isCalm")
    page.locator("#views button[data-view=edited]").click()
    assert_shows_the_mesh(page, server)
    track = server.studio.session.path
    with EditJournal(track) as journal:
        wait_for_edits(page, len(journal.log.edits))
        assert len(journal.history) > 10
        assert journal.log.edits
    again = opened(Path(shutil.copy(track, tmp_path / "again.mtrk")))
    replayed, shown = again.worked(0), server.studio.session.worked(0)
    again.close()
    for name in ("vertices", "triangles", "vertex_ids", "triangle_ids"):
        assert np.array_equal(getattr(replayed.mesh, name), getattr(shown.mesh, name))
    assert np.array_equal(replayed.locks.vertices, shown.locks.vertices)


@contextmanager
def waiting(server: Served) -> Iterator[threading.Event]:
    """Edits are made once the event is set: a busy machine, for as long as a test likes."""
    session, answers = server.studio.session, threading.Event()
    make = session.make

    def later(*given: Any, **named: Any) -> int:
        assert answers.wait(60)
        return make(*given, **named)

    with pytest.MonkeyPatch.context() as patch:
        # real need: a machine that is busy for as long as one likes
        patch.setattr(session, "make", later)
        yield answers
        answers.set()


def press_and_type(page: Page, way: str) -> None:
    """Take up what is at the pointer, and put it down elsewhere."""
    page.keyboard.press("g")
    page.keyboard.type(way)
    page.keyboard.press("Enter")


def far_from(page: Page, vertex: int) -> list[float]:
    """The middle of the triangle that is farthest from a vertex."""
    found: list[float] = page.evaluate(
        "v => { const m = trimotion.mesh, from = m.at(v);"
        " const corners = t => m.corners(t).map(c => m.at(c));"
        " const mean = (all, axis) => all.reduce((sum, p) => sum + p[axis], 0) / 3;"
        " const middles = Array.from({length: m.triangleCount}, (_, t) => corners(t))"
        " .map(all => [mean(all, 'x'), mean(all, 'y')]);"
        " const away = ([x, y]) => Math.hypot(x - from.x, y - from.y);"
        " return middles.reduce((one, other) => away(one) > away(other) ? one : other); }",
        vertex,
    )
    return found


def at(page: Page, vertex: int) -> list[float]:
    """Where a vertex is on the page."""
    found: list[float] = page.evaluate("v => Object.values(trimotion.mesh.at(v))", vertex)
    return found
