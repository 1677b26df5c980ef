"""Operators, one per file; thin: properties to settings, then a task."""

CLASSES: tuple[type, ...] = ()
"""Every operator's class, in the order of registration."""
