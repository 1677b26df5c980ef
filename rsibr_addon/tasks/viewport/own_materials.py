"""Objects shaded with their own materials: what is drawn of each slot, and what is to be said of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...core.errors import SceneError
from ...core.materials.packing import Picture, pictures_of, with_pictures
from ...core.materials.principled import Baked, Bump, Input, NormalMap, PrincipledInputs, Texture
from ...core.materials.stand_ins import BLACK, PLAIN, UNASSIGNED, readable, without_image
from ...device.image_textures import ImageTextures
from ...device.own_materials import MOST_TEXTURES, MOST_UV_MAPS, DrawnMaterial
from ...device.textured_materials import textures_of
from ...device.textures import GpuTexture
from ...host.images import has_pixels, image_of
from ...host.materials import surface_output
from ...host.principled import principled
from ...host.surfaces import INPUTS, NORMAL_INPUTS
from ...host.textured_meshes import MeshNeeds
from .baked_inputs import OF_ANOTHER_MESH, InputBakes, ShownInputs, Unwrapping

BakedTextures = tuple[tuple[Picture, Texture], ...]
"""What pictures hold."""

NO_IMAGES: Mapping[Texture, GpuTexture] = {}


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
    has_baked : bool
        Whether inputs of it have to be baked.
    unbaked : str
        Those that are not there yet, as a part of a sentence; empty for none.
    """

    name: str
    drawn: DrawnMaterial
    messages: tuple[str, ...] = ()
    has_baked: bool = False
    unbaked: str = ""

    @property
    def textures(self) -> tuple[Texture, ...]:
        """What it samples."""
        return tuple(self.drawn.textures)

    @property
    def tangent_map(self) -> str | None:
        """The UV map of its normal map's tangents, or of its coat's; None where it has no normal map."""
        both = self.drawn.inputs.normal, self.drawn.inputs.coat_normal
        normals = [each.normal if isinstance(each, Bump) else each for each in both]
        return next((each.uv_map for each in normals if isinstance(each, NormalMap)), None)


@dataclass(frozen=True, eq=False)
class ShownMaterials:
    """The materials of an object.

    Attributes
    ----------
    slots : tuple of DrawnMaterial
        At least one.
    needs : MeshNeeds
        What they need of the object's mesh.
    messages : tuple of str
        What an artist should know of them.
    unwrapping : Unwrapping or None
        What the mesh gets beside its UV maps.
    has_baked : bool
        Whether inputs of theirs have to be baked.
    """

    slots: tuple[DrawnMaterial, ...]
    needs: MeshNeeds
    messages: tuple[str, ...]
    unwrapping: Unwrapping | None
    has_baked: bool


class Materials:
    """The materials of objects, each read once until it may have changed.

    Parameters
    ----------
    inputs : InputBakes
        What was baked of them.
    """

    def __init__(self, inputs: InputBakes) -> None:
        self._inputs = inputs
        self._shown: dict[tuple[int, BakedTextures], ShownMaterial] = {}

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
        inputs = self._inputs.shown(evaluated.original, len(evaluated.data.loops))
        materials = [slot.material for slot in evaluated.material_slots] or [None]
        # A material in several slots is baked once, for the first of them
        firsts = [materials.index(material) for material in materials]
        shown = [
            self._of(material, tuple(inputs.of_slots.get(first, ())), inputs)
            for material, first in zip(materials, firsts, strict=True)
        ]
        has_baked = any(each.has_baked for each in shown)
        if has_baked:
            self._inputs.need(evaluated.original)
        needs = _needs(shown)
        messages = [_unbaked(each, evaluated, inputs) for each in shown if each.unbaked]
        messages += [message for each in shown for message in each.messages]
        messages += _missing_maps(evaluated, shown, needs, inputs.unwrapping)
        slots = tuple(each.drawn for each in shown)
        return ShownMaterials(slots, needs, tuple(dict.fromkeys(messages)), inputs.unwrapping, has_baked)

    def _of(self, material: Any, textures: BakedTextures, inputs: ShownInputs) -> ShownMaterial:
        if material is None:
            return NO_MATERIAL
        key = material.original.session_uid, textures
        if key not in self._shown:
            self._shown[key] = shown_material(material, textures, inputs.images)
        return self._shown[key]


