"""The parts of `import trimotion`: what the command line can do, for Python programs."""
