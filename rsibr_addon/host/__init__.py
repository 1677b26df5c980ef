"""Data of Blender (bpy): worlds, materials, cameras, meshes, and pictures by Cycles."""
