"""[Kautz2000]: an environment filtered with the lobes of a material."""
