"""What a map set of each kind holds, read from its file: a module for each kind."""
