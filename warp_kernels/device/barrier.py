"""Where the threads of a CPU team meet between two phases, inside a captured sequence."""

import ctypes

import warp as wp

from warp_kernels.device.exact import EXACT

wp.set_module_options(EXACT)

STRIDE = 16
"""Integers from one thread's counter to the next: a cache line, so that no two share one. One more
counter, not zero, tells everybody to wait no longer."""


@wp.func_native("""
#if !defined(__CUDA_ARCH__)
    typedef int Sleep(unsigned int);
    int* counters = (int*)flags_out.data;
    const int goal = __atomic_load_n(counters + 16 * number, __ATOMIC_RELAXED) + 1;
    __atomic_store_n(counters + 16 * number, goal, __ATOMIC_RELEASE);
    for (int other = 0; other < size; ++other) {
        int turns = 0;
        while (__atomic_load_n(counters + 16 * other, __ATOMIC_ACQUIRE) - goal < 0) {
            if (__atomic_load_n(counters + 16 * size, __ATOMIC_RELAXED)) return;
            // after a short busy wait the core is needed by a decoder or an encoder
            if (++turns > 10000 && pause) ((Sleep*)pause)(20);
        }
    }
#endif
""")
def wait_for_others(number: int, size: int, pause: wp.uint64, flags_out: wp.array(dtype=int)):
    """Count up the own counter and wait until all others have come as far."""
    ...


@wp.kernel(enable_backward=False)
def meet(
    # In:
    number: int,
    size: int,
    pause: wp.uint64,
    # In and out:
    flags_out: wp.array(dtype=int),
):
    """Wait for the other threads of a team; a launch of one thread.

    A phase lasts some hundred microseconds. Waking a sleeping thread takes tens of them, and the
    interpreter's lock as many; a short busy wait takes one.
    """
    wait_for_others(number, size, pause, flags_out)


def address_of_sleep() -> int:
    """Address of the C library's usleep, 0 where there is none."""
    try:
        function = ctypes.CDLL(None).usleep
    except (AttributeError, OSError, TypeError):
        return 0
    return ctypes.cast(function, ctypes.c_void_p).value or 0
