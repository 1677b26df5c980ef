"""Bake what no image says of previewed materials, in background Blenders."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.host.preferences import bakes_inputs_by_itself
from ..rsibr_addon.host.visible_surfaces import layer_of
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.background import Farm, State
from ..rsibr_addon.tasks.queue.input_bakes import InputBake, input_bake_of, inputs_file
from . import background
from .at_once import AtOnce


class RSIBR_OT_bake_inputs(AtOnce, bpy.types.Operator):
    """Bake what no image says of previewed materials, such as procedural textures, in the background"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_inputs"
    bl_label = "Bake Materials"

    by_itself = bpy.props.BoolProperty(
        name="By Itself",
        description="Bake again nothing that failed, and nothing if the preferences say so",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def work(self, context: bpy.types.Context) -> None:
        """Show what was baked before, and queue the other bakes."""
        depsgraph = context.evaluated_depsgraph_get()
        previews, bakes = session().previews, not self.by_itself or bakes_inputs_by_itself()
        inputs = previews.inputs
        # A layer that another window shows evaluates its objects by a depsgraph of its own
        for item in previews.with_baked_inputs([layer_of(context)]):
            if not self.by_itself:
                inputs.forgive(item)
            try:
                output = inputs_file(item, depsgraph)
            except (RsibrError, OSError) as error:
                inputs.forgive(item)  # its next file is another, whatever it wished before
                inputs.refuse(item, str(error))
                continue
            if inputs.wish(item, output) or output is None or not bakes or inputs.is_refused(item):
                continue
            try:
                _bake(context.scene, item, output)
            except (RsibrError, OSError) as error:
                inputs.refuse(item, str(error))


def _bake(scene: bpy.types.Scene, item: bpy.types.Object, output: Path) -> None:
    """Queue the bake that an object wishes, unless it is asked for already."""
    own = [each for each in session().bakes.bakes if isinstance(each, InputBake) and not each.elsewhere]
    # While one goes on, the latest wish waits for its end; others are forgotten
    for bake in own:
        if item.session_uid in bake.items:
            if bake.state is State.RUNNING or (bake.output == output and not bake.ended):
                return
            if bake.state is State.WAITING:
                bake.items.remove(item.session_uid)
                if not bake.items:
                    bake.cancel()
                    bake.tidy()
    queue_inputs(scene, item, output)
    session().previews.inputs.ask(item)


def queue_inputs(
    scene: bpy.types.Scene, item: bpy.types.Object, output: Path, farm: Farm | None = None
) -> None:
    """Bake an object's inputs, unless the same are being baked.

    Parameters
    ----------
    scene : bpy.types.Scene
    item : bpy.types.Object
    output : Path
        See `inputs_file`.
    farm : Farm, optional
        Does the bake.

    Raises
    ------
    RsibrError
        See `input_bake_of`.
    """
    if (same := session().bakes.unfinished(output)) is not None:
        same.items.append(item.session_uid)
    else:
        background.submit(input_bake_of(scene, item, output, farm))
