"""Objects shaded with their own materials: what is drawn of each slot, and what is to be said of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...core.errors import SceneError
from ...core.materials.principled import Baked, Bump, Input, NormalMap, PrincipledInputs, Texture
from ...core.materials.stand_ins import BLACK, PLAIN, UNASSIGNED, readable, without_image
from ...device.image_textures import ImageTextures
from ...device.own_materials import MOST_TEXTURES, MOST_UV_MAPS, DrawnMaterial, OwnMaterials
from ...device.textured_materials import textures_of
from ...host.images import has_pixels, image_of
from ...host.materials import surface_output
from ...host.principled import principled
from ...host.surfaces import INPUTS, NORMAL_INPUTS
from ...host.textured_meshes import MeshNeeds


@dataclass(frozen=True, eq=False)
class ShownMaterial:
    """A material as it is shown.

    Attributes
    ----------
    name : str
        Empty for no material.
    drawn : DrawnMaterial
    messages : tuple of str
        What is not shown of it, and why.
    """

    name: str
    drawn: DrawnMaterial
    messages: tuple[str, ...] = ()

    @property
    def textures(self) -> tuple[Texture, ...]:
        """What it samples."""
        return tuple(self.drawn.textures)

    @property
    def tangent_map(self) -> str | None:
        """The UV map of its normal map's tangents; None where it has no normal map."""
        normal = self.drawn.inputs.normal
        if isinstance(normal, Bump):
            normal = normal.normal
        return normal.uv_map if isinstance(normal, NormalMap) else None


@dataclass(frozen=True, eq=False)
class ShownMaterials:
    """The materials of an object.

    Attributes
    ----------
    look : OwnMaterials
    needs : MeshNeeds
        What they need of the object's mesh.
    messages : tuple of str
        What an artist should know of them.
    """

    look: OwnMaterials
    needs: MeshNeeds
    messages: tuple[str, ...]


class Materials:
    """The materials of objects, each read once until it may have changed."""

    def __init__(self) -> None:
        self._shown: dict[int, ShownMaterial] = {}

    def changed(self) -> None:
        """Read all materials anew when they are shown next."""
        self._shown.clear()

    def of(self, evaluated: Any) -> ShownMaterials:
        """What an object's slots show.

        Parameters
        ----------
        evaluated : bpy.types.Object
            Evaluated, and so are its materials: values of drivers are theirs, and what geometry nodes set.
        """
        shown = [self._of(slot.material) for slot in evaluated.material_slots] or [self._of(None)]
        needs = _needs(shown)
        messages = [message for each in shown for message in each.messages]
        messages += _missing_maps(evaluated, shown, needs)
        look = OwnMaterials(tuple(each.drawn for each in shown))
        return ShownMaterials(look, needs, tuple(dict.fromkeys(messages)))

    def _of(self, material: Any) -> ShownMaterial:
        if material is None:
            return NO_MATERIAL
        number = material.original.session_uid
        if number not in self._shown:
            self._shown[number] = shown_material(material)
        return self._shown[number]


NO_MATERIAL = ShownMaterial("", DrawnMaterial(UNASSIGNED))

LABELS = {**INPUTS, **NORMAL_INPUTS}
"""Field of `PrincipledInputs` -> input of Blender's node."""


def shown_material(material: Any) -> ShownMaterial:
    """Read a material.

    Parameters
    ----------
    material : bpy.types.Material
    """
    name = material.name
    try:
        inputs = principled(material)
    except SceneError as error:
        inputs = BLACK if surface_output(material) is None else PLAIN
        return ShownMaterial(name, DrawnMaterial(inputs), (str(error),))
    except RecursionError:
        told = f"Material {name} has chains of nodes that are too long to follow: bake them to images."
        return ShownMaterial(name, DrawnMaterial(PLAIN), (told,))
    reader = _Reader()
    inputs = readable(inputs, reader.read)
    drawn = DrawnMaterial(inputs, ImageTextures(textures_of(inputs), image_of))
    return ShownMaterial(name, drawn, tuple(_messages(name, inputs, reader)))


class _Reader:
    """Reads a material's inputs, and keeps what cannot be shown of them.

    Attributes
    ----------
    unread : dict
        Field of `PrincipledInputs` -> why it is not shown.
    lost : dict
        Names of images without pixels, as keys.
    """

    def __init__(self) -> None:
        self.unread: dict[str, str] = {}
        self.lost: dict[str, None] = {}
        self._textures: set[Texture] = set()

    def read(self, field: str, value: Input | Baked) -> Input | None:
        """What is shown of an input; None for a stand-in."""
        if isinstance(value, Baked):
            self.unread[field] = value.reason
            return None
        if value.texture is None:
            return value
        if not has_pixels(image_of(value.texture)):
            self.lost[value.texture.image] = None
            return without_image(value)
        if len(self._textures | {value.texture}) > MOST_TEXTURES:
            self.unread[field] = f"more than {MOST_TEXTURES} images"
            return None
        self._textures.add(value.texture)
        return value


def _messages(name: str, inputs: PrincipledInputs, reader: _Reader) -> list[str]:
    messages = []
    if reader.unread:
        told = [f"{LABELS[field]} ({reason})" for field, reason in reader.unread.items()]
        messages.append(
            f"Material {name} is shown with Blender's default for {_listed(told)}: "
            f"bake what makes it to an image."
        )
    if inputs.missing:
        messages.append(f"Material {name} is shown without {_listed(inputs.missing)}.")
    messages += [
        f"Image {image} of material {name} has no pixels and is shown pink: reload it, or find its file."
        for image in reader.lost
    ]
    return messages


def _listed(things: Sequence[str]) -> str:
    """Things as a part of a sentence."""
    *first, last = things
    return f"{', '.join(first)} and {last}" if first else last


def _needs(shown: list[ShownMaterial]) -> MeshNeeds:
    """What materials need of a mesh, as far as there is room for it."""
    names = sorted({texture.uv_map for each in shown for texture in each.textures})
    return MeshNeeds(tuple(names[:MOST_UV_MAPS]), tuple(each.tangent_map for each in shown))


def _missing_maps(evaluated: Any, shown: list[ShownMaterial], needs: MeshNeeds) -> list[str]:
    """What is to be said of UV maps that an object does not have, or that there is no room for."""
    there = {each.name for each in evaluated.data.uv_layers}
    messages = []
    for each in shown:
        asked = dict.fromkeys(
            [*(texture.uv_map for texture in each.textures), *filter(None, [each.tangent_map])]
        )
        for name in asked:
            if name not in there if name else not there:
                named = f"the UV map {name}" if name else "a UV map"
                messages.append(
                    f"{evaluated.name} does not have {named}, which material {each.name} asks for: add one."
                )
            elif name in {t.uv_map for t in each.textures} and name not in needs.uv_maps:
                messages.append(
                    f"The materials of {evaluated.name} use more than {MOST_UV_MAPS} UV maps, and images of "
                    f"material {each.name} on {name} are shown by one point: use fewer."
                )
    return messages
