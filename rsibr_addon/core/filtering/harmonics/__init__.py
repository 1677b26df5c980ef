"""Spherical harmonics of a latitude-longitude map: analysis, and synthesis in any directions.

Both are done by ducc0 [Reinecke2023]; the derivations, with the equation numbers that the code cites, are in
docs/prefiltering.md.
"""
