"""Every kernel that a job can launch is compiled without fused multiplication and addition."""

import re
from pathlib import Path

import pytest
import warp as wp

from tests.noted_kernels import kernels_of_jobs

ARITHMETIC = re.compile(r"\b(?:add|sub|mul|fma|mad|div|sqrt|rcp|rsqrt|ex2|lg2)\.[\w.]*f(?:32|64)\b")
"""Instructions of a compiled kernel that compute in floating point."""
ROUNDED = re.compile(r"(?:mul|div|sqrt|rcp)\.rn\.f(?:32|64)|(?:add|sub)(?:\.rn)?\.f(?:32|64)")
"""Those that round as the standard says, each on its own: a product that says how it is rounded is
not fused with a sum, whether this says so or not."""


def test_no_kernel_fuses() -> None:
    """By the options that its module really has, as Warp resolves them."""
    kernels = kernels_of_jobs()
    names = {kernel.key.split("__")[-1] for kernel in kernels}
    for name in ("sum_row", "sum_along_edges", "solve_variants", "fit_colors", "descend"):
        assert any(name in known for known in names), (name, names)
    assert len(kernels) > 40
    fused = [k.key for k in kernels if k.module.resolve_options(wp.config)["fuse_fp"]]
    assert not fused


@pytest.mark.parametrize("name", ["solve_variants", "fit_colors", "descend"])
def test_compiled_kernels_round_as_the_cpu(name: str, tmp_path: Path) -> None:
    """As Warp compiles them for CUDA, which needs no card: three that decide about meshes."""
    if not wp.get_cuda_supported_archs():
        pytest.skip("this Warp has no compiler for CUDA")
    kernel = next(k for k in kernels_of_jobs() if k.key.split("__")[-1].startswith(name))
    (path,) = wp.compile_aot_module(kernel.module, arch=75, module_dir=tmp_path, use_ptx=True)
    found = set(ARITHMETIC.findall(Path(path).read_text(encoding="utf-8")))
    assert found
    assert all(map(ROUNDED.fullmatch, found)), found
