"""What the artist sees: panels, and the previews in the viewport."""

from .panel import RSIBR_PT_preview

CLASSES: tuple[type, ...] = (RSIBR_PT_preview,)
"""Every panel's class, in the order of registration."""
