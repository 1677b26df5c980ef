"""What a material's inputs are, in words that know nothing of Blender."""
