"""A card that is emulated: what Warp generates for CUDA, compiled by g++, thread after thread.

What it shows without a card: that the branches for CUDA compute what those for the CPU do, in any
order of the threads, which is shuffled on purpose. What it cannot show: rounding of CUDA's own
library, streams, the time anything takes. It is a device for tests, `--device cuda-emulated`.
"""

import ctypes
import hashlib
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from threading import get_ident
from typing import Any

import warp as wp
from warp._src.context import ModuleBuilder, _build_launch_bounds_from_tuple, pack_arg

from warp_kernels.device.compiling.kernels import CUDA_BLOCK as BLOCK
from warp_kernels.device.launcher import Graph
from warp_kernels.device.runtime import EMULATED, WARP, quiet
from warp_kernels.errors import OptionError

STRIDE = 15485863
"""A prime: threads run in steps of it, modulo their number."""
FLAGS = ("-std=c++17", "-O1", "-fPIC", "-ffp-contract=off", "-fno-strict-aliasing", "-w")
"""No product is fused with a sum, as in every kernel."""

HEADER = f"""
#include <cstddef>
struct Indices {{ unsigned x, y, z; }};
static thread_local Indices threadIdx, blockIdx, blockDim, gridDim;
#define __global__
#define __launch_bounds__(...)
#define __cluster_dims__(...)
static inline int __ffsll(long long bits) {{ return __builtin_ffsll(bits); }}
static inline int atomicMax(int* at, int value)
{{
    const int before = *at;
    if (value > before) *at = value;
    return before;
}}
#define WP_TILE_BLOCK_DIM {BLOCK}
#define WP_NO_CRT
#define WP_NO_BFLOAT16
#include "builtin.h"
#define __CUDA_ARCH__ 900
extern "C" void _wp_assert(const char*, const char*, unsigned) {{ __builtin_trap(); }}
extern "C" int _wp_isfinite(double value) {{ return __builtin_isfinite(value); }}
extern "C" int _wp_isnan(double value) {{ return __builtin_isnan(value); }}
extern "C" int _wp_isinf(double value) {{ return __builtin_isinf(value); }}
"""
"""What a kernel finds on a card; Warp's own headers are read as the host's."""
LAUNCH = """
extern "C" void launch_NAME(unsigned blocks, unsigned stride, unsigned first, void** given) {
    gridDim = {blocks, 1, 1};
    blockDim = {BLOCK, 1, 1};
    const unsigned long long all = (unsigned long long)blocks * BLOCK;
    for (unsigned long long turn = 0; turn < all; ++turn) {
        const unsigned long long thread = (turn * stride + first) % all;
        blockIdx = {(unsigned)(thread / BLOCK), 0, 0};
        threadIdx = {(unsigned)(thread % BLOCK), 0, 0};
        NAME(GIVEN);
    }
}
"""
_PRELUDE = re.compile(r"^#define WP_\w+(?: \d+)?\n|^#include \"\w+\.h\"\n", re.MULTILINE)
_ENTRY = re.compile(r'extern "C" .*?__global__ void\s+(\w+)_cuda_kernel_forward\(([^{]*)\)\s*\{')


@dataclass
class Capture:
    """The sequence that is being captured, if any."""

    tape: list[Graph] | None = None
    """The launches so far."""
    thread: int | None = None
    """Who captures."""


