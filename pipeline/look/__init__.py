"""How solved frames are looked at on their way to the output: smoothing, regions, drawing."""
