"""From photographs, paintings and scenes to environments."""
