"""Operators, one per file; thin: properties to settings, then a task."""

from .capture_views import RSIBR_OT_capture_views

CLASSES: tuple[type, ...] = (RSIBR_OT_capture_views,)
"""Every operator's class, in the order of registration."""
