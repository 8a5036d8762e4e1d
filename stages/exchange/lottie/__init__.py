"""Lottie: an animation of shapes for apps and web pages, with keyframes over triangles' lives."""
