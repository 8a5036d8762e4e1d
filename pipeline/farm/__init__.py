"""What is handed to the machines of a farm: one job of many parts, written for its engine."""
