"""What is worked on: the track, its source, the frames that are being edited."""
