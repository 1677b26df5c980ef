"""Directions, cameras and meshes."""
