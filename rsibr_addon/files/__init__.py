"""Everything on disk: environments, pictures, map sets; written atomically, checked when read."""
