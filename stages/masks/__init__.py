"""Grey pictures that lie over the source: masks of regions and maps of weights."""
