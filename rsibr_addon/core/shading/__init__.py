"""The reference of every shading mode, per pixel; each has a twin in `gpu_shaders`."""
