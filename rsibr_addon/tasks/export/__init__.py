"""Map sets for other programs."""
