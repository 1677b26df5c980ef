"""What a render lacks, baked here: nobody looks at a viewport that would have had it baked."""

from pathlib import Path
from typing import Any

from ...core.errors import SceneError
from ...core.progress import Steps
from ...files.baked_inputs import is_whole
from ...host.bake_settings import SHAPED
from ...host.preferences import bakes_inputs_by_itself
from ...host.render_views import scenes_of_ours
from ...host.scenes import evaluated
from ..methods.bake import bake
from ..queue.input_bakes import input_job, inputs_file
from ..queue.world_bakes import bake_world


def bake_for_render(scene: Any) -> Steps[list[tuple[Any, Path]]]:
    """Bake the worlds of what is rendered with a scene, and the inputs of materials that have to be baked.

    Parameters
    ----------
    scene : bpy.types.Scene

    Returns
    -------
    list of (bpy.types.Object, Path)
        Each object's file of baked inputs. An object that cannot be baked has none.

    Raises
    ------
    RsibrError
        The world cannot be baked: see `bake_world`.
    """
    found = []
    for each in scenes_of_ours(scene):
        if each.world is not None:
            yield from bake_world(each)
        found += yield from _baked_inputs(each)
    return found


def _baked_inputs(scene: Any) -> Steps[list[tuple[Any, Path]]]:
    found, depsgraph = [], evaluated(scene)
    for item in [each for each in scene.objects if each.type in SHAPED and not each.hide_render]:
        try:
            path = inputs_file(item, depsgraph)
            if path is not None and bakes_inputs_by_itself() and not is_whole(path):
                yield from bake(input_job(item, path))
        except SceneError:  # which the picture's messages tell
            continue
        if path is not None:
            found.append((item, path))
    return found
