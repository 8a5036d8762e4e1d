"""The source's sound, carried over or converted."""
