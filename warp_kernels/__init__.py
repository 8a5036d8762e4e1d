"""Knows arrays: every Warp kernel, each with its launcher beside it, and all device memory."""

import warp as wp

wp.config.log_level = wp.LOG_ERROR  # before Warp starts, or it speaks of a missing CUDA driver
