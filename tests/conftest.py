"""What every test can ask for: a device, golden pictures, repeatable chance."""

import gc
import os
import random
import shutil
import signal
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import cv2
import hypothesis
import numpy as np
import pytest
import warp as wp

from tests.golden_images import compare_with_golden
from warp_kernels.device.barrier import meet
from warp_kernels.device.compiling.kernels import compile_early
from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.device.runtime import EMULATED, WARP, find_device, quiet

pytest_plugins = ("tests.browser_fixtures",)

GOLDEN_FOLDER = Path(__file__).parent / "golden"
SEED = 20180806

# Before Warp initialises, or it prints its greeting into the report.
wp.config.log_level = wp.LOG_WARNING

# Compiling a kernel takes longer than hypothesis' deadline, and a failure must come back tomorrow.
hypothesis.settings.register_profile("repeatable", derandomize=True, deadline=None)
hypothesis.settings.load_profile("repeatable")


# A shell that starts the suite in the background has it ignore Ctrl-C, which some tests press.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add `--update-golden` and `--emulated`."""
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="store what is rendered as the new golden pictures; look at them before a commit",
    )
    parser.addoption(
        "--emulated",
        action="store_true",
        help="run the tests of devices, and no others, on a card that is emulated (needs g++)",
    )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Choose the devices: CPU and CUDA, or the emulated card."""
    if "device" in metafunc.fixturenames:
        devices = {"cpu": "cpu", "cuda": "cuda:0"}
        if metafunc.config.getoption("--emulated"):
            devices = {"emulated": EMULATED}
        metafunc.parametrize("device", devices.values(), ids=devices, indirect=True)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """With `--emulated` only tests of the emulated card are left."""
    if config.getoption("--emulated"):
        items[:] = [item for item in items if "emulated" in item.name]


def pytest_collection_finish() -> None:
    """Spare the collector of garbage a look at thousands of tests, 0.2 s each time."""
    gc.freeze()


@pytest.fixture(scope="session", autouse=True)
def shared_cores() -> Iterator[None]:
    """Workers side by side share the cores: threads of one would wait for those of another."""
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    share = max(1, (os.cpu_count() or 1) // workers)
    with pytest.MonkeyPatch.context() as patch:
        # real need: the program asks the system how many cores there are
        patch.setattr(os, "cpu_count", lambda: share)
        yield


@pytest.fixture(scope="session", autouse=True)
def no_first_run(shared_cores: None) -> None:
    """Compile one kernel, so that what a first run says stands before no test's one line."""
    with WARP, quiet():
        settle_cache()
        compile_early(find_device("cpu"), [meet])


@pytest.fixture
def device(request: pytest.FixtureRequest) -> str:
    """Name a Warp device; CUDA is skipped where there is none, unless FAIL_WITHOUT_CUDA=1."""
    if request.param == EMULATED and shutil.which("g++") is None:
        pytest.skip("no g++ for the emulated card")
    if request.param == "cuda:0" and wp.get_cuda_device_count() == 0:
        absent = "no CUDA device"
        if os.environ.get("FAIL_WITHOUT_CUDA") == "1":
            pytest.fail(f"{absent}, and FAIL_WITHOUT_CUDA=1")
        pytest.skip(absent)
    return request.param


@pytest.fixture
def assert_matches_golden(
    request: pytest.FixtureRequest, tmp_path: Path
) -> Callable[[np.ndarray, str], None]:
    """Give `assert_matches_golden(actual, name)`, which compares with `tests/golden/<name>.png`.

    `actual` is [H, W, 3] uint8 RGB. A failure names the folder that holds actual, expected and
    difference.
    """
    return partial(
        compare_with_golden,
        golden_folder=GOLDEN_FOLDER,
        failure_folder=tmp_path / "golden_failures",
        update=request.config.getoption("--update-golden"),
    )


@pytest.fixture(autouse=True)
def _repeatable_chance() -> None:
    """Start every test from the same state of the global generators, whatever ran before it."""
    random.seed(SEED)
    np.random.seed(SEED)
    cv2.setRNGSeed(SEED)


@pytest.fixture
def rng() -> np.random.Generator:
    """Give a generator that starts the same for every test."""
    return np.random.default_rng(SEED)
