"""The command `styles`: what there is, as a list and as a sheet of pictures."""
