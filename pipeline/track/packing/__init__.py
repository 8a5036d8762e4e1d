"""Arrays of a track as bytes, and back to the bit."""
