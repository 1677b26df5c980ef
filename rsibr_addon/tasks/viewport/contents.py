"""What view layers show: surfaces with a preview, and those that may hide them."""

from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from typing import Any

from ...core.conventions import Array
from ...device.drawing import GpuMesh
from ...host.live_light import is_live_name
from ...host.shadow_catchers import corners, floor_plane
from ...host.textured_meshes import MeshNeeds
from ...host.visible_surfaces import (
    Layer,
    Surface,
    View,
    is_hole,
    is_wanted,
    map_set_of,
    renders_surroundings,
    shown_layers,
    surfaces,
)
from ...host.world_light import AS_IT_IS, WorldLight
from .baked_inputs import InputBakes
from .faults import Faults
from .meshes import UploadedMeshes
from .own_materials import Materials, ShownMaterials
from .worlds import Worlds


@dataclass(frozen=True, eq=False)
class Drawable:
    """A surface, and what it is drawn with.

    Attributes
    ----------
    surface : Surface
    mesh : GpuMesh
        A `GpuTexturedMesh` where there are materials.
    materials : ShownMaterials or None
        Its own, if they were asked for.
    corners : ndarray, shape (8, 3), or None
        Of its bounds, in the mesh's coordinates, where shadows are caught.
    """

    surface: Surface
    mesh: GpuMesh
    materials: ShownMaterials | None = None
    corners: Array | None = None

    @property
    def needs(self) -> MeshNeeds | None:
        """What its materials need of its mesh."""
        return self.materials.needs if self.materials else None

    def is_seen(self, view: View) -> bool:
        """Whether a view shows it."""
        return view.shows(self.surface)


@dataclass(frozen=True, eq=False)
class Catcher:
    """A surface that shows nothing but the shadows on it.

    Attributes
    ----------
    drawable : Drawable
    plane : ndarray, shape (2, 3), or None
        See `floor_plane`.
    """

    drawable: Drawable
    plane: Array | None


@dataclass
class Contents:
    """What a view layer shows.

    Attributes
    ----------
    previews : list of Drawable
        Surfaces with a preview.
    others : list of Drawable or None
        Surfaces without a preview, if they were asked for.
    holes : list of Drawable
        Surfaces that make holes in the picture, where all are shaded.
    catchers : list of Catcher
        Surfaces that show the shadows on them, there.
    light : WorldLight
        The world's turn and strength.
    world : str
        What surfaces without a map set of their own are shaded from; empty where they are left to Blender.
    changed : bool
        Whether the scene has changed since.
    """

    previews: list[Drawable]
    others: list[Drawable] | None
    light: WorldLight = AS_IT_IS
    holes: list[Drawable] = field(default_factory=list)
    catchers: list[Catcher] = field(default_factory=list)
    world: str = ""
    changed: bool = False

    @property
    def all(self) -> list[Drawable]:
        """Everything that is on the GPU."""
        floors = [each.drawable for each in self.catchers]
        return [*self.previews, *(self.others or ()), *self.holes, *floors]

    def light_of(self, surface: Surface) -> WorldLight:
        """The world's turn and strength for a surface's map set; none for one that does not follow it."""
        return self.light if surface.follows else AS_IT_IS

    def casters(self, view: View) -> list[Drawable]:
        """What casts shadows on catchers in a view."""
        return [each for each in (*self.previews, *self.holes) if view.has_shadow_of(each.surface)]

    def serves(self, with_others: bool) -> bool:
        """Whether it is still right. Blender sends no notice of a map set that was packed or moved."""
        own = [each.surface for each in self.previews if not each.surface.in_world]
        paths = {each.item: each.path for each in own}
        return (
            not self.changed
            and (self.others is not None) == with_others
            and all(map_set_of(item) == path for item, path in paths.items())
        )

    def has_faulty(self, faults: Faults) -> bool:
        """Whether the file of an object, which can be shaded from the world's instead, cannot be had."""
        return bool(self.world) and any(
            faults.stands(each.surface.item) for each in self.previews if not each.surface.in_world
        )


