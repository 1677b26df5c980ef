"""Operators, one per file; thin: properties to settings, then a task."""

from . import bake_kinds, export_formats
from .accept import RSIBR_OT_accept
from .add_materials import RSIBR_OT_add_materials
from .add_probe import RSIBR_OT_add_probe
from .apply_quality import RSIBR_OT_apply_quality
from .assemble_faces import RSIBR_OT_assemble_faces
from .assign import RSIBR_OT_assign
from .bake_again import RSIBR_OT_bake_again
from .bake_in_background import RSIBR_OT_bake
from .bake_inputs import RSIBR_OT_bake_inputs
from .bake_look import RSIBR_OT_bake_look
from .bake_world import RSIBR_OT_bake_world
from .cancel_bake import RSIBR_OT_cancel_bake
from .capture_environment import RSIBR_OT_capture_environment
from .compare import RSIBR_OT_compare
from .convert_light import RSIBR_OT_convert_light
from .discard_paint import RSIBR_OT_discard_paint
from .drag_split import RSIBR_OT_drag_split
from .edit_as_images import RSIBR_OT_edit_as_images
from .export_for_engine import RSIBR_OT_export_for_engine
from .export_page import RSIBR_OT_export_page
from .fit_lobes import RSIBR_OT_fit_lobes
from .lift_painting import RSIBR_OT_lift_painting
from .merge_brackets import RSIBR_OT_merge_brackets
from .open_comparison import RSIBR_OT_open_comparison
from .open_report import RSIBR_OT_open_report
from .pack import RSIBR_OT_pack
from .preview_scene import RSIBR_OT_preview_scene
from .rebake import RSIBR_OT_rebake
from .reload_map_sets import RSIBR_OT_reload_map_sets
from .save_back import RSIBR_OT_save_back
from .send_to_farm import RSIBR_OT_send_to_farm
from .unpack import RSIBR_OT_unpack
from .unwrap_ball import RSIBR_OT_unwrap_ball

CLASSES: tuple[type, ...] = (
    RSIBR_OT_capture_environment,
    RSIBR_OT_merge_brackets,
    RSIBR_OT_unwrap_ball,
    RSIBR_OT_assemble_faces,
    RSIBR_OT_convert_light,
    RSIBR_OT_lift_painting,
    *bake_kinds.CLASSES,
    RSIBR_OT_add_materials,
    RSIBR_OT_add_probe,
    RSIBR_OT_fit_lobes,
    RSIBR_OT_apply_quality,
    RSIBR_OT_bake,
    RSIBR_OT_preview_scene,
    RSIBR_OT_send_to_farm,
    RSIBR_OT_bake_again,
    RSIBR_OT_bake_inputs,
    RSIBR_OT_bake_look,
    RSIBR_OT_bake_world,
    RSIBR_OT_rebake,
    RSIBR_OT_cancel_bake,
    RSIBR_OT_assign,
    RSIBR_OT_accept,
    RSIBR_OT_pack,
    RSIBR_OT_unpack,
    RSIBR_OT_edit_as_images,
    RSIBR_OT_save_back,
    RSIBR_OT_discard_paint,
    RSIBR_OT_open_report,
    RSIBR_OT_open_comparison,
    *export_formats.CLASSES,
    RSIBR_OT_export_for_engine,
    RSIBR_OT_export_page,
    RSIBR_OT_compare,
    RSIBR_OT_reload_map_sets,
    RSIBR_OT_drag_split,
)
"""Every operator's class, in the order of registration."""
