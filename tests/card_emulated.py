"""The emulated card and the CPU agree to the bit; run by `make cuda-check`, not with the suite."""

from collections.abc import Iterable, Iterator, Sequence
from copy import copy
from pathlib import Path
from threading import Thread
from types import SimpleNamespace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import pytest
import warp as wp

from pipeline.loop.animate import animate
from pipeline.progress import Progress
from stages.media import open_decoder
from stages.media.writing.encode_options import EncodeOptions
from stages.render import Renderer
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from tests import media_samples as samples
from tests.jobs import job_of
from tests.kernel_samples import (
    noise,
    poisoned_workspace,
    random_mesh,
    random_weights,
    snapshot_of,
)
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.device.emulation import EmulatedLauncher
from warp_kernels.device.phase import Phase
from warp_kernels.device.runtime import WARP
from warp_kernels.device.staging import ArrayRows
from warp_kernels.energy.sums import SUMS
from warp_kernels.energy.topology_survey import Survey
from warp_kernels.energy.workspace import Workspace
from warp_kernels.errors import TrimotionError
from warp_kernels.styles import STYLES

SIZE = (61, 47)
"""Of the pictures [px]."""
FRAMES = 10


def on(device: str, model: str, sums: str, *, weighted: bool) -> Workspace:
    """A mesh over noise."""
    weights = random_weights(*SIZE) if weighted else None
    mesh = random_mesh(*SIZE, 60)
    kind = COLOR_MODELS[model]
    return poisoned_workspace(Device(device, 1), noise(*SIZE), mesh, kind, sums, weights)


def solved(workspace: Workspace) -> list[np.ndarray]:
    """Everything that fifty iterations lead to."""
    workspace.hold(np.zeros((len(workspace.vertices()), 4)))
    workspace.iterate(50, trust=0.5, regularity=1e-3)
    return [workspace.vertices(), workspace.energies(), *workspace.moments(), *workspace.fit()]


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("sums", SUMS)
@pytest.mark.parametrize("model", COLOR_MODELS)
def test_iterations(model: str, sums: str, weighted: bool, device: str) -> None:
    """Fifty, and what is measured after them."""
    results = [solved(on(name, model, sums, weighted=weighted)) for name in ("cpu", device)]
    for expected, actual in zip(*results, strict=True):
        np.testing.assert_array_equal(actual, expected)


def gains(workspace: Workspace) -> list[Any]:
    """What flips, collapses and splits of every edge of a mesh would gain."""
    mesh = random_mesh(*SIZE, 60)
    survey = Survey(workspace)
    survey.load_topology(mesh.twins.ravel(), mesh.triangles.ravel())
    chosen = np.flatnonzero(mesh.twins.ravel() >= 0)
    measured = survey.flip_gains(chosen), survey.collapse_costs(chosen), survey.split_gains(chosen)
    return [measured[0], measured[1], *measured[2]]


@pytest.mark.parametrize("model", COLOR_MODELS)
def test_gains(model: str, device: str) -> None:
    """Of all edges within."""
    results = [gains(on(name, model, "edges", weighted=False)) for name in ("cpu", device)]
    for expected, actual in zip(*results, strict=True):
        np.testing.assert_array_equal(actual, expected)


def film(folder: Path, device: str, **look: Any) -> np.ndarray:
    """Ten restless frames of 64 x 48, converted, [F, H, W, 3] uint8."""
    pictures = [samples.picture(64, 48, 2 * number) for number in range(FRAMES)]
    clip = samples.write_video(folder / "clip.mp4", pictures)
    quick = TriangulateOptions(
        iterations=40, frame_iterations=6, refine=RefineOptions(triangles=120)
    )
    output = folder / f"{device}.mkv"
    job = job_of(
        clip, output, triangulate=quick, encode=EncodeOptions(codec="ffv1"), device=device, **look
    )
    animate(job, Progress())
    with open_decoder(output) as decoder:
        return np.stack([frame.pixels for frame in decoder])


@pytest.mark.parametrize("style", STYLES)
def test_clips(style: str, device: str, tmp_path: Path) -> None:
    """Solved and drawn, with triangles that fade in."""
    look = {"styles": (STYLES["paper"](), STYLES[style](opacity=0.75)), "blend": 4}
    expected, actual = (film(tmp_path, name, **look) for name in ("cpu", device))
    np.testing.assert_array_equal(actual, expected)


class Owned(EmulatedLauncher):
    """A launcher that refuses memory of another stream's, and what is waited for under the lock."""

    def record(self, kernel: Any, arguments: Sequence[Any]) -> Any:
        """Look whose arrays a launch is over."""
        for array in _arrays_in(arguments):
            owner = OWNERS.setdefault(array, id(self))
            assert owner == id(self), f"{kernel.key} looks at memory of another stream"
            SEEN.add(owner)
        return super().record(kernel, arguments)

    def wait(self, mark: None) -> None:
        """Wait as others do."""
        # real need: a lock tells in no other way whether its holder waits
        assert not WARP._is_owned(), "others cannot launch"  # type: ignore[attr-defined]


OWNERS: WeakKeyDictionary[wp.array, int] = WeakKeyDictionary()
"""Which launcher was first to look at an array."""
SEEN: set[int] = set()
"""The launchers that looked at any."""


