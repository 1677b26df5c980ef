"""Map sets against the truth."""
