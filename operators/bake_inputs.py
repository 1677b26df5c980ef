"""Bake what no image says of previewed materials, in background Blenders."""

import bpy

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.host.bake_settings import bakes_inputs_by_itself
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.background import State
from ..rsibr_addon.tasks.queue.input_bakes import InputBake, input_bake_of, inputs_file
from . import background
from .at_once import AtOnce

TOO_LONG = "The materials of {} have chains of nodes that are too long to follow: bake them to images."

CANCELLED = "The bake of the materials was cancelled: press Bake Materials to have it."


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
        running = session()
        bakes = not self.by_itself or bakes_inputs_by_itself()
        for item in running.previews.with_baked_inputs():
            try:
                _bake(context.scene, item, depsgraph, bakes, self.by_itself)
            except (RsibrError, OSError) as error:
                running.previews.inputs.refuse(item, str(error))
            except RecursionError:
                running.previews.inputs.refuse(item, TOO_LONG.format(item.name))


def _bake(
    scene: bpy.types.Scene,
    item: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    bakes: bool,
    by_itself: bool,
) -> None:
    """Have an object show the bake that it needs; where there is none, queue it, if `bakes`."""
    inputs = session().previews.inputs
    if not by_itself:
        inputs.forgive(item)
    output = inputs_file(item, depsgraph)
    if inputs.wish(item, output) or output is None or not bakes:
        return
    own = [each for each in session().bakes.bakes if isinstance(each, InputBake)]
    if by_itself and any(each.output == output and each.state is State.CANCELLED for each in own):
        inputs.refuse(item, CANCELLED)
    if inputs.is_refused(item):
        return
    # While one goes on, the latest wish waits for its end; others are forgotten
    for bake in own:
        if item.session_uid in bake.items:
            if bake.state is State.RUNNING or (bake.output == output and not bake.ended):
                return
            if bake.state is State.WAITING:
                bake.cancel()
                bake.tidy()
    if (same := session().bakes.unfinished(output)) is not None:
        same.items.append(item.session_uid)
    else:
        background.submit(input_bake_of(scene, item, output))
    inputs.ask(item)
