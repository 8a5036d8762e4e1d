"""How other programs show what is written as shapes."""
