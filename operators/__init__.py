"""Operators, one per file; thin: properties to settings, then a task."""
