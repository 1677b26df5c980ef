"""Objects in their own materials, as a page draws them: meshes, materials and images."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....core.conventions import Array, Indices
from ....core.materials.principled import IDENTITY, Texture
from ....device.own_materials import MOST_TEXTURES, DrawnMaterial
from ....device.textured_materials import EXTENSIONS, drawn_rows
from ....device.textured_mesh import slot_ends, uv_attributes
from ....device.textures import GpuTexture
from ....files.packed_arrays import packed_floats
from ....files.png import png_of
from ....host.textured_meshes import TexturedMesh
from .contents import packed_texture
from .meshes import in_order_of_use, packed_mesh


@dataclass(frozen=True, eq=False)
class OwnObject:
    """An object that is shown in its own materials.

    Attributes
    ----------
    mesh : TexturedMesh
        In the object's coordinates.
    matrix : ndarray, shape (4, 4)
        To the world.
    slots : tuple of DrawnMaterial
        At least one; the graphics context that their textures belong to is active.
    """

    mesh: TexturedMesh
    matrix: Array
    slots: tuple[DrawnMaterial, ...]


@dataclass(frozen=True)
class Ball:
    """A sphere that holds points: the middle of their box, and the distance of the farthest."""

    centre: Array
    radius: float

    @classmethod
    def around(cls, positions: Array) -> "Ball":
        """That of positions, shape (V, 3)."""
        centre = 0.5 * (positions.min(axis=0) + positions.max(axis=0))
        return cls(centre, max(float(np.linalg.norm(positions - centre, axis=1).max()), 1e-9))

    @property
    def matrix(self) -> Array:
        """From the unit sphere to this one, shape (4, 4)."""
        matrix = np.diag([self.radius, self.radius, self.radius, 1.0])
        matrix[:3, 3] = self.centre
        return matrix


def world_positions(objects: Sequence[OwnObject]) -> Array:
    """The vertices of objects in the world, shape (V, 3)."""
    placed = [each.mesh.positions @ each.matrix[:3, :3].T + each.matrix[:3, 3] for each in objects]
    return np.concatenate(placed)


def packed_objects(objects: Sequence[OwnObject], antialiased: bool) -> dict[str, Any]:
    """What a page draws.

    Parameters
    ----------
    objects : sequence of OwnObject
        At least one.
    antialiased : bool
        See `OwnMaterials`.

    Returns
    -------
    dict
        "objects", each with its "mesh", its "model", a matrix by column, and "slots", the first and the last
        corner of each slot's triangles and its material; "materials", each with the numbers of its "block",
        the "images" that it samples and whether it is "opaque"; "images", and "most_images" of a material;
        and "fit", centre and radius of the sphere that the page shows.

    Raises
    ------
    RangeError
        A mesh is too large.
    """
    drawn = []
    materials: list[dict[str, Any]] = []
    images = _Images()
    places: dict[tuple[DrawnMaterial, tuple[str, ...]], int] = {}  # where materials are, for meshes' UV maps
    for each in objects:
        uv_maps = each.mesh.uv_maps
        for slot in each.slots:
            if (slot, uv_maps) not in places:
                places[slot, uv_maps] = len(materials)
                materials.append(_packed_material(slot, uv_maps, antialiased, images))
        ball = Ball.around(each.mesh.positions.astype(np.float64))
        ends, order = slot_ends(each.mesh.slots)
        begins = [0, *ends[:-1]]
        last = len(each.slots) - 1
        slots = [
            [3 * begin, 3 * end, places[each.slots[min(slot, last)], uv_maps]]
            for slot, (begin, end) in enumerate(zip(begins, ends, strict=True))
            if end > begin
        ]
        matrix = each.matrix @ ball.matrix
        drawn.append(
            {"mesh": _packed_mesh(each.mesh, ball, order), "model": matrix.T.ravel().tolist(), "slots": slots}
        )
    whole = Ball.around(world_positions(objects))
    fit = [*whole.centre.tolist(), whole.radius]
    return {
        "objects": drawn,
        "materials": materials,
        "images": images.packed,
        "most_images": MOST_TEXTURES,
        "fit": fit,
    }


def _packed_mesh(mesh: TexturedMesh, ball: Ball, by_slot: Indices) -> dict[str, Any]:
    """A mesh within the unit sphere, its triangles by slot, with what textures need."""
    order, triangles = in_order_of_use(mesh.triangles[by_slot])
    positions = (mesh.positions[order] - ball.centre) / ball.radius
    fitted = replace(mesh, positions=positions, normals=mesh.normals[order], triangles=triangles)
    attributes = uv_attributes(mesh.uv[order])
    if mesh.tangents is not None:
        attributes["tangent"] = mesh.tangents[order]
    return {**packed_mesh(fitted), **{name: packed_floats(values) for name, values in attributes.items()}}


def _packed_material(
    material: DrawnMaterial, uv_maps: tuple[str, ...], antialiased: bool, images: "_Images"
) -> dict[str, Any]:
    """A material; its images go behind the others."""
    rows, textures = drawn_rows(material, uv_maps, antialiased)
    numbers = []
    for number, texture in enumerate(textures):
        image = material.textures[texture]
        numbers.append(images.place(texture, image))
        if texture.extension == "CLIP":
            size = np.array([image.width, image.height])
            mapping = rows[2 * (number - MOST_TEXTURES) :][:2]
            mapping[:, :3] *= (size / (size + 2.0))[:, None]
            mapping[:, 2] += 1.0 / (size + 2.0)
    return {"block": rows.ravel().tolist(), "images": numbers, "opaque": material.is_opaque}


class _Images:
    """The images of a page.

    Attributes
    ----------
    packed : list of dict
    """

    def __init__(self) -> None:
        self.packed: list[dict[str, Any]] = []
        self._places: dict[Texture, int] = {}

    def place(self, texture: Texture, image: Any) -> int:
        """Where a texture's image is, a GPUTexture; where on a surface it lies makes no other of it."""
        looked_up = replace(texture, uv_map="", mapping=IDENTITY, covered=False)
        if looked_up not in self._places:
            self._places[looked_up] = len(self.packed)
            self.packed.append(_packed_image(texture, np.array(image.read()), image.format))
        return self._places[looked_up]


def _packed_image(texture: Texture, texels: Array, stored: str) -> dict[str, Any]:
    """An image as a page looks it up: bytes as PNG, floats as other textures are.

    A page's driver has no borders: what is clipped has one of its own.
    """
    extension = texture.extension
    if extension == "CLIP":
        texels, extension = np.pad(texels, ((1, 1), (1, 1), (0, 0))), "EXTEND"
    looked_up = {"extend": EXTENSIONS[extension], "closest": texture.closest}
    if texels.dtype == np.uint8:
        # The first row is the lowest, as WebGL takes it
        data = base64.b64encode(png_of(texels)).decode("ascii")
        return {"png": data, "srgb": stored == "SRGB8_A8", **looked_up}
    return {**packed_texture(GpuTexture("image", texels.astype(np.float32)))[0], **looked_up}
