"""Baking what of an object's materials only Cycles can evaluate."""

import hashlib
import json
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from ..core.conventions import Array
from ..core.errors import SceneError
from ..core.materials.packing import Picture, bytes_needed, pictures_of
from ..core.options import declared_options
from ..core.progress import Progress, Steps
from ..core.warned import warn
from ..files.atomic import check_target
from ..files.baked_inputs import BakedInputs, write_baked_inputs
from ..files.map_set_header import Recipe
from ..files.memory import check_memory
from ..host.bake_dependence import content_for_bakes, view_dependence
from ..host.bake_settings import SHAPED
from ..host.baked_inputs import baked_picture, layout_of
from ..host.materials import check_saved
from ..host.principled import principled
from ..host.scenes import find_object, find_scene
from ..host.version import software
from ..settings.baked_inputs import BakedInputsSettings, ObjectInputsSettings


def bake_inputs(name: str, settings: BakedInputsSettings, output: Path, force: bool) -> Steps[BakedInputs]:
    """Bake all inputs of an object's materials that are not followed, into one file.

    Parameters
    ----------
    name : str
        Of the object, in the open file.
    settings : BakedInputsSettings
    output : Path
        The file to write, NAME.exr.
    force : bool
        Whether it may be replaced.

    Returns
    -------
    BakedInputs
        What was written.

    Raises
    ------
    OutputFileError
        The output exists, or cannot be written.
    RangeError
        The pictures are too large for this machine's memory.
    SceneError
        There is no such object, it has no faces, or none of its materials has anything to be baked.
    RenderError
        Blender refuses a bake.

    Warns
    -----
    RsibrWarning
        Of the remarks of `BakedInputs`.
    """
    check_target(output, force, (".exr",))
    item, wanted = object_to_bake(name)
    count = sum(map(len, wanted.values()))
    check_memory(bytes_needed(count, settings.size), str(output), (settings.size, settings.size))
    yield Progress(0, count + 1, f"looking at the UV map of {name}")
    layout = layout_of(item, set(wanted), settings.size)
    made: dict[tuple[int, Picture], Array] = {}
    for slot, pictures in wanted.items():
        for picture in pictures:
            yield Progress(
                len(made) + 1, count + 1, f"baking {' and '.join(_words(each) for each in picture)}"
            )
            made[slot, picture] = baked_picture(item, slot, picture, layout, settings.samples)
    remarks = (*filter(None, (layout.remark,)), *_view_remarks(item, wanted))
    for remark in remarks:
        warn(remark)
    baked = BakedInputs(made, layout.uv_map, layout.corners, remarks)
    write_baked_inputs(output, baked, force)
    return baked


def object_to_bake(name: str) -> tuple[Any, dict[int, tuple[Picture, ...]]]:
    """An object of the open file, and what has to be baked of it: see `wanted_pictures`.

    Raises
    ------
    SceneError
        There is no such object, or nothing has to be baked of it.
    """
    item = find_object(name)
    wanted = wanted_pictures(item)
    if not wanted:
        raise SceneError(f"No material of {name} has an input that needs a bake: use its images as they are.")
    return item, wanted


def objects_to_bake(pattern: str) -> list[str]:
    """Names of the scene's objects of which something has to be baked.

    Parameters
    ----------
    pattern : str
        What they are called, with the signs of `fnmatch`; an object that has these in its name comes first.

    Raises
    ------
    SceneError
        There are none.
    """
    items = {item.name: item for item in find_scene(None).objects if item.type in SHAPED}
    meant = [pattern] if pattern in items else [name for name in items if fnmatchcase(name, pattern)]
    names = [name for name in meant if wanted_pictures(items[name])]
    if not names:
        raise SceneError(f"No object {pattern} of the scene needs a bake of its materials: correct the name.")
    return names


def wanted_pictures(item: Any) -> dict[int, tuple[Picture, ...]]:
    """What has to be baked of an object.

    Parameters
    ----------
    item : bpy.types.Object

    Returns
    -------
    dict of int to tuple of Picture
        Slot -> pictures. A material in several slots counts in the first of them; one that `principled`
        refuses, or cannot follow to its end, in none.
    """
    wanted: dict[int, tuple[Picture, ...]] = {}
    materials = [slot.material for slot in item.material_slots]
    for slot, material in enumerate(materials):
        if material is not None and materials.index(material) == slot:
            with suppress(SceneError, RecursionError):
                wanted[slot] = pictures_of(principled(material))
    return {slot: pictures for slot, pictures in wanted.items() if pictures}


def inputs_recipe(
    item: Any, wanted: dict[int, tuple[Picture, ...]], settings: BakedInputsSettings, depsgraph: Any
) -> Recipe:
    """The recipe of an object's baked inputs, the same for copies of an object.

    Parameters
    ----------
    item : bpy.types.Object
    wanted : dict of int to tuple of Picture
        See `wanted_pictures`.
    settings : BakedInputsSettings
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding `item`.

    Raises
    ------
    SceneError
        An image of its materials is not saved, or they are too long to follow.
    """
    for slot in wanted:
        check_saved(item.material_slots[slot].material)
    try:
        content = content_for_bakes(item, wanted, depsgraph)
    except RecursionError as error:
        raise SceneError(
            f"The materials of {item.name} have chains of nodes that are too long to follow: bake them to "
            f"images."
        ) from error
    content["pictures"] = [[slot, pictures] for slot, pictures in wanted.items()]
    return Recipe(
        kind=ObjectInputsSettings.KIND,
        settings={each.name: getattr(settings, each.name) for each in declared_options(BakedInputsSettings)},
        clamp=None,
        light="",
        material=hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest(),
        files=[],
        software=software(),
    )


def _view_remarks(item: Any, slots: dict[int, tuple[Picture, ...]]) -> tuple[str, ...]:
    materials = [item.material_slots[slot].material for slot in slots]
    return tuple(
        f"Material {material.name} depends on the view by {nodes}: it is baked as seen from straight above."
        for material in materials
        if (nodes := view_dependence(material))
    )


def _words(field: str) -> str:
    return field.replace("_", " ")
