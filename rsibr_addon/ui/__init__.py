"""What the artist sees: panels, and the previews in the viewport."""

from . import bake_properties, result_properties
from .advanced_panel import RSIBR_PT_advanced, RSIBR_PT_method_advanced
from .light import RSIBR_MT_pictures, RSIBR_PT_light
from .live_panel import RSIBR_PT_live
from .look_panel import RSIBR_PT_look
from .map_set_panel import RSIBR_PT_map_set
from .models import RSIBR_MT_live_models, RSIBR_MT_models
from .preferences import INPUTS_GROUP, RSIBR_AP_preferences
from .preview_panel import RSIBR_PT_preview
from .render_engine import RSIBR_RE_previews
from .render_panel import RENDER_GROUP, RSIBR_PT_film, RSIBR_PT_mask, RSIBR_PT_passes, RSIBR_PT_render
from .result_panel import RSIBR_PT_result, RSIBR_PT_result_lobes, RSIBR_PT_result_maps

CLASSES: tuple[type, ...] = (
    *bake_properties.CLASSES,
    *result_properties.CLASSES,
    INPUTS_GROUP,
    RSIBR_AP_preferences,
    RSIBR_MT_models,
    RSIBR_MT_live_models,
    RSIBR_MT_pictures,
    RSIBR_PT_preview,
    RSIBR_PT_look,
    RSIBR_PT_live,
    RSIBR_PT_advanced,
    RSIBR_PT_method_advanced,
    RSIBR_PT_light,
    RSIBR_PT_map_set,
    RSIBR_PT_result,
    RSIBR_PT_result_maps,
    RSIBR_PT_result_lobes,
    RENDER_GROUP,
    RSIBR_RE_previews,
    RSIBR_PT_render,
    RSIBR_PT_film,
    RSIBR_PT_mask,
    RSIBR_PT_passes,
)
"""Every class, in the order of registration, which is that of the panels."""
