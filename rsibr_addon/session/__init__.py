"""What lasts while the extension is enabled."""
