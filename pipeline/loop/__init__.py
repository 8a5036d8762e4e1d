"""The loop over time: shots, motion between frames, threads and processes."""
