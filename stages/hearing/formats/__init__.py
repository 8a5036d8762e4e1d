"""Files that tell of beats and sections, ours and those of other programs."""
