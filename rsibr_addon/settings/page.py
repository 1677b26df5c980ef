"""What a web page shows at first."""

from dataclasses import dataclass

from .drawing import MeshOptions, ShownOptions
from .light import Clamp


@dataclass(frozen=True, kw_only=True)
class PageOptions(ShownOptions, Clamp):
    """What a web page shows, until somebody orbits and moves its sliders."""


@dataclass(frozen=True, kw_only=True)
class MeshPageOptions(MeshOptions, PageOptions):
    """The same of a mesh that is no object of Blender's."""