class EmulatedLauncher:
    """Launches on an emulated card.

    Raises:
        OptionError: If there is no compiler.
    """

    def __init__(self, device: Any) -> None:
        if shutil.which("g++") is None:
            raise OptionError(f"--device {EMULATED}: needs the compiler g++; install it")
        self._device = device
        self._awaited: dict[Any, None] = {}
        self._capture = Capture()

    def beside(self) -> "EmulatedLauncher":
        """One for another thread: streams are not emulated, and a capture is everybody's."""
        return copy(self)

    def on_stream(self) -> AbstractContextManager[None]:
        """Nothing but the launches: there is one order for all."""
        return nullcontext()

    def expect(self, kernels: Iterable[Any]) -> None:
        """Name kernels that will be recorded."""
        self._awaited.update(dict.fromkeys(kernels))

    @property
    def awaits_kernels(self) -> bool:
        """Never before the first of them is recorded."""
        return False

    def compile_expected(self) -> None:
        """Leave that to whoever records the first of them."""

    def record(self, kernel: Any, arguments: Sequence[Any]) -> "EmulatedLaunch":
        """A launch that is not made yet."""
        self._awaited.setdefault(kernel)
        with WARP, quiet():
            _build_all(dict.fromkeys(awaited.module for awaited in self._awaited))
            self._awaited.clear()
            return EmulatedLaunch(self, kernel, arguments, self._device)

    def capture(self, launches: Sequence[Any]) -> Graph:
        """Note the launches, each with its size, instead of making them."""
        tape: list[Graph] = []
        self._capture.tape, self._capture.thread = tape, get_ident()
        try:
            for launch in launches:
                launch.launch()
        finally:
            self._capture.tape = self._capture.thread = None

        def replay() -> None:
            """Make them, one after the other."""
            for made in tape:
                made()

        return replay

    def make(self, launch: Graph) -> None:
        """Make a launch, or note it while a sequence is captured.

        Raises:
            RuntimeError: If another thread captures: a card would end both with error 906.
        """
        if self._capture.thread not in (None, get_ident()):
            raise RuntimeError("a launch while another thread captures")
        if self._capture.tape is None:
            launch()
        else:
            self._capture.tape.append(launch)

    def copy(self, target: wp.array, source: wp.array, size: int) -> None:
        """Copy bytes.

        Raises:
            RuntimeError: If a sequence is being captured: a card would end it with error 906.
        """
        if self._capture.thread is not None:
            raise RuntimeError("a copy while a sequence is captured")
        with WARP:
            wp.copy(target, source, count=size)

    def launch(self, launch: Any) -> None:
        """Make a recorded launch."""
        with WARP:
            launch.launch()

    def mark(self) -> None:
        """All is done already."""

    def wait(self, mark: None) -> None:
        """All is done already."""


