"""What styles draw: their functions for Warp, apart from the parameters that the help shows."""
