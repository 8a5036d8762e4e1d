"""What a file says as text: where its entries stand, and what is told if it is no TOML."""
