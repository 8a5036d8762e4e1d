"""Compile every kernel that a job can launch for cards, without one, and print what each takes.

NVRTC comes with Warp. The oldest supported card gets PTX, in which every operation must be rounded
as the standard says, each on its own; the newer one gets machine code, which says how many
registers and how much local memory a thread takes. `--write` keeps these figures as those
of a release; without it kernels that take more than they did are told.

    python -m benchmarks.card_compile [--only WORD] [--write]
"""

import argparse
import csv
import multiprocessing
import os
import re
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

import warp as wp

from benchmarks.machine_code import usage_of
from tests.noted_kernels import kernels_of_card

OLDEST, NEWER = 75, 90
"""Compute capabilities."""
RECORD = Path(__file__).parents[1] / "docs" / "results" / "card_kernels.csv"
ARITHMETIC = re.compile(
    r"\b(?:add|sub|mul|fma|mad|div|sqrt|rcp|rsqrt|ex2|lg2|sin|cos|tanh)\.[\w.]*f(?:32|64)\b"
)
"""Instructions that compute in floating point."""
ROUNDED = re.compile(r"(?:mul|div|sqrt|rcp)\.rn\.f(?:32|64)|(?:add|sub)(?:\.rn)?\.f(?:32|64)")
"""Those that round as the standard says, each on its own."""


@dataclass(frozen=True)
class Compiled:
    """What became of one kernel."""

    kernel: str
    registers: int
    """Of a thread."""
    local_bytes: int
    """Memory of a thread for what finds no register, and for its arrays."""
    seconds: float
    problem: str
    """Nothing if all is right."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Compile, print, compare; 1 if something is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--only", default="", metavar="WORD", help="kernels whose name has it")
    parser.add_argument("--write", action="store_true", help=f"keep the figures in {RECORD.name}")
    options = parser.parse_args(arguments)
    begin = time.perf_counter()
    chosen = [n for n, kernel in enumerate(kernels_of_card()) if options.only in _name(kernel)]
    # children inherit the kernels; a compiler lets one thread of a process work at a time
    with multiprocessing.get_context("fork").Pool(os.cpu_count()) as pool:
        found = sorted(pool.imap_unordered(_compile, chosen), key=lambda compiled: compiled.kernel)
    _print(found, _recorded())
    wrong = [compiled for compiled in found if compiled.problem]
    took = time.perf_counter() - begin
    print(
        f"{len(found) - len(wrong)} of {len(found)} kernels compile for sm_{OLDEST} and sm_{NEWER}",
        end="",
    )
    print(f" ({took:.0f} s)")
    if options.write and not options.only:
        _write(found)
    return 1 if wrong else 0


def _compile(number: int) -> Compiled:
    """Compile one kernel for both cards."""
    kernel = kernels_of_card()[number]
    begin = time.perf_counter()
    problem, registers, local = "", 0, 0
    with tempfile.TemporaryDirectory() as folder:
        try:
            wp.config.log_level = wp.LOG_ERROR
            ptx, code = (
                Path(
                    wp.compile_aot_module(
                        kernel.module, arch=arch, module_dir=folder, use_ptx=arch == OLDEST
                    )[0]
                )
                for arch in (OLDEST, NEWER)
            )
            odd = set(ARITHMETIC.findall(ptx.read_text(encoding="utf-8")))
            odd = {operation for operation in odd if not ROUNDED.fullmatch(operation)}
            problem = f"rounds otherwise: {', '.join(sorted(odd))}" if odd else ""
            registers, local = usage_of(code.read_bytes(), kernel.key)
        except Exception as error:  # whatever the compiler says is the finding
            problem = f"{type(error).__name__}: {error}"
    return Compiled(_name(kernel), registers, local, time.perf_counter() - begin, problem)


def _name(kernel: Any) -> str:
    """A name that stays while code changes: where it stands among those of that name."""
    alike = [k for k in kernels_of_card() if k.func.__name__ == kernel.func.__name__]
    return f"{kernel.func.__name__}-{alike.index(kernel)}"


def _print(found: Sequence[Compiled], before: dict[str, tuple[int, int]]) -> None:
    """A line each."""
    print(f"{'kernel':32} {'registers':>9} {'local bytes':>11} {'seconds':>8}")
    for compiled in found:
        takes = compiled.registers, compiled.local_bytes
        was = before.get(compiled.kernel, takes)
        change = "" if was == takes else f"  was {was[0]}, {was[1]}"
        print(f"{compiled.kernel:32} {takes[0]:9} {takes[1]:11} {compiled.seconds:8.1f}{change}")
        if compiled.problem:
            print(f"    {compiled.problem}")


def _recorded() -> dict[str, tuple[int, int]]:
    """Registers and local bytes of the last release, by kernel."""
    if not RECORD.exists():
        return {}
    with RECORD.open(encoding="utf-8", newline="") as file:
        return {
            r["kernel"]: (int(r["registers"]), int(r["local_bytes"])) for r in csv.DictReader(file)
        }


def _write(found: Sequence[Compiled]) -> None:
    """Keep the figures."""
    with RECORD.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("kernel", "registers", "local_bytes"))
        writer.writerows(astuple(compiled)[:3] for compiled in found)


if __name__ == "__main__":
    sys.exit(main())
