"""[Cabral1999]: a material seen from all around."""
