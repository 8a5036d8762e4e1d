"""Who may ask for what, and what is answered."""
