"""An output, from its plan to the finished file."""
