"""Options whose text names a model, by sliders, colours and curves."""

from functools import partial
from typing import Any

import bpy

from ..core.options import Declared
from ..host.model_properties import NONE, curves_of, shown_keys, take_curves, text_of_curves
from .sentences import capital


def draw_model(layout: bpy.types.UILayout, group: Any, declared: Declared) -> None:
    """Show a model and its parameters, or its text where these do not say it all.

    Parameters
    ----------
    layout : bpy.types.UILayout
    group : bpy.types.PropertyGroup
        Has the properties of `host.model_properties`.
    declared : Declared
    """
    name = declared.name
    row = layout.row(align=True)
    keys = shown_keys(declared, group)
    if hasattr(group, f"{name}_model"):
        row.prop(group, f"{name}_model")
    else:
        row.prop(group, keys.pop(), text=declared.option.label)
    if getattr(group, name):
        _draw_reset(row, group, name)
    column = layout.column()
    for key in keys:
        column.prop(group, key)
    if curves := curves_of(declared, group):
        _draw_curves(column, group, declared, curves)
    elif not keys and getattr(group, f"{name}_model", NONE) != NONE:
        column.prop(group, name, text="Text")


def _draw_reset(row: bpy.types.UILayout, group: Any, name: str) -> None:
    """Show the button that takes the text away, so that the preset's or the baked one counts."""
    reset = row.operator("wm.context_set_string", text="", icon="LOOP_BACK")
    owner = "scene" if isinstance(group.id_data, bpy.types.Scene) else "object"
    reset.data_path, reset.value = f"{owner}.{group.path_from_id(name)}", ""


def _draw_curves(layout: bpy.types.UILayout, group: Any, declared: Declared, curves: tuple[str, ...]) -> None:
    """Show the widgets; while a panel is drawn nothing may be written, so that their text is taken after."""
    tree = getattr(group, f"{declared.name}_curves")
    if tree is None:  # The text is from elsewhere
        layout.prop(group, declared.name, text="Curves")
        return
    for curve in curves:
        layout.label(text=f"{capital(curve)}, grazing to facing views")
        layout.template_curve_mapping(tree.nodes[curve], "mapping")
    if text_of_curves(declared, group) != getattr(group, declared.name):
        path = group.path_from_id()
        bpy.app.timers.register(partial(_take, group.id_data.session_uid, path, declared), first_interval=0.0)


def _take(owner: int, path: str, declared: Declared) -> None:
    """Have the text of a group say what its curves do, if its owner is there still."""
    for item in (*bpy.data.objects, *bpy.data.scenes):
        if item.session_uid == owner and item.is_editable:
            take_curves(declared, item.path_resolve(path))
