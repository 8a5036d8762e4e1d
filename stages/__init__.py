"""Knows one frame: the nouns (frame, mesh, snapshot) and what is done to them."""
