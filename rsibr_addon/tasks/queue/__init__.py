"""Bakes in the background."""
