"""Kernels of the energy: moments, fits, gradients and gains of topology."""
