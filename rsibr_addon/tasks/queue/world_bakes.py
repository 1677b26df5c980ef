"""Bakes of a scene's world, in whose light all materials are shaded."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.progress import Steps
from ...files.kinds.registry import STORED
from ...files.map_set import is_whole_map_set
from ...host.bake_settings import check_choices
from ...host.materials import check_saved
from ...host.option_properties import options_of
from ...host.preferences import make_writable
from ...host.scenes import worked_in
from ...host.world_light import world_light
from ...host.worlds import world_of
from ...settings.light import Clamp, Light
from ..methods.bake import bake
from ..methods.kinds import own_materials_kind
from .bake_request import BakeRequest, ObjectBake, in_background, output_for


@dataclass
class WorldBake(ObjectBake):
    """A bake of a scene's world."""


def world_request(scene: Any) -> BakeRequest:
    """What is baked of a scene's world, by the scene's settings: the same as for objects that follow it.

    Parameters
    ----------
    scene : bpy.types.Scene

    Raises
    ------
    SceneError
        There is no world, or it has an image that is not saved.
    RangeError
        Settings do not go together.
    """
    check_saved(world_of(scene))
    chosen, kind = scene.rsibr_bake, own_materials_kind()
    check_choices(chosen)
    settings = options_of(STORED[kind].settings, getattr(chosen, kind))
    bare = world_light(scene.world) is not None
    light = Light(clamp=options_of(Clamp, chosen).clamp, bare_world=bare)
    return BakeRequest(settings, light, None, {})


def world_file(scene: Any) -> Path:
    """The file of a scene's world as it is now, baked or not.

    Raises
    ------
    SceneError, RangeError
        See `world_request`.
    """
    return output_for(world_request(scene), scene, None)


def bake_world(scene: Any) -> Steps[Path]:
    """Bake a scene's world here, unless that is done.

    Raises
    ------
    RsibrError
        See `world_file`, `make_writable` and `methods.bake.bake`.
    """
    output = world_file(scene)
    if not is_whole_map_set(output):
        make_writable(output.parent)
        with worked_in(scene):
            yield from bake(world_request(scene).job(output))
    return output


def world_bake_of(scene: Any) -> WorldBake:
    """Make everything ready that a background Blender needs to bake a scene's world.

    Raises
    ------
    SceneError, OutputFileError
        See `world_file`, `make_writable` and `bake_request.in_background`.
    """
    request, output = world_request(scene), world_file(scene)
    make_writable(output.parent)
    return in_background(f"{scene.name}: world", request.job(output), scene, [], output, WorldBake)
