"""What the artist sees: panels, and the previews in the viewport."""

from . import bake_properties, result_properties
from .bake_panel import RSIBR_PT_bake
from .environment_panel import RSIBR_MT_pictures, RSIBR_PT_environment
from .live_panel import RSIBR_PT_live
from .material_panel import RSIBR_MT_live_models, RSIBR_MT_models, RSIBR_PT_material
from .method_panel import RSIBR_PT_method, RSIBR_PT_method_advanced
from .panel import RSIBR_PT_preview
from .preferences import RSIBR_AP_preferences
from .result_panel import RSIBR_PT_result, RSIBR_PT_result_lobes, RSIBR_PT_result_maps

CLASSES: tuple[type, ...] = (
    *bake_properties.CLASSES,
    *result_properties.CLASSES,
    RSIBR_AP_preferences,
    RSIBR_MT_models,
    RSIBR_MT_live_models,
    RSIBR_MT_pictures,
    RSIBR_PT_environment,
    RSIBR_PT_material,
    RSIBR_PT_method,
    RSIBR_PT_method_advanced,
    RSIBR_PT_bake,
    RSIBR_PT_preview,
    RSIBR_PT_live,
    RSIBR_PT_result,
    RSIBR_PT_result_maps,
    RSIBR_PT_result_lobes,
)
"""Every class, in the order of registration, which is that of the panels."""
