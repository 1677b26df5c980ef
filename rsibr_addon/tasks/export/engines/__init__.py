"""Light for engines: a preset for each, which writes what the engine loads without conversion."""
