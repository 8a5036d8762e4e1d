"""The ways to sum over pixels."""

SUMS = ("edges", "fragments")
"""By their names, see `edge_moments` and `fragments`; the results are equal."""
