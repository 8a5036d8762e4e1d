"""How long a person waits in the editor's page, measured in a real browser.

usage: python -m benchmarks.editor_speed out/bunny.mtrk [--times 30]

Of a track of the sample clip at 720p: from a click to the new mesh on the screen, from a slider to
the picture, steps of the optimiser a second, frames a second of playback; then steps of a still of
512x512 with 700 triangles. A browser without a card draws by software, on the cores that the
program uses as well. CPU times are those of the program and of the browser together.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.plain_browser import Tab, opened_tab

ROOT = Path(__file__).resolve().parents[1]
VIDEOS = ROOT / "sample_videos"
CLIP, STILL = "bigbuckbunny.mp4", "astronaut.jpg"
SIZE = (1360, 963)  # of which the page has 820 rows
FRAME = 40
"""Frame that is worked on."""
REST = 0.15
"""Between two things that a hand does [s]."""
READY = "() => globalThis.trimotion?.mesh && trimotion.painter.textures.drawn"
WATCH = """() => {
    globalThis.seen = {mesh: [], drawn: [], begun: 0, steps: 0, frames: new Set()};
    const {painter} = trimotion;
    const [paint, setMesh, setPicture] =
        ["paint", "setMesh", "setPicture"].map(name => painter[name].bind(painter));
    const painted = (kind) => requestAnimationFrame(() => requestAnimationFrame(
        () => seen[kind].push(performance.now())));
    painter.paint = (...given) => { paint(...given); seen.frames.add(trimotion.frame); };
    painter.setMesh = (mesh) => { setMesh(mesh); seen.steps++; painted("mesh"); };
    painter.setPicture = (name, packed) => {
        setPicture(name, packed);
        if (name === "drawn") painted("drawn");
    };
    addEventListener("pointerup", (event) => { seen.begun = event.timeStamp; }, true);
}"""
"""Notes when something that is new has been put on the screen, and when a hand began it [ms]."""
PLAY = """async () => {
    seen.frames.clear();
    const begun = performance.now();
    await trimotion.player.play();
    return [seen.frames.size, performance.now() - begun];
}"""


def main() -> None:
    """Measure all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("track", type=Path)
    parser.add_argument("--times", type=int, default=30)
    given = parser.parse_args()
    print(f"load before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(given.track, folder / "clip.mtrk")
        for file in (CLIP, STILL):
            shutil.copy(VIDEOS / file, folder)
        with opened(["clip.mtrk", "--source", CLIP], folder) as tab:
            film(tab, given.times)
        with opened([STILL, "--triangles", "700"], folder) as tab:
            print(f"| optimiser, still of 512x512, 700 triangles | {steps(tab)} |")
    print(f"load after: {os.getloadavg()[0]:.1f}")


@contextmanager
def opened(words: list[str], folder: Path) -> Iterator[Tab]:
    """The editor's page, once it shows a picture."""
    own = {**os.environ, "PYTHONPATH": str(ROOT)}
    line = [sys.executable, "-m", "trimotion", "edit", *words, "--no-open", "--quiet"]
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True, cwd=folder, env=own) as program:
        assert program.stdout is not None
        try:
            with opened_tab(program.stdout.readline().strip(), SIZE) as tab:
                tab.wait(READY)
                tab.evaluate(WATCH)
                yield tab
        finally:
            program.terminate()


def film(tab: Tab, times: int) -> None:
    """The rows of the clip."""
    go_to(tab, FRAME)
    time.sleep(5)  # thumbnails
    print("| what | median | 90 % | least | CPU each |\n|---|---|---|---|---|")
    row("click to the new mesh on the screen", clicks(tab, times))
    tab.evaluate("() => document.querySelector('#add-style').focus()")
    tab.evaluate(
        "() => { const add = document.querySelector('#add-style');"
        " add.value = 'edges'; add.dispatchEvent(new Event('change')); }"
    )
    time.sleep(2)
    tab.wait("() => document.querySelector('#preparing').hidden")
    row("slider to the picture", slides(tab, times))
    print(f"| optimiser, 720p, 1,500 triangles | {steps(tab)} |")
    tab.evaluate("() => document.querySelector('[data-style=edges] button:last-child').click()")
    tab.evaluate("() => trimotion.setView('edited')")
    for mesh, name in ((0.6, "with its mesh"), (0, "drawn alone")):
        tab.evaluate("mesh => { trimotion.veil(false); trimotion.setOpacity('mesh', mesh); }", mesh)
        go_to(tab, 0)
        begun = spent()
        shown, took = tab.evaluate(PLAY)
        each = (spent() - begun) / shown
        print(f"| playback, {name} | {1e3 * shown / took:.1f} frames/s, CPU {1e3 * each:.0f} ms |")


