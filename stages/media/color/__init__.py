"""Stored pixels to RGB and back: matrices, ranges, profiles, high dynamic range."""
