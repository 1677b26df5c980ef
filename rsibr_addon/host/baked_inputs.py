"""Inputs of an object's materials that only Cycles can evaluate, baked into pictures."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import RenderError, SceneError
from ..core.materials.packing import Picture
from ..core.materials.unwrapping import fault_of, fitting_size, unwrapped
from .emission_nodes import emitting
from .mesh_arrays import corner_uv, read_property, triangle_corners, triangle_slots
from .meshes import evaluated_mesh
from .rendering import configure_cycles
from .scenes import temporary_scene

OWN = "RSIBR"
"""Name of an unwrapping of our own while it is baked on."""

LARGEST = 8192
"""Width of the largest picture."""

MARGIN = 16
"""Texels around a UV island that repeat its border, so that none of what surrounds it is looked up."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Where on pictures a surface lies.

    Attributes
    ----------
    size : int
        Width and height of the pictures in texels.
    uv_map : str
        A UV map of the object; empty where `corners` says it.
    corners : ndarray, shape (C, 2), float32, optional
        Place of each corner of the evaluated mesh.
    remark : str
        Why the object's own UV map will not do, in a sentence; empty where it does.
    """

    size: int
    uv_map: str = ""
    corners: Array | None = None
    remark: str = ""


def layout_of(item: bpy.types.Object, slots: set[int], size: int) -> Layout:
    """How an object is laid out on pictures: by the UV map that it renders with, if that will do.

    Parameters
    ----------
    item : bpy.types.Object
    slots : set of int
        The slots that are baked; other faces' places do not matter.
    size : int
        Wished width of the pictures.

    Raises
    ------
    SceneError
        The object has no faces, or more than the largest picture has cells.
    """
    name = item.name
    with temporary_scene() as scene, _stand_in(item, scene) as stand_in:
        layer = scene.view_layers[0]
        layer.update()
        with evaluated_mesh(stand_in, layer.depsgraph) as mesh:
            if not mesh.polygons:
                raise SceneError(f"Object {name} has no faces, so there is nothing to bake.")
            uv = corner_uv(mesh, "")
            fault = "is not there" if uv is None else _fault(mesh, uv, slots)
            if not fault:
                return Layout(size, next(each.name for each in mesh.uv_layers if each.active_render))
            corners = read_property(mesh.polygons, "loop_total", np.int32)[:, 0]
            areas = read_property(mesh.polygons, "area", np.float32)[:, 0]
    size = fitting_size(len(corners), size)
    if size > LARGEST:
        raise SceneError(f"Object {name} has {len(corners)} faces, too many to bake: give it a UV map.")
    remark = (
        f"The UV map of {name} {fault}, so its faces are baked one by one: a UV map without overlaps "
        f"shows more detail."
    )
    return Layout(size, "", unwrapped(corners, areas, size).astype(np.float32), remark)


def baked_picture(item: bpy.types.Object, slot: int, picture: Picture, layout: Layout, samples: int) -> Array:
    """Bake what one picture holds.

    Parameters
    ----------
    item : bpy.types.Object
        It, its materials and the scene stay as they are.
    slot : int
        Number of the slot whose material it is; others with that material are baked too.
    picture : Picture
    layout : Layout
        As `layout_of` returned it.
    samples : int
        Samples of a texel.

    Returns
    -------
    ndarray, shape (size, size, 3), float32
        As Cycles has the numbers, row 0 at the bottom. Beyond the surface, its border for 16 texels, then 0.

    Raises
    ------
    RenderError
        Blender refuses the bake.

    Notes
    -----
    The object is alone in the scene: nodes that look around, such as Ambient Occlusion, see itself only.
    """
    with temporary_scene() as scene, _stand_in(item, scene) as stand_in:
        if layout.corners is not None:
            _unwrap(stand_in, layout.corners)
        uv_map = layout.uv_map or OWN
        material = item.material_slots[slot].material
        glowing = emitting(material, picture, uv_map)
        image = bpy.data.images.new("RSIBR", layout.size, layout.size, float_buffer=True, is_data=True)
        target = glowing.node_tree.nodes.new("ShaderNodeTexImage")
        target.image = image
        glowing.node_tree.nodes.active = target
        dark = bpy.data.materials.new("RSIBR")
        # A material with an image of the artist's in its active node would be baked into that
        for own, theirs in zip(stand_in.material_slots, item.material_slots, strict=True):
            own.link = "OBJECT"
            own.material = glowing if theirs.material == material else dark
        _bake(scene, stand_in, uv_map, samples, MARGIN if layout.corners is None else 2)
        texels = np.empty(layout.size**2 * 4, np.float32)
        image.pixels.foreach_get(texels)
    return texels.reshape(layout.size, layout.size, 4)[..., :3]


def add_unwrapping(mesh: bpy.types.Mesh, name: str, corners: Array) -> None:
    """Give a mesh another UV map, behind the one that it renders with.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        No mesh of the artist's.
    name : str
    corners : ndarray, shape (C, 2), float32
        Place of each corner.

    Raises
    ------
    SceneError
        It has as many UV maps as Blender allows.
    """
    # Where there is no UV map, nodes see 0 for it: one that is all 0 keeps them from seeing ours
    none = () if mesh.uv_layers else (("RSIBR none", np.zeros_like(corners)),)
    for called, uv in (*none, (name, corners)):
        layer = mesh.uv_layers.new(name=called, do_init=False)
        if layer is None:
            raise SceneError(f"{mesh.name} has as many UV maps as Blender allows: remove one, to bake it.")
        layer.uv.foreach_set("vector", np.ascontiguousarray(uv, np.float32).ravel())


def _bake(scene: bpy.types.Scene, item: bpy.types.Object, uv_map: str, samples: int, margin: int) -> None:
    configure_cycles(scene, 4, 4, samples)
    layer = scene.view_layers[0]
    layer.objects.active = item
    item.select_set(True, view_layer=layer)
    with bpy.context.temp_override(
        scene=scene, view_layer=layer, active_object=item, object=item, selected_objects=[item]
    ):
        try:
            bpy.ops.object.bake(
                type="EMIT", margin=margin, margin_type="EXTEND", uv_layer=uv_map, use_clear=True
            )
        except RuntimeError as error:
            raise RenderError(f"Blender cannot bake {item.name}: {str(error).strip()}.") from error


@contextmanager
def _stand_in(item: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[bpy.types.Object]:
    """A copy of an object in a scene of ours, which renders as viewports show it.

    It has the object's name, by which Object Info makes random numbers.
    """
    name, theirs = item.name, bpy.context.scene.render
    scene.render.use_simplify = theirs.use_simplify
    scene.render.simplify_subdivision = theirs.simplify_subdivision
    scene.render.simplify_subdivision_render = theirs.simplify_subdivision
    copy = item.copy()
    scene.collection.objects.link(copy)
    if copy.type == "MESH":
        copy.data = copy.data.copy()
    else:
        copy = _as_mesh(copy, scene)
    copy.hide_render = copy.hide_viewport = False
    for modifier in copy.modifiers:
        modifier.show_render = modifier.show_viewport
        if hasattr(modifier, "render_levels"):
            modifier.render_levels = modifier.levels
    copy.rename(name, mode="ALWAYS")
    try:
        yield copy
    finally:
        copy.rename("RSIBR", mode="ALWAYS")
        if item.is_editable:
            item.rename(name, mode="ALWAYS")


def _as_mesh(item: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Object:
    """A curve, text or metaball as a mesh object of the same materials."""
    layer = scene.view_layers[0]
    layer.update()
    mesh = bpy.data.meshes.new_from_object(
        item.evaluated_get(layer.depsgraph), preserve_all_data_layers=True, depsgraph=layer.depsgraph
    )
    made = bpy.data.objects.new("RSIBR", mesh)
    made.matrix_world = item.matrix_world
    scene.collection.objects.unlink(item)
    scene.collection.objects.link(made)
    return made


def _fault(mesh: bpy.types.Mesh, uv: Array, slots: set[int]) -> str:
    """What is wrong with a UV map, as `fault_of` says it; materials may lie over each other."""
    corners, of_slots = triangle_corners(mesh), triangle_slots(mesh)
    mesh.calc_loop_triangles()
    areas = read_property(mesh.loop_triangles, "area", np.float32)[:, 0]
    faults = (fault_of(uv[corners[of_slots == each]], areas[of_slots == each]) for each in sorted(slots))
    return next(filter(None, faults), "")


def _unwrap(item: bpy.types.Object, corners: Array) -> None:
    """Give an object's evaluated mesh a UV map of the name `OWN`, whatever its modifiers make of it."""
    add_unwrapping(item.data, OWN, np.zeros((len(item.data.loops), 2), np.float32))
    places = bpy.data.meshes.new("RSIBR")
    places.vertices.add(len(corners))
    places.vertices.foreach_set("co", np.pad(corners, ((0, 0), (0, 1))).ravel())
    tree = bpy.data.node_groups.new("RSIBR", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    begin, end, info, sample, position, index, store = (
        tree.nodes.new(kind)
        for kind in (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeObjectInfo",
            "GeometryNodeSampleIndex",
            "GeometryNodeInputPosition",
            "GeometryNodeInputIndex",
            "GeometryNodeStoreNamedAttribute",
        )
    )
    info.inputs["Object"].default_value = bpy.data.objects.new("RSIBR", places)
    sample.data_type, sample.domain = "FLOAT_VECTOR", "POINT"
    store.data_type, store.domain = "FLOAT2", "CORNER"
    store.inputs["Name"].default_value = OWN
    for first, second in (
        (begin.outputs[0], store.inputs["Geometry"]),
        (info.outputs["Geometry"], sample.inputs["Geometry"]),
        (position.outputs[0], _enabled(sample.inputs, "Value")),
        (index.outputs[0], sample.inputs["Index"]),
        (_enabled(sample.outputs, "Value"), _enabled(store.inputs, "Value")),
        (store.outputs[0], end.inputs[0]),
    ):
        tree.links.new(first, second)
    item.modifiers.new("RSIBR", "NODES").node_group = tree


def _enabled(sockets: Any, name: str) -> bpy.types.NodeSocket:
    found: bpy.types.NodeSocket = next(each for each in sockets if each.name == name and each.enabled)
    return found
