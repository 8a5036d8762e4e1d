"""The team of threads: equal results, no waiting for ever, and a device that survives mistakes."""

import gc
import os
import subprocess
import sys
import threading
from _thread import interrupt_main
from threading import Thread, Timer
from time import sleep
from typing import Any

import numpy as np
import pytest
import warp as wp

from stages.optimize import load_mesh, place_mesh
from tests.kernel_samples import noise, poisoned_workspace, random_mesh, waves
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR, ColorModel
from warp_kernels.device.card_memory import fitting_scale, memory_problem
from warp_kernels.device.device import Device
from warp_kernels.device.phase import Phase
from warp_kernels.device.runtime import driver_problem
from warp_kernels.device.team import PART
from warp_kernels.energy.workspace import Workspace

WIDTH, HEIGHT = 61, 47
STEPS = {"trust": 0.5, "regularity": 1e-3}
PATIENCE = 30.0
"""Seconds after which something waits for ever."""


@wp.kernel(enable_backward=False)
def count_visits(span: wp.array(dtype=wp.vec2i), visits_out: wp.array(dtype=int)):
    """Count how often every element is visited."""
    number = span[0][0] + wp.tid()
    if number < span[0][1]:
        visits_out[number] = visits_out[number] + 1


def counting(device: Device, size: int) -> tuple[Phase, wp.array]:
    """A phase that counts visits, and the counts of `size` elements."""
    visits = device.empty(size, int)
    device.clear(visits)
    return device.record(count_visits, [], [visits]), visits


def ends_in_time(*works: Thread) -> bool:
    """Start threads and say whether all of them end."""
    for work in works:
        work.start()
    for work in works:
        work.join(PATIENCE)
    return not any(work.is_alive() for work in works)


class Interrupted:
    """A part of a phase whose launch Ctrl-C ends, as often as is wanted."""

    def __init__(self, part: Any, times: int) -> None:
        self.part, self.times, self.bounds = part, times, part.bounds

    def launch(self) -> None:
        """Launch it, or end as the interpreter does on Ctrl-C."""
        self.times -= 1
        if self.times >= 0:
            raise KeyboardInterrupt
        self.part.launch()


def interrupt(phase: Phase, times: int) -> None:
    """Let Ctrl-C end the first launches of a phase."""
    phase.parts = (Interrupted(phase.parts[0], times), *phase.parts[1:])


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_every_element_is_visited_once_per_run(threads: int, device: str) -> None:
    """Many replays while the number of elements grows, shrinks, and is nothing."""
    runner = Device(device, threads)
    phase, visits = counting(runner, 3000)
    expected = np.zeros(3000, dtype=int)
    sizes = np.random.default_rng(threads).integers(0, 3001, 150)
    for size in (*sizes, 0, 1, 15, 16, 17, 3000):
        phase.resize(int(size))
        runner.run([phase], 3)
        expected[:size] += 3
    np.testing.assert_array_equal(runner.read(visits, 3000), expected)


def test_no_times_runs_nothing(device: str) -> None:
    """Zero times is a number of times."""
    runner = Device(device, 2)
    phase, visits = counting(runner, 100)
    phase.resize(100)
    runner.run([phase], times=0)
    assert not runner.read(visits, 100).any()
    runner.run([phase])
    assert (runner.read(visits, 100) == 1).all()


def test_same_bits_while_meshes_change_size(device: str) -> None:
    """Eight meshes of any size in the same memory, by one, two and three threads."""
    sizes = np.random.default_rng(0).integers(5, 400, 8)
    meshes = [random_mesh(WIDTH, HEIGHT, int(size), seed=n) for n, size in enumerate(sizes)]
    ends: list[list[np.ndarray]] = []
    for threads in (1, 2, 3):
        workspace = Workspace(Device(device, threads), (WIDTH, HEIGHT), LINEAR)
        workspace.load_image(noise(WIDTH, HEIGHT))
        ends.append([])
        for mesh in meshes:
            load_mesh(workspace, mesh)
            for times in (1, 4):
                workspace.iterate(times, **STEPS)
            ends[-1] += [workspace.vertices(), *workspace.fit()]
    for other in ends[1:]:
        for actual, expected in zip(other, ends[0], strict=True):
            np.testing.assert_array_equal(actual, expected)


