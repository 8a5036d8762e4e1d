"""A source, from its header to upright RGB frames."""
