"""How kernels are compiled: arithmetic that rounds alike everywhere, and one set of flags.

A kernel of `module="unique"` does not take over what its file sets for the file's module.
"""

from typing import Any

CPU_FLAGS = (
    "-march=native -mprefer-vector-width=512 -mllvm=-inline-threshold=9000"
    " -mllvm=-inline-cold-callsite-threshold=3000 -mllvm=-slp-recursion-max-depth=4"
    " -fdelayed-template-parsing -fpch-instantiate-templates"
)
"""Warp's own flags, and the widest registers that there are: sums and pixels fill them. The last
two shorten compiling alone: templates of Warp's headers that no kernel needs are only skimmed, and
those that all need are made once, with the headers.

The same for all kernels: the compiler reads Warp's headers once for every set of flags, which takes
it longer than most kernels do."""

EXACT: dict[str, Any] = {
    "enable_backward": False,
    "fuse_fp": False,
    "cpu_compiler_flags": CPU_FLAGS,
    "block_dim": 1,
}
"""No derivatives, and no multiplication fused with an addition: it would round once, where a
device without such an instruction rounds twice. Kernels are named for blocks of one thread, as a
launch on the CPU has them: for others the CPU would need a second name of each, and to find one
takes 3 ms."""