def go_to(tab: Tab, frame: int) -> None:
    """Show a frame."""
    tab.evaluate("frame => trimotion.seek(frame)", frame)
    tab.wait("frame => trimotion.mesh?.frame === frame && !trimotion.isLooking", frame)


def row(name: str, found: tuple[list[float], float]) -> None:
    """Print a row of times [ms], and of the CPU time of each [s]."""
    times, cpu = found
    figures = (median(times), float(np.percentile(times, 90)), min(times), 1e3 * cpu)
    print(f"| {name} | {' | '.join(f'{one:.0f} ms' for one in figures)} |", flush=True)


def clicks(tab: Tab, times: int) -> tuple[list[float], float]:
    """Triangles are split, each in another place."""
    tab.evaluate("() => trimotion.setMode('face')")
    places = np.random.default_rng(0).uniform((200, 120), (1080, 600), (times, 2))
    found, used = [], 0.0
    for x, y in places:
        left, top = place(tab, x, y)
        tab.mouse("Moved", left, top)
        time.sleep(REST)
        begun = spent()
        found.append(timed(tab, "mesh", lambda left=left, top=top: tab.click(left, top)))
        used += spent() - begun
    return found, used / times


def slides(tab: Tab, times: int) -> tuple[list[float], float]:
    """The width of edges is changed."""
    slide = """value => {
        const width = document.querySelector('#set-style-width');
        width.value = value;
        seen.begun = performance.now();
        width.dispatchEvent(new Event('input'));
    }"""
    found, used = [], 0.0
    for value in np.linspace(0.5, 4, times):
        time.sleep(REST)
        begun = spent()
        found.append(timed(tab, "drawn", lambda value=value: tab.evaluate(slide, f"{value:.2f}")))
        used += spent() - begun
    return found, used / times


def timed(tab: Tab, kind: str, act: Callable[[], None]) -> float:
    """From what a hand does until something new of a kind is on the screen [ms]."""
    tab.evaluate("kind => { seen[kind] = []; seen.begun = 0; }", kind)
    act()
    tab.wait("kind => seen.begun && seen[kind].some(t => t > seen.begun)", kind)
    took: float = tab.evaluate("kind => seen[kind].find(t => t > seen.begun) - seen.begun", kind)
    return took


def steps(tab: Tab) -> str:
    """Steps that the optimiser shows in a second."""
    tab.evaluate("() => document.querySelector('#optimise').click()")
    tab.wait("() => /step [0-9]{2}/.test(document.querySelector('#optimiser-told').textContent)")
    used = spent()
    before, begun = tab.evaluate("() => [seen.steps, performance.now()]")
    time.sleep(6)
    after, ended = tab.evaluate("() => [seen.steps, performance.now()]")
    each = (spent() - used) / max(1, after - before)
    tab.evaluate("() => document.querySelector('#optimise').click()")
    return f"{1e3 * (after - before) / (ended - begun):.1f} steps/s, CPU {1e3 * each:.0f} ms"


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


def place(tab: Tab, x: float, y: float) -> tuple[float, float]:
    """Where a place of the picture is on the page [px]."""
    left, top = tab.evaluate(
        "(x, y) => { const {left, top} = trimotion.canvas.getBoundingClientRect();"
        " const at = trimotion.camera.toScreen({x, y}); return [at.x + left, at.y + top]; }",
        x,
        y,
    )
    return left, top


if __name__ == "__main__":
    main()
