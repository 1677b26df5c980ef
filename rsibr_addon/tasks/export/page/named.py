"""Meshes that are named by texts, for a page: built in, of files, and objects of a Blender file."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ....core.errors import InputFileError
from ....host.blend_files import blend_name, is_open, open_blend
from ....host.blend_objects import objects_named
from ....host.meshes import TriangleMesh, mesh_of_objects, mesh_row
from ...methods.kinds import KINDS
from .own_material import in_own_materials
from .own_objects import OwnObject


def named_meshes(specs: Sequence[str], kind: str, look: Any) -> tuple[TriangleMesh | list[OwnObject], Any]:
    """What a page shows.

    Parameters
    ----------
    specs : sequence of str
        As `host.meshes.load_mesh` takes them, which then stand in a row; or ``FILE.blend:OBJECT`` or
        ``:OBJECT`` of the open file, see `objects_named`, all of one file, which is opened.
    kind : str
        Of the map set.
    look : Options
        Of this kind.

    Returns
    -------
    shown : TriangleMesh or list of OwnObject
        Objects where the kind and the look have own materials: see `in_own_materials`; else all in one mesh,
        within the unit sphere.
    look : Options
        See there.

    Raises
    ------
    InputFileError
        A file is missing or cannot be read, or not all are of one Blender file.
    SceneError
        An object is not there, or has no faces.
    """
    named = [blend_name(spec) for spec in specs]
    if not any(named):
        bare = next((spec for spec in specs if Path(spec).suffix.lower() == ".blend"), None)
        if bare is not None:
            raise InputFileError(f"{bare} is a file of objects: name one, {bare}:OBJECT, or all, {bare}:*.")
        return mesh_row(specs), look
    of_files = [each for each in named if each]
    files = {Path(file).resolve() if file else None for file, _ in of_files}
    if len(of_files) < len(specs) or len(files) > 1:
        raise InputFileError(
            f"{' and '.join(specs)} are not of one Blender file: bring them into one, or export "
            f"a page of each."
        )
    file = of_files[0][0]
    if file and not is_open(Path(file)):
        open_blend(Path(file))
    items, depsgraph = objects_named([name for _, name in of_files])
    if KINDS[kind].own and look.own:
        return in_own_materials(items, depsgraph, look)
    return mesh_of_objects(items, depsgraph), look
