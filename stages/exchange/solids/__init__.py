"""Formats of 3D programs: x right, y up, z towards the viewer, in pixels of the source."""
