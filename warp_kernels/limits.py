"""Bounds that the arithmetic of the kernels sets."""

MAX_SIDE = 8192
"""Largest width or height [px]: keeps an edge's remainder below 2^30 and prefix sums in int32."""
SAMPLES = 3
"""Samples of an output pixel, across and down each, if nothing is said."""
MAX_SAMPLES = 4
"""The most of them: a table has a row for every set of a pixel's samples."""
