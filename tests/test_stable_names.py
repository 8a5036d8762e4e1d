"""A kernel is found again in the cache, whatever was compiled before it."""

from typing import Any

import warp as wp

from tests.noted_kernels import kernels_of_jobs
from warp_kernels.color_model import LINEAR
from warp_kernels.device.compiling.stable_names import forget_loop_constants
from warp_kernels.energy import fit
from warp_kernels.moments.moment_layout import layout_of_moments

BLOCK = 1


def name_of(kernel: Any) -> str:
    """The folder that Warp would look for."""
    return str(kernel.module.get_module_identifier(BLOCK))


def generate(kernel: Any) -> None:
    """Do what compiling does to the functions that a kernel shares with others."""
    options = kernel.module.resolve_options(wp.config) | {"output_arch": None}
    # real need: to compile it takes a second, and Warp names no other way
    wp._src.context.ModuleBuilder(kernel.module, options)


def test_compiling_changes_no_name() -> None:
    """Functions in common have constants that depend on a loop, which Warp hashes once known."""
    make = fit.fit_kernel.__wrapped__  # each call makes the kernel anew, as a process does
    layout = layout_of_moments(LINEAR)
    before = name_of(make(layout))
    compiled = make(layout)
    generate(compiled)
    forget_loop_constants([compiled.module])
    assert name_of(make(layout)) == before


def test_no_two_kernels_have_one_name() -> None:
    """Though the name tells less than the code does."""
    kernels = kernels_of_jobs()
    assert len({name_of(kernel) for kernel in kernels}) == len(kernels)
