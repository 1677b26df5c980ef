"""Light alone, filtered with kernels of all widths: shades any Principled material."""
