"""The commands: their grammar, and what each one prints or runs."""
