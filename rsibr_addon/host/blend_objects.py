"""Objects of the open file by their names."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

import bpy

from ..core.errors import SceneError
from ..core.near_names import did_you_mean


def objects_named(patterns: Sequence[str]) -> tuple[list[bpy.types.Object], bpy.types.Depsgraph]:
    """Objects that the active view layer shows, in the order of the names, and what evaluates them.

    Parameters
    ----------
    patterns : sequence of str
        Names, or patterns as of files, which meshes alone match.

    Raises
    ------
    SceneError
        A name is of no object that is shown, or a pattern of no mesh.
    """
    shown = {item.name: item for item in bpy.context.view_layer.objects if item.visible_get()}
    meshes = [name for name, item in shown.items() if item.type == "MESH"]
    found: dict[str, bpy.types.Object] = {}
    for pattern in patterns:
        # A name may look like a pattern
        names = [pattern] if pattern in shown else [name for name in meshes if fnmatchcase(name, pattern)]
        if not names:
            raise SceneError(
                f"The file shows no object {pattern}{did_you_mean(pattern, meshes)}: name a mesh "
                f"that its active view layer shows."
            )
        found |= {name: shown[name] for name in names}
    return list(found.values()), bpy.context.evaluated_depsgraph_get()
