"""Takes the picture of the editor that its page shows, of a track of the sample clip.

usage: python benchmarks/editor_picture.py out/bunny.mtrk -o docs/images/editor.jpg
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
CLIP = "sample_videos/bigbuckbunny.mp4"
SIZE = {"width": 1360, "height": 820}
FACE, RADIUS = (452, 140), 62
"""Where the face is in frame 60 of the sample clip, and how large [px]."""


def main() -> None:
    """Take it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("track", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
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
                take(program.stdout.readline().strip(), arguments.output)
            finally:
                program.terminate()


def take(url: str, output: Path) -> None:
    """Open the page, put vertices on the face, and take its picture."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(120_000)
        page.goto(url)
        page.wait_for_selector("#loading", state="hidden")
        edit(page)
        page.screenshot(path=output, type="jpeg", quality=88)
        browser.close()


def edit(page: Page) -> None:
    """What the picture shows."""
    page.evaluate("() => trimotion.seek(60)")
    page.wait_for_function("() => trimotion.mesh?.frame === 60 && !trimotion.isLooking")
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
    page.wait_for_timeout(8000)  # all thumbnails, and the last of what is drawn


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
