"""Bounds that the arithmetic of the kernels sets."""

MAX_SIDE = 8192
"""Largest width or height [px]: keeps an edge's remainder below 2^30 and prefix sums in int32."""
