"""Broken media, presets and tracks by thousands: what is not told in one line, hangs or grows."""
