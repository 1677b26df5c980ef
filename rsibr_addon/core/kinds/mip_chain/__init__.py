"""[Kautz2004]: a cube map, ever more filtered."""
