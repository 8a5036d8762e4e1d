"""How an output is compared with its source: error, coherence, lives of triangles."""
