"""How the page and the program speak: JSON for what is asked and told, bytes for pictures."""
