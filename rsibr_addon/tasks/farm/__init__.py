"""Batches on a farm: Flamenco, or what takes bundles of OpenJD."""
