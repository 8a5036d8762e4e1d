"""Knows arrays: every Warp kernel, each with its launcher beside it, and all device memory."""
