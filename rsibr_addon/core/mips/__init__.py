"""Ways to filter a cube map down to ever smaller ones: in texture space, and on the sphere."""
