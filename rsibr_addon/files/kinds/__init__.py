"""The content of each kind of map set, read from its file: a module for each kind."""
