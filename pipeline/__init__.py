"""Knows time: options, the loop over frames, shots, progress and the command line."""
