"""Everything on disk: environments, pictures, map sets; written atomically, read with suspicion."""
