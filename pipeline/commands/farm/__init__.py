"""`trimotion plan` and `trimotion join`: a film in parts, and whole again."""