class EmulatedLaunch:
    """A recorded launch, as Warp's.

    Args:
        launcher: Of the device.
        kernel: Its module is built.
        arguments: As for `wp.launch`.
        device: Warp's device that owns the memory.
    """

    def __init__(
        self, launcher: EmulatedLauncher, kernel: Any, arguments: Sequence[Any], device: Any
    ) -> None:
        self._launcher = launcher
        self._kernel = kernel
        self._kept, self._device = arguments, device
        self._function = _library_of(kernel.module)[f"launch_{kernel.get_mangled_name()}"]
        self._packed = [
            pack_arg(kernel, declared.type, declared.label, value, device)
            for declared, value in zip(kernel.adj.args, arguments, strict=True)
        ]
        self.set_dim(1)

    def set_param_at_index(self, index: int, value: Any) -> None:
        """Give another value for one argument."""
        declared = self._kernel.adj.args[index]
        self._packed[index] = pack_arg(
            self._kernel, declared.type, declared.label, value, self._device
        )

    def set_dim(self, size: int) -> None:
        """Set the number of threads."""
        self.bounds = _build_launch_bounds_from_tuple((size,), self._kernel.adj.kernel_dim)

    def launch(self) -> None:
        """Launch it, or note it if a sequence is being captured."""
        given = [self.bounds, *self._packed]
        pointers = (ctypes.c_void_p * len(given))(*map(ctypes.addressof, given))
        size = int(self.bounds.size)
        blocks, first = (ctypes.c_uint(number) for number in (-(-size // BLOCK), size // 3))
        function, kept = self._function, (given, self._kept)

        def made() -> None:
            """Run all threads; what the pointers lead to is kept."""
            _ = kept
            function(blocks, ctypes.c_uint(STRIDE), first, pointers)

        self._launcher.make(made)


_libraries: dict[Any, Any] = {}
"""What was built in this process, by Warp's module."""


def _library_of(module: Any) -> Any:
    return _libraries[module]


def _build_all(modules: Iterable[Any]) -> None:
    """Build what is missing, on all cores: the compiler is another process."""
    missing = {module: _source_of(module) for module in modules if module not in _libraries}
    if not missing:
        return
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        header = _compiled_header()
        built = pool.map(lambda source: _build(source, header), missing.values())
        _libraries.update(zip(missing, map(ctypes.CDLL, map(str, built)), strict=True))


def _source_of(module: Any) -> str:
    """C++ of a module: Warp's source for CUDA, and a function for each kernel that launches it."""
    options = {**module.resolve_options(wp.config), "block_dim": BLOCK, "output_arch": 90}
    source = str(ModuleBuilder(module, options, target="cuda").codegen("cuda"))
    # the header brings these, compiled; the first lines are all that name them
    head, body = source[:1000], source[1000:]
    text = '#include "card.h"\n' + _PRELUDE.sub("", head) + body
    for name, signature in _ENTRY.findall(source):
        given = ", ".join(
            f"*({declared.strip().rsplit(' ', 1)[0]}*)given[{number}]"
            for number, declared in enumerate(_parameters(signature))
        )
        launch = LAUNCH.replace("BLOCK", str(BLOCK)).replace("GIVEN", given)
        text += launch.replace("launch_NAME", f"launch_{name}").replace(
            "NAME", f"{name}_cuda_kernel_forward"
        )
    return text


def _parameters(signature: str) -> list[str]:
    """Declarations between the commas of a list that are not within brackets of types."""
    pieces, depth = [""], 0
    for character in signature:
        depth += (character in "<(") - (character in ">)")
        if character == "," and depth == 0:
            pieces.append("")
        else:
            pieces[-1] += character
    return pieces


def _folder() -> Path:
    """Where what was compiled is kept: beside Warp's kernels."""
    folder = Path(wp.config.kernel_cache_dir or "") / "emulated"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _native() -> Path:
    """Warp's headers."""
    return Path(wp.__file__).parent / "native"


def _compiled_header() -> Path:
    """The folder with the header and what g++ makes of it: most of what a kernel would cost."""
    folder = _folder() / _digest(HEADER)
    compiled = folder / "card.h.gch"
    if not compiled.exists():
        folder.mkdir(exist_ok=True)
        _put(folder / "card.h", HEADER)
        _compile(folder / "card.h", compiled, "-x", "c++-header")
    return folder


def _build(source: str, header: Path) -> Path:
    """The library of a source, compiled unless it is there already."""
    name = _digest(HEADER + source)
    library, written = _folder() / f"{name}.so", _folder() / f"{name}.cpp"
    if not library.exists():
        _put(written, source)
        _compile(written, library, "-shared", f"-I{header}")
        written.unlink(missing_ok=True)
    return library


def _compile(source: Path, target: Path, *flags: str) -> None:
    """Call g++; other processes see the whole result or none."""
    part = target.with_suffix(f".{os.getpid()}.part")
    # the headers' own folder comes last: what is compiled already is found first
    command = ["g++", *FLAGS, *flags, f"-I{_native()}", "-o", part, source]
    made = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if made.returncode != 0:
        raise RuntimeError(f"g++ cannot compile {source}:\n{made.stderr}")
    part.replace(target)


def _put(path: Path, text: str) -> None:
    """Write a file that other processes see whole or not at all."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


def _digest(text: str) -> str:
    """A name for what is made of a text by this compiler and this Warp."""
    known = (text, FLAGS, wp.config.version, sys.platform)
    return hashlib.sha256(repr(known).encode()).hexdigest()[:16]
