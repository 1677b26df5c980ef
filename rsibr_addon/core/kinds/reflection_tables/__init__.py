"""[Miller1984]: tables of what a material reflects."""
