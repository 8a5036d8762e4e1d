"""Knows arrays: every Warp kernel, each with its launcher beside it, and all device memory."""

import warp as wp

wp.config.log_level = wp.LOG_WARNING  # before Warp starts: a command's output is its own
