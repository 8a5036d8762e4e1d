"""Kernels are compiled together, told of, and by one process at a time."""

import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from threading import Event, Thread
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import warp as wp

from stages.frame import Frame
from stages.layouts.importance import Importance
from stages.render import Renderer
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from tests.test_encode import ROOT
from warp_kernels.color_model import CONSTANT, LINEAR
from warp_kernels.device.cache_place import is_first_run
from warp_kernels.device.compiling import kernels as compiling
from warp_kernels.device.compiling.kernel_turn import PATIENCE, waited_turn
from warp_kernels.device.compiling.kernels import Kernels
from warp_kernels.device.device import Device
from warp_kernels.device.launcher import WarpLauncher
from warp_kernels.device.runtime import WARP, quiet
from warp_kernels.styles.flat import Flat


class Named(SimpleNamespace):
    """Stands for a kernel, a module or a device."""

    __hash__ = object.__hash__


class Cache:
    """A cache of kernels of which nobody knows how to compile them; notes what happens."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.events: list[Any] = []
        # real need: who compiles what, and when, cannot be seen once it is done
        monkeypatch.setattr(wp.config, "kernel_cache_dir", str(folder))
        monkeypatch.setattr(compiling.wp, "load_module", self.load)

    def kernel(self, name: str) -> Any:
        """A kernel with a module of its own."""

        def identify(block: int | None) -> str:
            self.events.append(("named", name))
            return name

        return Named(module=Named(get_module_identifier=identify, name=name))

    def load(self, module: Any, device: Any, block_dim: int) -> None:
        """Compile."""
        self.events.append(("compiled", module.name))
        (self.folder / module.name).mkdir()

    def tell(self, done: int, total: int) -> None:
        """Note what is told."""
        self.events.append((done, total))


CPU = Named(is_cpu=True, is_cuda=False)


def test_all_that_are_expected_are_compiled_with_the_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All are named before any is compiled, and from then on nothing is left to do."""
    cache = Cache(tmp_path, monkeypatch)
    first, second, third = (cache.kernel(name) for name in "abc")
    (tmp_path / "b").mkdir()
    kernels = Kernels(CPU, cache.tell)
    kernels.expect([first, second])
    kernels.make_ready(third)
    assert cache.events[:4] == [("named", "a"), ("named", "b"), ("named", "c"), (0, 2)]
    assert {("compiled", "a"), ("compiled", "c"), (2, 2)} == set(cache.events[4:]) - {(1, 2)}
    assert cache.events[-1] == (2, 2)
    cache.events.clear()
    for kernel in (first, second, third):
        kernels.make_ready(kernel)
    assert cache.events == []


def test_what_is_expected_is_compiled_beside_all_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lock on Warp is free meanwhile; then nothing is left to do. A failure is made good."""
    cache = Cache(tmp_path, monkeypatch)
    compiles, goes_on = Event(), Event()

    def wait(module: Any, device: Any, block_dim: int) -> None:
        compiles.set()
        assert goes_on.wait(10)
        cache.load(module, device, block_dim)

    # real need: a kernel that takes as long as one likes
    monkeypatch.setattr(compiling.wp, "load_module", wait)
    launcher = WarpLauncher(CPU, cache.tell)
    launcher.expect([cache.kernel("a"), cache.kernel("b")])
    assert launcher.awaits_kernels
    other = Thread(target=launcher.compile_expected)
    other.start()
    assert compiles.wait(10)
    assert WARP.acquire(timeout=10)
    WARP.release()
    assert not launcher.awaits_kernels
    goes_on.set()
    other.join(10)
    assert {("compiled", "a"), ("compiled", "b")} <= set(cache.events)


def test_quiet_lasts_until_the_last_has_left() -> None:
    """Threads enter and leave in any order."""
    usual, entered, leaves = wp.config.log_level, Event(), Event()

    def stay() -> None:
        with quiet():
            entered.set()
            assert leaves.wait(10)

    other = Thread(target=stay)
    with quiet():
        other.start()
        assert entered.wait(10)
    assert wp.config.log_level >= wp.LOG_ERROR
    leaves.set()
    other.join(10)
    assert wp.config.log_level == usual


def test_nothing_is_told_where_all_are_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A later run has nothing to say, and loads only what it launches."""
    cache = Cache(tmp_path, monkeypatch)
    (tmp_path / "a").mkdir()
    Kernels(CPU, cache.tell).make_ready(cache.kernel("a"))
    assert cache.events == [("named", "a")]


