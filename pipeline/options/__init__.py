"""Options: what is declared, how values are read, and the job that they make."""
