"""Fit lobes to a reflectance model or a material."""

from pathlib import Path
from typing import Any

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.tasks.reflectance.fit_lobes import FitSettings, fit_lobes
from .stepwise import Stepwise


class RSIBR_OT_fit_lobes(Stepwise, bpy.types.Operator):
    """Approximate how a material reflects by a few round lobes for each view elevation, into a file"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.fit_lobes"
    bl_label = "Fit Lobes"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)
    interrupted = "Fit interrupted; nothing was written"

    filepath = bpy.props.StringProperty(
        name="Fit",
        description="File to write",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    brdf = bpy.props.StringProperty(
        name="Reflectance",
        description="Model such as ward:alpha=0.04,ks=0.8; empty to measure the active object's material",
    )
    method = bpy.props.EnumProperty(
        name="Method",
        items=[
            ("joint", "Joint", "All profiles, colours and axes at once"),
            ("greedy", "Greedy", "Lobe after lobe, each a minimum profile, as Kautz & McCool"),
            ("single", "Single", "One lobe, a mean profile"),
            ("single-2d", "Single 2D", "One lobe that all elevations share"),
        ],
    )
    lobes = bpy.props.IntProperty(
        name="Lobes", description="For each layer of the material, at most", default=3, min=1, max=12
    )
    slices = bpy.props.IntProperty(name="Slices", description="View elevations", default=16, min=1, max=256)
    taps = bpy.props.IntProperty(
        name="Taps",
        description="Directions in which each lobe's map is looked up; 0 for as many as pay",
        default=0,
        min=0,
        max=9,
    )
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def work(self, context: bpy.types.Context) -> Steps[Any]:
        """See `Stepwise`."""
        item = context.active_object
        material = item and item.active_material
        if not self.brdf and not material:
            raise SceneError("There is no material to fit: select an object that has one, or name a model.")
        settings = FitSettings(self.method, self.lobes, self.slices, self.taps or None)
        output = Path(bpy.path.abspath(self.filepath))
        return fit_lobes(self.brdf or f"blend::{material.name}", settings, output, self.force)

    def finish(self, result: Any) -> None:
        """See `Stepwise`."""
        figures = result.report()
        self.report({"INFO"}, f"Fitted {figures['lobes']} lobes, E {figures['E']:.3g}")
