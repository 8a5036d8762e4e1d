"""`--cluster ADDRESS`: shots go to the workers of a Dask cluster."""
