"""How long a person waits in the editor's page, measured in a real browser.

usage: python benchmarks/editor_speed.py out/bunny.mtrk [--times 30]

Of a track of the sample clip at 720p: from a click to the new mesh on the screen, from a slider to
the picture, steps of the optimiser a second, frames a second of playback; then steps of a still of
512x512 with 700 triangles. The browser draws by software, on the cores that the program uses as
well.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from statistics import median

import numpy as np
from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
VIDEOS = ROOT / "sample_videos"
CLIP, STILL = "bigbuckbunny.mp4", "astronaut.jpg"
SIZE = {"width": 1360, "height": 820}
FRAME = 40
"""Frame that is worked on."""
WATCH = """() => {
    globalThis.seen = {mesh: [], drawn: [], steps: 0, frames: new Set()};
    const painted = (kind) => requestAnimationFrame(() => requestAnimationFrame(
        () => seen[kind].push(performance.now())));
    const {painter} = trimotion;
    const paint = painter.paint.bind(painter);
    painter.paint = (...given) => { paint(...given); seen.frames.add(trimotion.frame); };
    const [setMesh, setPicture] = [painter.setMesh.bind(painter), painter.setPicture.bind(painter)];
    painter.setMesh = (mesh) => { setMesh(mesh); seen.steps++; painted("mesh"); };
    painter.setPicture = (name, packed) => {
        setPicture(name, packed);
        if (name === "drawn") painted("drawn");
    };
    for (const kind of ["pointerup", "input"])
        addEventListener(kind, (event) => { seen.begun = event.timeStamp; }, true);
}"""
"""Notes when something that is new has been put on the screen, and when a hand began it [ms]."""


def main() -> None:
    """Measure all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("track", type=Path)
    parser.add_argument("--times", type=int, default=30)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        shutil.copy(given.track, Path(folder) / "clip.mtrk")
        shutil.copy(VIDEOS / CLIP, folder)
        shutil.copy(VIDEOS / STILL, folder)
        print(f"load before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
        with served(["clip.mtrk", "--source", CLIP], Path(folder)) as url:
            page = opened(browser.new_page(viewport=SIZE), url)
            film(page, given.times)
            page.close()
        with served([STILL, "--triangles", "700"], Path(folder)) as url:
            page = opened(browser.new_page(viewport=SIZE), url)
            print(f"| optimiser, still of 512x512, 700 triangles | {steps(page)} |")
            page.close()
        browser.close()
        print(f"load after: {os.getloadavg()[0]:.1f}")


@contextmanager
def served(words: list[str], folder: Path) -> Iterator[str]:
    """The address of the editor's page while the block runs."""
    own = {**os.environ, "PYTHONPATH": str(ROOT)}
    line = [sys.executable, "-m", "trimotion", "edit", *words, "--no-open", "--quiet"]
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True, cwd=folder, env=own) as program:
        assert program.stdout is not None
        try:
            yield program.stdout.readline().strip()
        finally:
            program.terminate()


def opened(page: Page, url: str) -> Page:
    """The page, once it shows a picture."""
    page.set_default_timeout(300_000)
    page.goto(url)
    page.wait_for_selector("#loading", state="hidden")
    page.wait_for_function("() => trimotion.painter.textures.drawn")
    page.evaluate(WATCH)
    return page


