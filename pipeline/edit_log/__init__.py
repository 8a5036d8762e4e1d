"""Logs of edits by hand outside of the program: as files, and in tracks."""
