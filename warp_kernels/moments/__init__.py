"""Sums over pixels: what is summed, prefix tables, walks along edges, fragments."""
