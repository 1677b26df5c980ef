"""What a render lacks, baked here: nobody looks at a viewport that would have had it baked."""

from pathlib import Path
from typing import Any

from ...core.errors import SceneError
from ...core.progress import Steps
from ...files.baked_inputs import is_whole
from ...host.bake_settings import SHAPED, bakes_inputs_by_itself
from ..baked_inputs import bake_inputs
from ..queue.input_bakes import inputs_file, inputs_settings
from ..queue.world_bakes import bake_world


def bake_for_render(scene: Any, depsgraph: Any) -> Steps[list[tuple[Any, Path]]]:
    """Bake a scene's world, and the inputs of its materials that have to be baked.

    Parameters
    ----------
    scene : bpy.types.Scene
    depsgraph : bpy.types.Depsgraph
        Of the scene as viewports show it.

    Returns
    -------
    list of (bpy.types.Object, Path)
        Each object's file of baked inputs. An object that cannot be baked has none.

    Raises
    ------
    RsibrError
        The world cannot be baked: see `bake_world`.
    """
    if scene.world is not None:
        yield from bake_world(scene)
    found = []
    for item in [each for each in scene.objects if each.type in SHAPED and not each.hide_render]:
        try:
            path = inputs_file(item, depsgraph)
            if path is not None and bakes_inputs_by_itself() and not is_whole(path):
                yield from bake_inputs(item.name, inputs_settings(), path, force=True)
        except (SceneError, RecursionError):  # which the picture's messages tell
            continue
        if path is not None:
            found.append((item, path))
    return found
