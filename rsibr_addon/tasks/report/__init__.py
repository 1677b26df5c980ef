"""What a map set is, told and shown."""
