"""Materials by name, and their fingerprints."""

import hashlib
import json
import os
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..core.brdf.cycles_presets import PRESETS
from ..core.counted import in_short
from ..core.errors import InputFileError, SceneError
from ..core.near_names import did_you_mean
from ..files.digests import digest
from .blend_files import blend_name, check_there, unreadable
from .presets import build_preset

ORIGINAL = "RSIBR_ORIGINAL"
"""Environment variable: the file of which the open one is a copy, if it is one; empty if that has no name."""

GENERATED = (
    "generated_type",
    "generated_width",
    "generated_height",
    "use_generated_float",
    "generated_color",
)
"""What makes a generated tile of an image."""

MATRIX_DIGITS = 5
"""Decimals of an object's matrix: sines in it may differ in their last digits between processors."""


def load_material(spec: str) -> bpy.types.Material:
    """The material that `spec` names.

    Parameters
    ----------
    spec : str
        One of `PRESETS`; or ``FILE.blend:NAME``, a material of that file; or ``:NAME``, one of the
        open file.

    Returns
    -------
    bpy.types.Material
        A material of the open file; so call this within a `temporary_scene`.

    Raises
    ------
    InputFileError
        There is no such preset or file, or Blender cannot read it.
    SceneError
        The file holds no such material, or the material has no surface.
    """
    file, name = _parsed(spec)
    if file is None:
        material = build_preset(name)
    elif not file or _is_open(Path(file)):
        material = _named("This file", name, bpy.data.materials)
    else:
        material = _appended(Path(file), name)
    if surface_output(material) is None:
        raise SceneError(
            f"Material {material.name} has no surface: link a shader to the Surface of its Material Output."
        )
    return material


def names_in(path: Path) -> list[str]:
    """The names of the materials that a file of Blender holds.

    Raises
    ------
    InputFileError
        It is missing, or Blender cannot read it.
    """
    check_there(path)
    if _is_open(path):
        return [material.name for material in bpy.data.materials if material.library is None]
    try:
        with bpy.data.libraries.load(str(path)) as (found, _):
            return list(found.materials)
    except OSError as error:
        raise unreadable(path) from error


def surface_output(material: bpy.types.Material) -> bpy.types.Node | None:
    """The output node from which Cycles takes a material's surface; None where there is no surface."""
    tree = material.node_tree
    output = tree.get_output_node("CYCLES") if tree else None
    return output if output and output.inputs["Surface"].is_linked else None