def film(page: Page, times: int) -> None:
    """The rows of the clip."""
    last = page.evaluate("() => trimotion.frames.at(-1)")
    page.evaluate("frame => trimotion.seek(frame)", FRAME)
    page.wait_for_function("f => trimotion.mesh?.frame === f && !trimotion.isLooking", arg=FRAME)
    page.wait_for_timeout(5_000)  # thumbnails
    print("| what | median | 90 % | least | CPU each |\n|---|---|---|---|---|")
    begun = spent()
    found = clicks(page, times)
    row("click to the new mesh on the screen", found, (spent() - begun) / times)
    page.locator("#add-style").select_option("edges")
    page.wait_for_function("() => document.querySelector('#set-style-width')")
    page.wait_for_timeout(1_000)
    page.wait_for_selector("#preparing", state="hidden")
    begun = spent()
    found = slides(page, times)
    row("slider to the picture", found, (spent() - begun) / times)
    print(f"| optimiser, 720p, 1,500 triangles | {steps(page)} |")
    page.evaluate("() => trimotion.setView('edited')")
    page.locator("[data-style=edges] button").last.click()
    for mesh in (0.6, 0):
        page.evaluate("mesh => trimotion.setOpacity('mesh', mesh)", mesh)
        page.evaluate("frame => trimotion.seek(frame)", 0)
        page.wait_for_function("() => trimotion.mesh?.frame === 0 && !trimotion.isLooking")
        used = spent()
        shown, took = page.evaluate(
            """async () => {
                seen.frames.clear();
                const begun = performance.now();
                await trimotion.player.play();
                return [seen.frames.size, performance.now() - begun];
            }"""
        )
        name = "with its mesh" if mesh else "drawn alone"
        each = (spent() - used) / shown
        rate = f"{1e3 * shown / took:.1f} frames/s, {1e3 * each:.0f} ms of CPU each"
        print(f"| playback of {last + 1} frames, {name} | {rate} |")


def spent() -> float:
    """CPU time of all that this program has begun: the editor and the browser [s]."""
    parents, times = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            fields = stat.read_text().rpartition(")")[2].split()
            parents[int(stat.parent.name)] = int(fields[1])
            times[int(stat.parent.name)] = int(fields[11]) + int(fields[12])
    own, total = {os.getpid()}, 0
    while own:
        own = {child for child, parent in parents.items() if parent in own}
        total += sum(times[child] for child in own)
    return total / os.sysconf("SC_CLK_TCK")


def row(name: str, found: list[float], cpu: float) -> None:
    """Print a row of times [ms], and of the CPU time of each [s]."""
    high = float(np.percentile(found, 90))
    shown = " | ".join(f"{value:.0f} ms" for value in (median(found), high, min(found), 1e3 * cpu))
    print(f"| {name} | {shown} |", flush=True)


def clicks(page: Page, times: int) -> list[float]:
    """Triangles are split, each in another place."""
    rng = np.random.default_rng(0)
    found = []
    page.locator("#tool-face").click()
    for x, y in rng.uniform((200, 120), (1080, 600), (times, 2)):
        left, top = place(page, x, y)
        page.mouse.move(left, top)
        page.wait_for_timeout(150)
        found.append(timed(page, "mesh", lambda left=left, top=top: page.mouse.click(left, top)))
    return found


def slides(page: Page, times: int) -> list[float]:
    """The width of edges is changed."""
    width = page.locator("#set-style-width")
    found = []
    for value in np.linspace(0.5, 4, times):
        page.wait_for_timeout(150)
        found.append(timed(page, "drawn", lambda value=value: width.fill(f"{value:.2f}")))
    return found


def timed(page: Page, kind: str, act) -> float:  # type: ignore[no-untyped-def]
    """From what a hand does until something new of a kind is on the screen [ms]."""
    page.evaluate("kind => { seen[kind] = []; seen.begun = 0; }", kind)
    act()
    page.wait_for_function("kind => seen.begun && seen[kind].some(t => t > seen.begun)", arg=kind)
    took: float = page.evaluate("kind => seen[kind].find(t => t > seen.begun) - seen.begun", kind)
    return took


def steps(page: Page) -> str:
    """Steps that the optimiser shows in a second."""
    page.locator("#optimise").click()
    page.wait_for_function(
        "() => /step [0-9]{2}/.test(document.querySelector('#optimiser-told').textContent)"
    )
    used = spent()
    before, begun = page.evaluate("() => [seen.steps, performance.now()]")
    page.wait_for_timeout(6_000)
    after, ended = page.evaluate("() => [seen.steps, performance.now()]")
    page.locator("#optimise").click()
    each = (spent() - used) / max(1, after - before)
    rate = (
        f"{1e3 * (after - before) / (ended - begun):.1f} steps/s, {1e3 * each:.0f} ms of CPU each"
    )
    return f"{rate}"


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