def test_a_mesh_is_loaded_again_where_it_must(device: str) -> None:
    """After steps the vertices lie elsewhere, after another picture all sums are void."""
    mesh, other = random_mesh(WIDTH, HEIGHT, 60), random_mesh(WIDTH, HEIGHT, 50, seed=1)
    used, fresh = (Workspace(Device(device), (WIDTH, HEIGHT), LINEAR) for _ in range(2))
    used.load_image(waves(WIDTH, HEIGHT))
    load_mesh(used, mesh)
    used.iterate(7, **STEPS)
    load_mesh(used, mesh)
    np.testing.assert_array_equal(used.vertices(), mesh.vertices)
    used.energies()
    for workspace in (used, fresh):
        workspace.load_image(noise(WIDTH, HEIGHT))
        load_mesh(workspace, mesh)
    np.testing.assert_array_equal(used.energies(), fresh.energies())
    place_mesh(used, other)
    with pytest.raises(ValueError, match="hold"):
        used.iterate(1, **STEPS)


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_interrupted_device_still_works(threads: int, device: str) -> None:
    """Ctrl-C while the others are at work leaves them behind, not the next caller."""
    runner = Device(device, threads)
    phase, visits = counting(runner, 500)
    phase.resize(500)
    runner.run([phase])
    ctrl_c = Timer(0.2, interrupt_main)
    ctrl_c.start()
    with pytest.raises(KeyboardInterrupt):
        runner.run([phase], 1 << 30)  # hours of work
    ctrl_c.join()
    runner.clear(visits)
    assert ends_in_time(Thread(target=runner.run, args=([phase], 4), daemon=True))
    assert (runner.read(visits, 500) == 4).all()


def test_interrupt_while_capturing_leaves_a_device_that_works(device: str) -> None:
    """Ctrl-C before anybody has started: the next call captures anew."""
    runner = Device(device, 2)
    phase, visits = counting(runner, 500)
    phase.resize(500)
    interrupt(phase, 1)
    with pytest.raises(KeyboardInterrupt):
        runner.run([phase])
    assert ends_in_time(Thread(target=runner.run, args=([phase],), daemon=True))
    assert (runner.read(visits, 500) == 1).all()


def test_what_was_captured_is_not_captured_again(device: str) -> None:
    """However many sizes came between: a limit had thrown away what the next frame needed."""
    runner = Device(device, 2)
    phase, _ = counting(runner, 700)
    for size in (*range(600, 0, -4), 600):
        phase.resize(size)
        runner.run([phase])
    known = len(phase.sequences)
    for size in range(600, 0, -4):
        phase.resize(size)
        runner.run([phase])
    assert len(phase.sequences) == known > 1


def test_two_threads_may_use_one_device(device: str) -> None:
    """The one that solves and the one that draws do not wait for each other for ever."""
    runner = Device(device, 2)
    pairs = [counting(runner, 700) for _ in range(2)]

    def work(phase: Phase) -> None:
        """Run a phase over and over, with a new graph now and then."""
        for turn in range(60):
            phase.resize(700 - 200 * (turn % 3))
            runner.run([phase], 2)

    works = [Thread(target=work, args=(phase,), daemon=True) for phase, _ in pairs]
    assert ends_in_time(*works)
    for _, visits in pairs:
        counts = runner.read(visits, 700)
        assert counts[:300].tolist() == [120] * 300
        assert counts[600:].tolist() == [40] * 100


def test_two_devices_may_be_used_at_once(device: str) -> None:
    """Two teams of two threads on two workspaces end where each ends alone."""
    mesh = random_mesh(WIDTH, HEIGHT, 200)
    alone = poisoned_workspace(Device(device, 1), waves(WIDTH, HEIGHT), mesh, CONSTANT)
    alone.iterate(40, **STEPS)
    both = [
        poisoned_workspace(Device(device, 2), waves(WIDTH, HEIGHT), mesh, CONSTANT)
        for _ in range(2)
    ]
    works = [
        Thread(target=workspace.iterate, args=(40,), kwargs=STEPS, daemon=True)
        for workspace in both
    ]
    assert ends_in_time(*works)
    for workspace in both:
        np.testing.assert_array_equal(workspace.vertices(), alone.vertices())


@pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
def test_leaving_edges_at_rest_alone_changes_no_bit(model: ColorModel, device: str) -> None:
    """With a dead band many vertices rest: the same as if all were summed anew."""
    mesh = random_mesh(WIDTH, HEIGHT, 150, seed=4)
    skipping, thorough = (
        poisoned_workspace(Device(device, 2), waves(WIDTH, HEIGHT), mesh, model) for _ in range(2)
    )
    resting = 0
    for _ in range(30):
        before = skipping.vertices()
        for workspace in (skipping, thorough):
            workspace.iterate(1, dead_band=0.1, displacement=0.75, **STEPS)
        np.testing.assert_array_equal(skipping.vertices(), thorough.vertices())
        resting += int((skipping.vertices() == before).all(axis=1).sum())
        thorough.energies()  # are of another distance: what was summed is void
    assert resting > 5 * mesh.vertex_count
    np.testing.assert_array_equal(skipping.energies(), thorough.energies())


def parts_alive() -> int:
    """Threads of teams."""
    return sum(thread.name == PART for thread in threading.enumerate())


def parts_fall_to(number: int) -> bool:
    """Whether so many threads of teams are left after a while."""
    for _ in range(100):
        if parts_alive() <= number:
            break
        sleep(0.05)
    return parts_alive() <= number


def test_threads_end_with_their_device(device: str) -> None:
    """Closed, left, or dropped after use, and also after an interrupt left its first team behind;
    what was computed can still be read."""
    gc.collect()
    before = parts_alive()
    with Device(device, 8) as runner:
        phase, visits = counting(runner, 700)
        phase.resize(700)
        runner.run([phase], 2)
    runner.close()  # again
    assert parts_alive() <= before
    assert (runner.read(visits, 700) == 2).all()
    with pytest.raises(RuntimeError, match="was closed"):
        runner.run([phase])
    for _ in range(5):
        dropped = Device(device, 8)
        phase, _ = counting(dropped, 700)
        dropped.run([phase])
    del dropped, phase
    gc.collect()
    assert parts_fall_to(before)


def test_interrupted_teams_end(device: str) -> None:
    """The threads that an interrupt left waiting do not wait for ever."""
    before = parts_alive()
    with Device(device, 4) as runner:
        phase, _ = counting(runner, 500)
        phase.resize(500)
        interrupt(phase, 3)
        for _ in range(3):
            with pytest.raises(KeyboardInterrupt):
                runner.run([phase])
    assert parts_fall_to(before)


PROCESS = """
import os, sys
import warp as wp
level, before = wp.config.log_level, dict(os.environ)
stream = os.fstat(2)
from warp_kernels.device.card_memory import fitting_scale, memory_problem
from warp_kernels.device.device import Device
with Device("cpu", 2) as device:
    array = device.empty(3, int)
    device.clear(array)
assert wp.config.log_level == level, wp.config.log_level
assert dict(os.environ) == before
assert os.path.samestat(os.fstat(2), stream)
if "closed" in sys.argv:
    os.close(2)
    sys.stderr = None
    Device("cpu", 2)
"""


@pytest.mark.parametrize("streams", ["open", "closed"])
def test_nothing_of_the_process_stays_changed(streams: str) -> None:
    """Neither Warp's level of messages nor the environment nor where errors go; not a word."""
    ended = subprocess.run(
        [sys.executable, "-c", PROCESS, streams],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": os.getcwd()},
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")


def test_old_drivers_are_named() -> None:
    """Where CUDA is not found for want of a newer driver the message says so; else nothing."""
    text = driver_problem((12, 4), (13, 4))
    assert "knows CUDA 12.4" in text
    assert "needs 13.0" in text
    assert [driver_problem(*v) for v in ((None, (13, 4)), ((13, 0), (13, 4)), ((9, 0), None))] == [
        "",
        "",
        "",
    ]


@pytest.mark.parametrize(
    ("taken", "asked", "free", "scale"),
    [
        (6_000, 6_000, 2_000, 0.75),  # 90 % of 8,000 of 12,000 wanted: a share of 0.6 of the area
        (0, 1_000, 10, 0.05),
        (0, 1_000_000, 10, 0.0),
        (1_000, 1, 1_000_000, 0.95),  # it would have fitted: still something smaller is named
    ],
)
def test_a_full_card_names_what_fits(taken: int, asked: int, free: int, scale: float) -> None:
    """Memory grows with the area, so a scale is a root."""
    assert fitting_scale(taken, asked, free) == pytest.approx(scale)
    said = memory_problem("cuda:0", taken * 10**6, asked * 10**6, free * 10**6)
    assert f"{asked} MB more" in said
    assert "--device cpu" in said
    assert ("--scale" in said) == (scale > 0)
