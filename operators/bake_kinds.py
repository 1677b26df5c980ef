"""Make a map set of any kind from a script or the search menu: one operator for each method."""

from typing import Any, ClassVar

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.options import declared_options
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.kinds.registry import STORED
from ..rsibr_addon.host.option_properties import options_of, properties_of
from ..rsibr_addon.job import BakeJob
from ..rsibr_addon.settings.light import Light
from ..rsibr_addon.settings.method import MethodSettings
from ..rsibr_addon.tasks.methods.bake import bake
from ..rsibr_addon.tasks.methods.method import Baked
from .file_properties import file_path
from .stepwise import Stepwise


class _BakeKind(Stepwise):
    """Base of the operators; their properties are the settings of the method and of the light."""

    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)
    interrupted = "Bake interrupted; started again, a capture goes on"
    proposed = "untitled.rsibr.exr"
    SETTINGS: ClassVar[type[MethodSettings]]

    filepath = file_path("Map Set")

    def work(self, context: bpy.types.Context) -> Steps[Baked]:
        """See `Stepwise`."""
        settings = options_of(self.SETTINGS, self, self._own_material(context))
        output = bpy.path.abspath(self.filepath)
        return bake(BakeJob(settings, output, options_of(Light, self), self.force))

    def finish(self, result: Baked) -> None:
        """Say where it is."""
        self.report({"INFO"}, f"Baked {result.path}")

    def _own_material(self, context: bpy.types.Context) -> str:
        """The active object's material, if the settings take one and none is given."""
        missing = [
            each.name
            for each in declared_options(self.SETTINGS)
            if each.option.materials and each.option.materials.own and not getattr(self, each.name)
        ]
        if not missing or getattr(self, "fit", None):
            return ""
        item = context.active_object
        if not item or not item.active_material:
            raise SceneError("There is no material to bake: select an object that has one, or name one.")
        return str(item.active_material.name)


def _operator(name: str, settings: type[MethodSettings]) -> type[bpy.types.Operator]:
    members: dict[str, Any] = {
        "__doc__": settings.SUMMARY,
        "bl_idname": f"rsibr.{name}",
        "bl_label": f"Bake {settings.LABEL}",
        "SETTINGS": settings,
        **properties_of(Light),
    }
    return type(f"RSIBR_OT_{name}", (_BakeKind, bpy.types.Operator), members)


CLASSES = tuple(_operator(f"bake_{kind}", stored.settings) for kind, stored in STORED.items())
"""Every operator's class."""
