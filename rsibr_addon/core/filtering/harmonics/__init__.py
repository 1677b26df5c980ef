"""Spherical harmonics of a latitude-longitude map: analysis, and synthesis in any directions.

The derivations, with the equation numbers that the code cites, are in docs/prefiltering.md.
"""
