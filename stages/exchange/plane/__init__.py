"""Where shapes and strokes lie in the plane of the picture, whatever format they are written to."""
