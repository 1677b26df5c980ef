"""Baking what of an object's materials only Cycles can evaluate."""

from contextlib import suppress
from pathlib import Path
from typing import Any

from ..core.conventions import Array
from ..core.errors import SceneError
from ..core.materials.packing import Picture, pictures_of
from ..core.progress import Progress, Steps
from ..core.warned import warn
from ..files.atomic import check_target
from ..files.baked_inputs import BakedInputs, write_baked_inputs
from ..files.memory import check_memory
from ..host.bake_dependence import view_dependence
from ..host.baked_inputs import baked_picture, layout_of
from ..host.principled import principled
from ..host.scenes import find_object
from ..settings.baked_inputs import BakedInputsSettings

TEXEL_BYTES = 60
"""Bytes of memory for a texel while it is baked, and what Cycles needs to do so."""


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
    item = find_object(name)
    wanted = wanted_pictures(item)
    count = sum(map(len, wanted.values()))
    if not count:
        raise SceneError(f"No material of {name} has an input that needs a bake: use its images as they are.")
    check_memory(TEXEL_BYTES * settings.size**2 * count, str(output), (settings.size, settings.size))
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


def _view_remarks(item: Any, slots: dict[int, tuple[Picture, ...]]) -> tuple[str, ...]:
    materials = [item.material_slots[slot].material for slot in slots]
    return tuple(
        f"Material {material.name} depends on the view by {nodes}: it is baked as seen from straight above."
        for material in materials
        if (nodes := view_dependence(material))
    )


def _words(field: str) -> str:
    return field.replace("_", " ")
