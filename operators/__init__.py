"""Operators, one per file; thin: properties to settings, then a task."""

from .bake_mips import RSIBR_OT_bake_mips
from .bake_tables import RSIBR_OT_bake_tables
from .capture_environment import RSIBR_OT_capture_environment
from .capture_views import RSIBR_OT_capture_views
from .reload_map_sets import RSIBR_OT_reload_map_sets

CLASSES: tuple[type, ...] = (
    RSIBR_OT_capture_views,
    RSIBR_OT_capture_environment,
    RSIBR_OT_bake_mips,
    RSIBR_OT_bake_tables,
    RSIBR_OT_reload_map_sets,
)
"""Every operator's class, in the order of registration."""