class LayerContents:
    """What the shown view layers show, and their meshes on the GPU.

    Parameters
    ----------
    shows_own : callable
        Whether a surface is to be drawn with its own materials.
    inputs : InputBakes
        What was baked of materials.
    worlds : Worlds
        What surfaces without a map set of their own are shaded from.
    """

    def __init__(self, shows_own: Callable[[Surface], bool], inputs: InputBakes, worlds: Worlds) -> None:
        self.layers: dict[tuple[Layer, bool], Contents] = {}
        self._worlds = worlds
        self.meshes = UploadedMeshes()
        self._materials = Materials(inputs)
        self._shows_own = shows_own

    def scene_changed(self, materials: bool) -> None:
        """Look at each layer anew when it is drawn next; what is the same stays uploaded.

        Parameters
        ----------
        materials : bool
            Whether materials, or what they are made of, may have changed too.
        """
        if materials:
            self._materials.changed()
        for contents in self.layers.values():
            contents.changed = True

    def collect(self, view: View, with_others: bool, faults: Faults) -> Contents:
        """Find what a view layer shows, upload the meshes that are new, and let go of what nobody shows."""
        world = self._worlds.of(view.scene) if view.shades_all else ""
        contents = Contents([], [] if with_others else None, view.world_light, world=world)
        if view.shades_all or is_wanted():
            self._fill(contents, view, faults)
        else:
            faults.clear()
        self.layers[view.content] = contents  # at last: what fails above is tried again
        layers = {view.layer, *shown_layers()}
        self.layers = {content: each for content, each in self.layers.items() if content[0] in layers}
        shown = [each for layer in self.layers.values() for each in layer.all]
        self.meshes.keep({(each.surface.mesh, each.needs) for each in shown})
        return contents

    def previewed(self, layers: Collection[Layer] | None = None) -> list[Drawable]:
        """What has a preview, of some view layers or of all."""
        shown = [each for (layer, _), each in self.layers.items() if layers is None or layer in layers]
        return [each for contents in shown for each in contents.previews]

    def to_be_lit(self, view: View, lights: Collection[str]) -> dict[str, Surface]:
        """The surfaces in live light whose surroundings a viewport renders, by their lights.

        Parameters
        ----------
        view : View
            The viewport's.
        lights : collection of str
            Names of lights: see `live_name`.
        """
        contents = self.layers.get(view.content)
        first: dict[str, Surface] = {}  # instances share the light of their object
        for each in contents.previews if contents else ():
            if each.surface.path in lights and each.is_seen(view):
                first.setdefault(each.surface.path, each.surface)
        return {
            name: surface
            for name, surface in first.items()
            if renders_surroundings(view.space, surface.shown_by, self._layers_with(name))
        }

    def _layers_with(self, path: str) -> set[Layer]:
        """The view layers that show what is shaded from a file, or in a live light."""
        return {
            layer
            for (layer, _), contents in self.layers.items()
            if any(each.surface.path == path for each in contents.previews)
        }

    def _fill(self, contents: Contents, view: View, faults: Faults) -> None:
        for surface, evaluated in surfaces(view.depsgraph):
            if contents.world and self._is_matte(surface, evaluated, contents, view):
                continue
            lit = bool(surface.path) and not is_live_name(surface.path) and not faults.stands(surface.item)
            if contents.world and not lit:
                surface = replace(surface, path=contents.world, in_world=True, follows=True)
            if not surface.path:
                faults.forget(surface.item)
            found = contents.previews if surface.path else contents.others
            if found is None:
                continue
            own = surface.path and self._shows_own(surface)
            found += self._drawn(surface, evaluated, view, self._materials.of(evaluated) if own else None)

    def _is_matte(self, surface: Surface, evaluated: Any, contents: Contents, view: View) -> bool:
        """Whether a surface is not shaded, but changes what lies behind."""
        if is_hole(surface, view.depsgraph):
            contents.holes += self._drawn(surface, evaluated, view)
            return True
        if not surface.item.is_shadow_catcher:
            return False
        plane = floor_plane(evaluated)
        contents.catchers += [Catcher(each, plane) for each in self._drawn(surface, evaluated, view)]
        return True

    def _drawn(
        self, surface: Surface, evaluated: Any, view: View, materials: ShownMaterials | None = None
    ) -> list[Drawable]:
        """What a surface is drawn with; nothing for one without faces."""
        mesh = self.meshes.of(surface, evaluated, view.depsgraph, materials)
        bounds = corners(evaluated) if view.shades_all else None
        return [] if mesh is None else [Drawable(surface, mesh, materials, bounds)]
