"""Blender's objects in their own materials, for a page."""

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ....core.at_once import AtOnce
from ....core.errors import SceneError
from ....core.materials.principled import Input, PrincipledInputs
from ....core.options import declared_options
from ....core.warned import warn
from ....device.context import ensure_context
from ....host.baked_inputs import add_unwrapping
from ....host.meshes import TriangleMesh, evaluated_mesh, mesh_of_objects
from ....host.textured_meshes import textured_mesh
from ...queue.input_bakes import inputs_file
from ...viewport.baked_inputs import InputBakes
from ...viewport.own_materials import Materials
from .own_objects import OwnObject


def own_objects(items: Sequence[Any], depsgraph: Any) -> list[OwnObject]:
    """Objects with the materials of their slots, and with what was baked of these.

    Parameters
    ----------
    items : sequence of bpy.types.Object
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding them.

    Returns
    -------
    list of OwnObject
        Those that are meshes with faces.

    Raises
    ------
    SceneError
        None is.
    DeviceError
        There is no graphics driver.

    Warns
    -----
    RsibrWarning
        What is not shown of a material, and why, as in viewports.
    """
    ensure_context()
    inputs = InputBakes(AtOnce())
    meshes = [item for item in items if item.evaluated_get(depsgraph).type == "MESH"]
    for item in meshes:
        try:
            inputs.wish(item, inputs_file(item, depsgraph))
        except SceneError:  # which the material's messages tell
            continue
    while inputs.is_busy:
        inputs.upload()
    materials, found = Materials(inputs), []
    for item in meshes:
        evaluated = item.evaluated_get(depsgraph)
        shown = materials.of(evaluated)
        for message in shown.messages:
            warn(message)
        with evaluated_mesh(item, depsgraph) as mesh:
            if not mesh.polygons:
                continue
            if shown.unwrapping:
                add_unwrapping(mesh, *shown.unwrapping)
            given = textured_mesh(mesh, item.name, shown.needs)
        found.append(OwnObject(given, np.array(evaluated.matrix_world), shown.slots))
    if not found:
        raise SceneError("The selected objects have no faces to show: select meshes with faces.")
    return found


def in_own_materials(
    items: Sequence[Any], depsgraph: Any, look: Any
) -> tuple[TriangleMesh | list[OwnObject], Any]:
    """What shows objects in their own materials.

    Parameters, errors and warnings are those of `own_objects` and `look_of`.

    Returns
    -------
    shown : list of OwnObject or TriangleMesh
        All in one mesh, if `look_of` finds the constants of a material.
    look : Options
        With these, if so.
    """
    own = own_objects(items, depsgraph)
    plain = look_of(look, own)
    return (own, look) if plain is None else (mesh_of_objects(items, depsgraph), plain)


def look_of(look: Any, objects: Sequence[OwnObject]) -> Any | None:
    """A look with the constants of the material that all objects have, which sliders then change.

    Parameters
    ----------
    look : Options
        Of a kind that shades Principled materials.
    objects : sequence of OwnObject

    Returns
    -------
    Options or None
        None where there are several materials, or it has images, emits, or covers in part.
    """
    first, *others = [slot.inputs for each in objects for slot in each.slots]
    if any(other != first for other in others) or not _is_plain(first):
        return None
    constants: dict[str, Any] = {}
    for declared in declared_options(type(look)):
        read = getattr(first, declared.name, None)
        if isinstance(read, Input):
            least, most = declared.option.least, declared.option.most
            numbers = tuple(min(max(number, least), most) for number in read.constant)
            constants[declared.name] = numbers if declared.wanted is tuple else numbers[0]
    return replace(look, **constants)


def _is_plain(inputs: PrincipledInputs) -> bool:
    """Whether a look can be the material."""
    values = {each.name: getattr(inputs, each.name) for each in fields(inputs) if each.name != "missing"}
    given = [value for value in values.values() if value is not None]
    if any(not isinstance(value, Input) or value.texture for value in given):
        return False
    emitted = np.multiply(values["emission_color"].constant, values["emission_strength"].constant)
    return not np.any(emitted) and bool(values["alpha"].constant[0] >= 1.0)
