"""Reflectance models and their lobes."""
