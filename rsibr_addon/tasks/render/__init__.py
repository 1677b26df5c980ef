"""Pictures of a scene as its camera sees it."""
