"""Making reflection tables: what a material is made of, how its parts are weighted, and the tables."""