def materials_changed(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether materials, or what they are made of, may have changed; within a handler of Blender's alone."""
    return any(map(depsgraph.id_type_updated, ("MATERIAL", "NODETREE", "IMAGE")))


def material_name(spec: str) -> str:
    """The name in a text that `load_material` takes."""
    return _parsed(spec)[1]


def material_file(spec: str) -> str:
    """The file in a text that `load_material` takes; empty for a preset and for the open file.

    Raises
    ------
    InputFileError
        The text names no material.
    """
    return _parsed(spec)[0] or ""


def names_other_file(spec: str) -> bool:
    """Whether `load_material` would open another file for a text.

    Raises
    ------
    InputFileError
        The text names no material.
    """
    file, _ = _parsed(spec)
    return bool(file and not _is_open(Path(file)))


def lasting_spec(spec: str) -> str:
    """A text that names the same material also when another file is open, if this file has a name."""
    return f"{open_path()}{spec}" if spec.startswith(":") else spec


def open_path() -> str:
    """Path of the open file, or of the one of which it is a copy; empty if that has no name."""
    return os.environ.get(ORIGINAL, bpy.data.filepath)


def fingerprint(material: bpy.types.Material | bpy.types.World) -> str:
    """A hash of the content of a material or world.

    Returns
    -------
    str
        SHA-256 of its nodes with all properties, unlinked inputs, links, groups and the content of images;
        names of datablocks and the layout of nodes do not count.
    """
    content = {"nodes": _tree_content(material.node_tree), "cycles": _struct_content(material.cycles)}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def node_fingerprint(node: bpy.types.Node) -> str:
    """A hash of the content of one node, as `fingerprint` of all."""
    return hashlib.sha256(json.dumps(_node_content(node), sort_keys=True).encode()).hexdigest()


def check_saved(material: bpy.types.Material | bpy.types.World) -> None:
    """Refuse a material or world with an image whose pixels only this Blender's memory holds.

    Raises
    ------
    SceneError
        An image was painted or computed, and no file has it yet.
    """
    unsaved = next((image for image in _images(material.node_tree) if image.is_dirty), None)
    if unsaved is not None:
        raise SceneError(
            f"Image {unsaved.name} has pixels that are not saved, so no bake would see them: save or pack it."
        )


def _images(tree: bpy.types.NodeTree | None) -> Iterator[bpy.types.Image]:
    """Images of a tree's nodes and of its groups."""
    for node in tree.nodes if tree else ():
        if image := getattr(node, "image", None):
            yield image
        yield from _images(getattr(node, "node_tree", None))


def _parsed(spec: str) -> tuple[str | None, str]:
    """File and name; None as the file of a preset, an empty one for the open file."""
    if spec in PRESETS:
        return None, spec
    parsed = blend_name(spec)
    if parsed is None:
        raise InputFileError(
            f"There is no material {spec}{did_you_mean(spec, PRESETS)}: name one of {', '.join(PRESETS)}, "
            f"or FILE.blend:NAME."
        )
    return parsed


def _is_open(path: Path) -> bool:
    return bool(open_path()) and path.exists() and path.samefile(open_path())


def _appended(path: Path, name: str) -> bpy.types.Material:
    check_there(path)
    try:
        with bpy.data.libraries.load(str(path)) as (found, wanted):
            _named(str(path), name, found.materials)
            wanted.materials = [name]
    except OSError as error:
        raise unreadable(path) from error
    appended: bpy.types.Material = wanted.materials[0]
    return appended


def _named(where: str, name: str, found: Any) -> Any:
    """The entry of `found` of that name; `found` holds materials or their names."""
    names = {getattr(item, "name", item): item for item in found}
    if name not in names:
        shown = in_short(sorted(names)) or "another file"
        raise SceneError(
            f"{where} holds no material {name}{did_you_mean(name, names)}: choose one of {shown}."
        )
    return names[name]


# A node's content: all properties except those that every node has; a few of these count too.
_LAYOUT = set(bpy.types.Node.bl_rna.properties.keys()) - {"mute"}


def _tree_content(tree: bpy.types.NodeTree | None) -> Any:
    if tree is None:
        return None
    links = [
        (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
        for link in tree.links
        if not link.is_muted
    ]
    nodes = {node.name: _node_content(node) for node in tree.nodes if node.bl_idname != "NodeFrame"}
    return {"nodes": nodes, "links": sorted(links)}


def _node_content(node: bpy.types.Node) -> Any:
    # The nodes Value and RGB keep their value in their output.
    sockets = [("input", socket) for socket in node.inputs if not socket.is_linked]
    sockets += [("output", socket) for socket in node.outputs]
    values = {
        f"{side} {socket.identifier}": _content(socket.default_value)
        for side, socket in sockets
        if hasattr(socket, "default_value")
    }
    return {"type": node.bl_idname, "values": values, **_struct_content(node, _LAYOUT)}


def _struct_content(struct: bpy.types.bpy_struct, skipped: Collection[str] = ()) -> dict[str, Any]:
    names = {prop.identifier for prop in struct.bl_rna.properties} - {"rna_type", "select", *skipped}
    return {name: _content(getattr(struct, name)) for name in names}


def _content(value: Any) -> Any:
    """Any property's value, as JSON values."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case set():
            return sorted(value)
        case bpy.types.NodeTree():
            return _tree_content(value)
        case bpy.types.Image():
            return _image_content(value)
        case bpy.types.Text():
            return value.as_string()
        case bpy.types.Object():  # Gives coordinates.
            return [value.name, _content(np.round(np.array(value.matrix_world), MATRIX_DIGITS).tolist())]
        case bpy.types.ID() | bpy.types.Node():
            return value.name
        case bpy.types.bpy_struct():
            return _struct_content(value)
        case _:  # vectors, colours, collections
            return [_content(item) for item in value]


def _image_content(image: bpy.types.Image) -> Any:
    return [image.source, image.alpha_mode, image.colorspace_settings.name, _pixels_content(image)]


def _pixels_content(image: bpy.types.Image) -> Any:
    """What an image's pixels are made of, so that they need not be read; themselves if nothing else is."""
    if image.is_dirty:
        return _pixels_digest(image)
    # As of tiles in files, so that a bake stays up to date when its images are packed
    if packed := [(each.tile_number, each.packed_file.data) for each in image.packed_files]:
        return [[number, hashlib.sha256(data).hexdigest()] for number, data in packed]
    tiles = [_tile_content(image, tile) for tile in image.tiles]
    return _pixels_digest(image) if None in tiles else tiles


def _tile_content(image: bpy.types.Image, tile: bpy.types.UDIMTile) -> Any:
    """What Blender generates a tile by, or its file's hash; None where it is neither generated nor a file."""
    if image.source == "GENERATED" or tile.is_generated_tile:
        return [tile.number, *(_content(getattr(tile, name)) for name in GENERATED)]
    file = Path(bpy.path.abspath(image.filepath, library=image.library).replace("<UDIM>", str(tile.number)))
    return [tile.number, digest(file)] if image.filepath and file.is_file() else None


def _pixels_digest(image: bpy.types.Image) -> str:
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return hashlib.sha256(pixels).hexdigest()
