"""The experiments of the paper (Lawonn & Guenther, 2018, Sec. 6), redone on free pictures.

`python -m benchmarks.paper` writes one page of tables, plots and checks.
"""
