"""Takes the pictures of the editor that its page shows, of a track of the sample clip.

usage: python benchmarks/editor_picture.py JOB.mtrk -o docs/images/editor.jpg
       python benchmarks/editor_picture.py --texture JOB.mtrk -o docs/images/editor_texture.jpg
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
CLIP = "sample_videos/bigbuckbunny.mp4"
SIZE = {"width": 1360, "height": 820}
FACE, RADIUS = (452, 140), 62
"""Where the face is in frame 60 of the sample clip, and how large [px]."""
RABBIT = (
    (180, 70),
    (380, 60),
    (470, 40),
    (590, 60),
    (640, 330),
    (620, 640),
    (330, 640),
    (370, 330),
)
"""What is around the rabbit there [px]."""
STROKES = (
    (0.15, 14, [[(0.5, 0.28), (0.2, 0.88), (0.8, 0.88), (0.5, 0.28)]]),
    (0.9, 14, [[(0.5, 0.52), (0.36, 0.78), (0.64, 0.78), (0.5, 0.52)]]),
)
"""Shade and width of a pen, and its lines in shares of the sheet."""


def main() -> None:
    """Take it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("track", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--texture", action="store_true", help="the canvas for textures")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(arguments.track, Path(folder) / "bunny.mtrk")
        shutil.copy(ROOT / CLIP, folder)
        words = [
            sys.executable,
            "-m",
            "trimotion",
            "edit",
            "bunny.mtrk",
            "--source",
            Path(CLIP).name,
        ]
        own = {**os.environ, "PYTHONPATH": str(ROOT)}
        with subprocess.Popen(
            [*words, "--no-open", "--quiet"], stdout=subprocess.PIPE, text=True, cwd=folder, env=own
        ) as program:
            assert program.stdout is not None
            try:
                shows = draw if arguments.texture else edit
                take(program.stdout.readline().strip(), arguments.output, shows)
            finally:
                program.terminate()


def take(url: str, output: Path, shows: Callable[[Page], None]) -> None:
    """Open the page, have something to show, and take its picture."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(120_000)
        page.goto(url)
        page.wait_for_selector("#loading", state="hidden")
        page.evaluate("() => trimotion.seek(60)")
        page.wait_for_function("() => trimotion.mesh?.frame === 60 && !trimotion.isLooking")
        shows(page)
        page.wait_for_timeout(8000)  # all thumbnails, and the last of what is drawn
        page.screenshot(path=output, type="jpeg", quality=72)
        browser.close()


def edit(page: Page) -> None:
    """Vertices are put on the face, and the brush shows where it would put others."""
    page.evaluate("([x, y]) => trimotion.camera.near(2.1, trimotion.camera.toScreen({x, y}))", FACE)
    page.locator("#add-style").select_option("edges")
    page.keyboard.press("b")
    page.locator("#set-count").fill("30")
    page.locator("#set-radius").fill(str(RADIUS))
    page.mouse.click(*place(page, *FACE))
    page.wait_for_function("() => trimotion.state.edits === 1")
    page.mouse.move(*place(page, FACE[0] - 150, FACE[1] + 30))
    page.wait_for_function("() => trimotion.ghost?.fresh.length")
    page.evaluate("() => { document.querySelector('#panel').scrollTop = 0; }")


def draw(page: Page) -> None:
    """A texture is drawn, and given to a region with the rabbit in it."""
    page.evaluate("() => trimotion.setOpacity('mesh', 0)")
    page.locator("#texture-panel summary").click()
    sheet = page.locator("#texture")
    sheet.evaluate("canvas => canvas.scrollIntoView({block: 'center'})")
    box = sheet.bounding_box()
    assert box is not None
    for shade, pen, lines in STROKES:
        page.locator("#set-texture-shade").fill(str(shade))
        page.locator("#set-texture-pen").fill(str(pen))
        sheet.evaluate("canvas => canvas.scrollIntoView({block: 'center'})")
        box = sheet.bounding_box()
        assert box is not None
        for line in lines:
            (x, y), *others = [(box["x"] + 200 * u, box["y"] + 200 * v) for u, v in line]
            page.mouse.move(x, y)
            page.mouse.down()
            for u, v in others:
                page.mouse.move(u, v, steps=4)
            page.mouse.up()
    page.locator("#set-region").select_option("texture")
    corners = [place(page, *corner) for corner in RABBIT]
    page.mouse.move(*corners[0])
    page.mouse.down()
    for corner in corners[1:]:
        page.mouse.move(*corner)
    page.mouse.up()
    page.wait_for_function("() => trimotion.state.edits === 1")
    sheet.evaluate("canvas => canvas.scrollIntoView({block: 'center'})")


def place(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where a place of the picture is on the page [px]."""
    left, top = page.evaluate(
        "([x, y]) => { const {left, top} = trimotion.canvas.getBoundingClientRect();"
        " const at = trimotion.camera.toScreen({x, y}); return [at.x + left, at.y + top]; }",
        [x, y],
    )
    return left, top


if __name__ == "__main__":
    main()
