"""Blender's gpu module: shaders, textures, passes. Knows core and gpu_shaders, not the interface."""
