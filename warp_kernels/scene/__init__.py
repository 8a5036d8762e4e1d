"""What a shader sees: triangles, their own coordinates, textures, the source's picture."""
