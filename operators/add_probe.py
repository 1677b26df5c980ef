"""Add the light of a room to what a mip chain is baked with."""

from dataclasses import replace
from typing import Any

import bpy

from ..rsibr_addon.core.options import Declared, declared_options
from ..rsibr_addon.files.kinds.registry import STORED
from ..rsibr_addon.host.bake_settings import existing
from ..rsibr_addon.host.installation import studio_environments
from ..rsibr_addon.host.option_properties import options_of, properties_of, show_option
from ..rsibr_addon.host.rooms import room_of
from ..rsibr_addon.settings.probes import ADD_PROBE, BETWEEN, ProbeOptions
from .at_once import Undoable


class _AddProbe(Undoable):
    """Add a room's light: its box or sphere is that of the active object, captured at the 3D cursor"""  # noqa: D400  (a tooltip)

    bl_idname = ADD_PROBE
    bl_label = "Add Probe"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the chosen method takes probes."""
        return bool(_listed(context))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for it, and offer the picture that was captured last."""
        offered: dict[str, Any] = {
            "light": context.scene.rsibr_bake.picture,
            "at": tuple(context.scene.cursor.location),
        }
        if context.object is not None:
            room, size, middle = room_of(context.object)
            offered |= {"room": str(room), "size": size, "middle": middle}
        for declared in declared_options(ProbeOptions):
            if declared.name in offered:
                show_option(declared, self, offered[declared.name])
        chosen: set[str] = context.window_manager.invoke_props_dialog(self)
        return chosen

    def work(self, context: bpy.types.Context) -> None:
        """Write it behind those that are there."""
        (listed,) = _listed(context)
        chosen = getattr(context.scene.rsibr_bake, context.scene.rsibr_bake.kind)
        probe = options_of(ProbeOptions, self)
        if probe.light not in studio_environments():
            light = existing(probe.light, "picture", "one that was captured in the room")
            probe = replace(probe, light=light)
        there = getattr(chosen, listed.name).strip()
        show_option(listed, chosen, BETWEEN.join([*([there] if there else []), probe.text]))


def _listed(context: bpy.types.Context) -> list[Declared]:
    """The option of the chosen method that lists probes, if it has one."""
    kind = context.scene.rsibr_bake.kind
    options = declared_options(STORED[kind].settings) if kind else ()
    return [each for each in options if each.option.adds == ADD_PROBE]


RSIBR_OT_add_probe = type(
    "RSIBR_OT_add_probe",
    (_AddProbe, bpy.types.Operator),
    {"__doc__": _AddProbe.__doc__, "__module__": __name__, **properties_of(ProbeOptions)},
)
