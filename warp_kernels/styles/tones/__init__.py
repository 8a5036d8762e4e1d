"""Tonal art maps, drawn stroke by stroke: what hatching styles look into."""
