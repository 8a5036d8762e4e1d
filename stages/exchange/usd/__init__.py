"""USD: meshes that move in time, for film and 3D programs (extra `trimotion[usd]`)."""
