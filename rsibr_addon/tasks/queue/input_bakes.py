"""Bakes of objects' inputs in the background: which file an object needs today, and the job that makes it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.options import to_plain
from ...files.output_paths import HASH_LETTERS
from ...host.option_properties import options_of
from ...host.preferences import baked_folder, chosen_inputs_settings, make_writable
from ...job import BakeJob
from ...settings.baked_inputs import BakedInputsSettings, ObjectInputsSettings
from ..baked_inputs import inputs_recipe, wanted_pictures
from ..methods.recipe import recipe_hash
from .background import Farm
from .bake_request import ObjectBake, in_background


@dataclass
class InputBake(ObjectBake):
    """A bake of an object's inputs."""


def inputs_settings() -> BakedInputsSettings:
    """The settings that the user's preferences say."""
    chosen = chosen_inputs_settings()
    return BakedInputsSettings() if chosen is None else options_of(BakedInputsSettings, chosen)


def inputs_file(item: Any, depsgraph: Any) -> Path | None:
    """The file of baked inputs that an object needs as it is now.

    Parameters
    ----------
    item : bpy.types.Object
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding it.

    Returns
    -------
    Path or None
        Its name is a hash of all that it depends on. None where nothing of the object has to be baked.

    Raises
    ------
    SceneError
        An image of its materials is not saved, or they are too long to follow.
    """
    wanted = wanted_pictures(item)
    if not wanted:
        return None
    letters = recipe_hash(inputs_recipe(item, wanted, inputs_settings(), depsgraph))[:HASH_LETTERS]
    return baked_folder() / f"inputs-{letters}.exr"  # without names, as copies share it


def input_job(item: Any, output: Path) -> BakeJob[ObjectInputsSettings]:
    """The job that bakes an object's inputs. It replaces a file that is there now: a whole one would be used.

    Parameters
    ----------
    item : bpy.types.Object
    output : Path
        See `inputs_file`.
    """
    settings = ObjectInputsSettings(object=item.name, **to_plain(inputs_settings()))
    damaged = output.exists()
    return BakeJob(settings, str(output), force=damaged, if_missing=not damaged)


def input_bake_of(scene: Any, item: Any, output: Path, farm: Farm | None = None) -> InputBake:
    """Make everything ready to bake an object's inputs in a background Blender, or on a farm.

    Parameters
    ----------
    scene : bpy.types.Scene
    item : bpy.types.Object
    output : Path
        See `inputs_file`.
    farm : Farm, optional

    Raises
    ------
    SceneError
        This is no Blender that could be started again.
    OutputFileError
        The open file cannot be copied, or nothing can be written to the output's folder.
    """
    make_writable(output.parent)
    if farm is not None:
        output.unlink(missing_ok=True)  # it is damaged, and what a farm has made replaces no other file
    job, title = input_job(item, output), f"{item.name}: materials"
    return in_background(title, job, scene, [item], output, InputBake, farm)
