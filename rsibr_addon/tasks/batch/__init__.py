"""Many bakes at once: materials in environments, by methods."""
