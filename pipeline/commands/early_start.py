"""The compiler starts while a first run still imports the rest of the program.

Before the first kernel it reads Warp's headers, which takes two seconds in each of its threads.
"""

from contextlib import suppress
from threading import Thread


def start_early(command: str, device: str) -> None:
    """Begin to compile in the background; what goes wrong is told by who needs the kernels.

    Args:
        command: What will be done: "render" draws alone, all others solve.
        device: "auto", "cpu" or "cuda:N".
    """
    Thread(target=_compile, args=(command, device), name="trimotion-early-start").start()


def _compile(command: str, name: str) -> None:
    """Compile what every such command needs and takes next to nothing to import."""
    with suppress(Exception):
        from warp_kernels.device.barrier import meet
        from warp_kernels.device.compiling.kernels import compile_early
        from warp_kernels.device.kernel_cache import settle_cache
        from warp_kernels.device.runtime import EMULATED, WARP, find_device, quiet

        if name == EMULATED:
            return
        if command == "render":
            from warp_kernels.drawing.gbuffer import fill_triangles as first
        else:
            from warp_kernels.energy.gradient_descent import descend as first
        with WARP, quiet():
            settle_cache()
            device = find_device(name)
            compile_early(device, [first] if device.is_cuda else [first, meet])
