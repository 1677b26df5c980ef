"""What a web page shows at first."""

from dataclasses import dataclass

from ..core.options import option
from .drawing import ShownOptions
from .light import Clamp
from .matte import MatteOptions


@dataclass(frozen=True, kw_only=True)
class PageOptions(ShownOptions, MatteOptions, Clamp):
    """What a web page shows, until somebody orbits and moves its sliders."""


@dataclass(frozen=True, kw_only=True)
class MeshPageOptions(PageOptions):
    """The same of meshes that are named, and not selected."""

    mesh: tuple[str, ...] = option(
        ("sphere",),
        label="Mesh",
        help="sphere, monkey, a file (OBJ, PLY or STL) or FILE.blend:OBJECT, whose name may be a pattern as "
        "in FILE.blend:*; given several times, objects of one Blender file stand as they do there, and other "
        "meshes in a row",
        metavar="MESH",
    )
