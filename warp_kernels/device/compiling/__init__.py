"""How kernels are compiled once on a machine, by one process, and found again."""
