"""One picture solved: approximation, convergence, the search for a quality."""
