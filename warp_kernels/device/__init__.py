"""The device: where kernels run, its threads and its phases."""
