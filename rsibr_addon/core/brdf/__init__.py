"""Reflectance models, one per file: parameters with ranges, and one function of two directions."""
