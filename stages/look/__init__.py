"""A snapshot as it is drawn: paint, cross-fades, the contact sheet."""