def _arrays_in(values: Iterable[Any]) -> Iterator[wp.array]:
    """The arrays among arguments of a launch, and those in structures."""
    for value in values:
        if isinstance(value, wp.array):
            yield value
        elif type(value).__name__ == "StructInstance":  # a name of Warp's own
            yield from _arrays_in(vars(value).values())


def test_threads_of_a_job_have_streams_of_their_own(
    device: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What solves and what draws share no memory, so that neither need wait for the other."""
    made: list[Owned] = []

    def owned(place: Any) -> Owned:
        made.append(Owned(place))
        return made[-1]

    def beside(launcher: Owned) -> Owned:
        made.append(copy(launcher))
        return made[-1]

    # real need: whose memory it is is known to nobody but who records launches
    monkeypatch.setattr("warp_kernels.device.device._emulated", owned)
    monkeypatch.setattr(Owned, "beside", beside)
    look = {"styles": (STYLES["paper"](), STYLES["edges"]()), "blend": 4}
    expected = film(tmp_path, "cpu", **look)
    np.testing.assert_array_equal(film(tmp_path, device, **look), expected)
    assert len(made) == 2
    assert {id(one) for one in made} == SEEN


@pytest.mark.parametrize("shared", [True, False])
def test_two_threads_on_a_card(device: str, shared: bool) -> None:
    """One solves meshes that grow, so that it captures again and again, and the other draws."""
    solving, errors = Device(device), []
    drawn_on = solving if shared else solving.beside()
    mesh = random_mesh(*SIZE, 60)
    snapshot = snapshot_of(solving, noise(*SIZE), mesh, COLOR_MODELS["linear"])
    renderer = Renderer(drawn_on, SIZE, SIZE, (STYLES["flat"](),))
    expected = renderer.render(snapshot)

    def draw() -> None:
        """Draw the same again and again."""
        try:
            for _ in range(20):
                np.testing.assert_array_equal(renderer.render(snapshot), expected)
        except BaseException as error:
            errors.append(error)

    drawing = Thread(target=draw)
    drawing.start()
    for number in range(12):
        grown = random_mesh(*SIZE, 20 + 20 * number)
        workspace = poisoned_workspace(solving, noise(*SIZE), grown, COLOR_MODELS["constant"])
        workspace.hold(np.zeros((grown.vertex_count, 4)))
        workspace.iterate(3, trust=0.5, regularity=1e-3)
        workspace.fit()
    drawing.join()
    assert not errors


class Intruder:
    """A launch during whose capture a copy is made."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self.bounds = SimpleNamespace(size=1)

    def launch(self) -> None:
        """Copy something instead."""
        array = self._device.empty(4, int)
        self._device.write(array, np.zeros(4))
        self._device.read(array, 4)


def test_a_copy_during_a_capture_is_found(device: str) -> None:
    """By the emulated card, as by a real one."""
    shared = Device(device)
    phase = Phase([Intruder(shared)], lambda number, begin, end: None, 1, 1)
    with pytest.raises(RuntimeError, match="captured"):
        shared.run([phase])


class TooMuch(Intruder):
    """A launch for which a card has no memory."""

    def launch(self) -> None:
        """Say what Warp says."""
        raise RuntimeError("Failed to allocate 8 bytes on device 'cuda:0'")


def test_a_full_card_is_told_in_one_line(device: str) -> None:
    """Wherever it is noticed: allocations say what would fit, and all else what to do."""
    shared = Device(device)
    phase = Phase([TooMuch(shared)], lambda number, begin, end: None, 1, 1)
    with pytest.raises(TrimotionError, match=r"^--device cuda-emulated: out of memory; .*cpu$"):
        shared.run([phase])
    array = shared.empty(3, int)  # who is refused leaves the card to others
    shared.write(array, np.arange(3))
    np.testing.assert_array_equal(shared.beside().read(array, 0), [])
    np.testing.assert_array_equal(shared.read(array, 3), [0, 1, 2])


def test_staged_copies_keep_their_order(device: str) -> None:
    """What is written last stands, whatever waits; columns and rows are read as they lie."""
    card = Device(device)
    first, second = card.empty((300, 13), wp.float64), card.empty(1000, wp.vec3i)
    card.write(first, np.zeros((300, 13)))
    card.write(first, np.ones((10, 13)))
    card.write(first, np.full((5, 13), 2.0))
    threes = np.arange(3000).reshape(1000, 3)
    card.write(second, threes)
    column, rows, some = card.read_all(
        [ArrayRows(first, 20, column=4), ArrayRows(second, 1000), ArrayRows(first, 6)]
    )
    np.testing.assert_array_equal(column, [2.0] * 5 + [1.0] * 5 + [0.0] * 10)
    np.testing.assert_array_equal(rows, threes)
    np.testing.assert_array_equal(some[:, 12], [2.0] * 5 + [1.0])
    large = card.empty((700, 700), wp.vec3ub)
    picture = noise(700, 700)
    card.write(large, picture)
    np.testing.assert_array_equal(card.read(large, 700), picture)
    assert len(card.read(second, 0)) == 0
