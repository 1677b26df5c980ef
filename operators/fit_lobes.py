"""Fit lobes to a reflectance model or a material."""

from pathlib import Path
from typing import Any

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.options import declared_options
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of, property_name
from ..rsibr_addon.settings.fit import FITTING, FitSettings
from ..rsibr_addon.tasks.reflectance.fit_lobes import fit_lobes
from .file_properties import file_path
from .stepwise import Stepwise

OF_MODELS, OF_CAPTURES = ("brdf", *FITTING), ("captured_views", "goal")
"""Options that count for a fit to a model, and to captures; the dialog forgets what it does not show."""


class RSIBR_OT_fit_lobes(Stepwise, bpy.types.Operator):
    """Fit a few round lobes to a material's reflection at each view elevation, and write them to a file"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.fit_lobes"
    bl_label = "Fit Lobes"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)
    SETTINGS = FitSettings
    interrupted = "Fit interrupted; nothing was written"
    proposed = "lobes.json"

    filepath = file_path("Fit")

    def draw(self: Any, context: bpy.types.Context) -> None:
        """Show what is fitted first, and of the other options those that count for it."""
        column = self.layout.column()
        column.use_property_split = True
        names = {each.name: property_name(each) for each in declared_options(FitSettings)}
        for name in ("captures", *(OF_CAPTURES if self.captures else OF_MODELS)):
            column.prop(self, names[name])
        column.prop(self, "force")

    def work(self, context: bpy.types.Context) -> Steps[Any]:
        """See `Stepwise`."""
        item = context.active_object
        material = item and item.active_material
        captures = getattr(self, "captures", "")
        if not getattr(self, "brdf", None) and not captures and not material:
            raise SceneError("There is no material to fit: select an object that has one, or name a model.")
        own = material.name if material and not captures else ""
        hidden = OF_MODELS if captures else OF_CAPTURES
        settings = options_of(FitSettings, self, own, without=hidden if self._asks else ())
        output = Path(bpy.path.abspath(self.filepath))
        return fit_lobes(settings, output, self.force)

    def finish(self, result: Any) -> None:
        """See `Stepwise`."""
        figures = result.report()
        left_out = figures.get("left_out")
        error = f", E {figures['E']:.3g}" if "E" in figures else ""
        error += f", error of views left out {left_out:.2g}" if left_out is not None else ""
        source = " to the material itself" if figures.get("source") == "material" else ""
        self.report({"INFO"}, f"Fitted {figures['lobes']} lobes{source}{error}")