def test_a_failure_ends_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What fails is told by the call that needed it."""
    cache = Cache(tmp_path, monkeypatch)

    def fail(module: Any, device: Any, block_dim: int) -> None:
        raise OSError("full")

    # real need: no kernel of the program fails to compile
    monkeypatch.setattr(compiling.wp, "load_module", fail)
    with pytest.raises(OSError, match="full"):
        Kernels(CPU, cache.tell).make_ready(cache.kernel("a"))


def test_one_compiles_and_the_others_wait(tmp_path: Path) -> None:
    """Whoever waits looks, and comes in when the first has left."""
    waits, entered = Event(), Event()

    def come() -> None:
        """Take the next turn."""
        with waited_turn(tmp_path / "new", waits.set):
            entered.set()

    with waited_turn(tmp_path / "new", lambda: None):
        other = Thread(target=come)
        other.start()
        assert waits.wait(10)
        assert not entered.is_set()
    other.join(10)
    assert entered.is_set()


def test_whoever_waits_tells_what_is_new(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another process compiles: that is told once, and again when it has come further."""
    cache = Cache(tmp_path, monkeypatch)
    kernel = cache.kernel("a")
    with waited_turn(tmp_path, lambda: None):
        other = Thread(target=Kernels(CPU, cache.tell).make_ready, args=[kernel])
        other.start()
        other.join(3 * PATIENCE)
        (tmp_path / "a").mkdir()
    other.join(10)
    assert cache.events == [("named", "a"), (0, 1), (1, 1)]


def test_a_place_without_locks_lets_everybody_in(tmp_path: Path) -> None:
    """Nobody waits for ever for a lock that cannot be."""
    (tmp_path / "file").write_text("")
    with waited_turn(tmp_path / "file", lambda: None):
        pass


def test_the_cache_is_where_warp_has_it(tmp_path: Path) -> None:
    """So what earlier versions compiled is found, and what others do lies beside it."""
    script = (
        "import warp as wp\nfrom warp_kernels.device.cache_place import cache_place\n"
        "wp.config.log_level = wp.LOG_ERROR\nwp.init()\n"
        "print(cache_place() / wp.config.version)\nprint(wp.config.kernel_cache_dir)"
    )
    env = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin"}
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT, env=env
    )
    ours, theirs = done.stdout.splitlines()
    assert Path(ours) == Path(theirs)


def test_a_first_run_is_one_without_our_kernels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of other programs do not count."""
    monkeypatch.setenv("WARP_CACHE_PATH", str(tmp_path / "cache"))
    assert is_first_run()
    (tmp_path / "cache" / "1.19.0" / "wp_other").mkdir(parents=True)
    assert is_first_run()
    (tmp_path / "cache" / "1.19.0" / "wp_warp_kernels.device.barrier_1c663ab").mkdir()
    assert not is_first_run()


class ListingDevice(Device):
    """Lists what is expected and what is recorded."""

    def __init__(self) -> None:
        super().__init__("cpu", 1)
        self.expected: set[Any] = set()
        self.recorded: set[Any] = set()

    def expect(self, kernels: Any) -> None:
        """Note them."""
        self.expected |= set(kernels)
        super().expect(kernels)

    def record(self, kernel: Any, *args: Any, **named: Any) -> Any:
        """Note it."""
        assert kernel in self.expected, f"{kernel.key} is not among those that are compiled first"
        self.recorded.add(kernel)
        return super().record(kernel, *args, **named)


@pytest.mark.parametrize("model", [CONSTANT, LINEAR], ids=lambda model: model.name)
def test_what_a_job_launches_was_expected(model: Any, rng: np.random.Generator) -> None:
    """A kernel that nobody expected is compiled alone, while everything waits."""
    with ListingDevice() as device:
        renderer = Renderer(device, (48, 32), (48, 32), (Flat(),))
        options = TriangulateOptions(iterations=24, refine=RefineOptions(triangles=24))
        solver = Triangulator(device, (48, 32), options, model)
        pixels = rng.integers(0, 255, (32, 48, 3), dtype=np.uint8)
        frame = Frame(0, 0, Fraction(1, 25), pixels)
        renderer.render(solver.first(frame, Importance(), rng))
        assert len(device.recorded) > 10