NO_MATERIAL = ShownMaterial("", DrawnMaterial(UNASSIGNED))

LABELS = {**INPUTS, **NORMAL_INPUTS}
"""Field of `PrincipledInputs` -> input of Blender's node."""


def shown_material(
    material: Any, textures: BakedTextures = (), baked: Mapping[Texture, GpuTexture] = NO_IMAGES
) -> ShownMaterial:
    """Read a material.

    Parameters
    ----------
    material : bpy.types.Material
    textures : BakedTextures
        What was baked of it.
    baked : mapping of Texture to GpuTexture
        Their images, whole.
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
    has_baked = bool(pictures_of(inputs))
    reader = _Reader()
    inputs = readable(with_pictures(inputs, textures), reader.read)
    if isinstance(inputs.coat_normal, Bump) and inputs.coat_normal != inputs.normal:
        reader.unread["coat_normal"] = "a bump of its own"
    drawn = DrawnMaterial(inputs, ImageTextures(textures_of(inputs), image_of, baked))
    messages = tuple(_messages(name, inputs, reader))
    return ShownMaterial(name, drawn, messages, has_baked, _told(reader.unbaked))


class _Reader:
    """Reads a material's inputs, and keeps what cannot be shown of them.

    Attributes
    ----------
    unbaked, unread : dict
        Field of `PrincipledInputs` -> why it is not shown: not yet, or at all.
    lost : dict
        Names of images without pixels, as keys.
    """

    def __init__(self) -> None:
        self.unbaked: dict[str, str] = {}
        self.unread: dict[str, str] = {}
        self.lost: dict[str, None] = {}
        self._textures: set[Texture] = set()

    def read(self, field: str, value: Input | Baked) -> Input | None:
        """What is shown of an input; None for a stand-in."""
        if isinstance(value, Baked):
            self.unbaked[field] = value.reason
            return None
        if value.texture is None:
            return value
        if not value.texture.bake and not has_pixels(image_of(value.texture)):
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
        messages.append(f"Material {name} is shown with Blender's default for {_told(reader.unread)}.")
    if inputs.missing:
        messages.append(f"Material {name} is shown without {_listed(inputs.missing)}.")
    messages += [
        f"Image {image} of material {name} has no pixels and is shown pink: reload it, or find its file."
        for image in reader.lost
    ]
    return messages


def _unbaked(material: ShownMaterial, evaluated: Any, inputs: ShownInputs) -> str:
    """Why a material is not shown as it is baked."""
    if inputs is OF_ANOTHER_MESH:
        return (
            f"Material {material.name} shows Blender's default for {material.unbaked}: the bake of "
            f"{evaluated.name} lies face by face on the mesh that viewports show, and this one has other "
            f"faces. Give it a UV map, or modifiers that are the same for both."
        )
    return f"Until its bake is done, material {material.name} shows Blender's default for {material.unbaked}."


def _told(fields: Mapping[str, str]) -> str:
    """Fields and reasons as a part of a sentence; empty for none."""
    return _listed([f"{LABELS[field]} ({reason})" for field, reason in fields.items()]) if fields else ""


def _listed(things: Sequence[str]) -> str:
    """Things as a part of a sentence."""
    *first, last = things
    return f"{', '.join(first)} and {last}" if first else last


def _needs(shown: list[ShownMaterial]) -> MeshNeeds:
    """What materials need of a mesh, as far as there is room for it."""
    names = sorted({texture.uv_map for each in shown for texture in each.textures})
    return MeshNeeds(tuple(names[:MOST_UV_MAPS]), tuple(each.tangent_map for each in shown))


def _missing_maps(
    evaluated: Any, shown: list[ShownMaterial], needs: MeshNeeds, unwrapping: Unwrapping | None
) -> list[str]:
    """What is to be said of UV maps that an object does not have, or that there is no room for."""
    there = {each.name for each in evaluated.data.uv_layers}
    if unwrapping is not None:
        there.add(unwrapping[0])
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
