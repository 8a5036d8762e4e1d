"""Kernels that draw: coverage of samples, layers, blending, the canvas."""
