"""Filtering of environments, by harmonics of the sphere."""
