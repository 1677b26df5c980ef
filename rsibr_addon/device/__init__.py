"""Blender's gpu module: shaders, textures, passes. Knows core and gpu_shaders, not the interface."""

import bpy as bpy  # Outside Blender, the modules gpu and gpu_extras exist once bpy is imported.
