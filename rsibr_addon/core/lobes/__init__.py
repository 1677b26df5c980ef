"""Reflectance as a few radially symmetric lobes for each view elevation."""
