"""Bakes of objects' inputs in the background: which file an object needs today, and the job that makes it."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.options import to_plain
from ...files.output_paths import HASH_LETTERS
from ...host.bake_dependence import content_for_bakes
from ...host.bake_settings import baked_folder, chosen_inputs_settings
from ...host.materials import check_saved
from ...host.option_properties import options_of
from ...host.version import software
from ...job import CommandJob
from ...settings.baked_inputs import BakedInputsSettings
from ..baked_inputs import wanted_pictures
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
        An image of its materials is not saved.
    OutputFileError
        The bakes' folder cannot be made.
    """
    wanted = wanted_pictures(item)
    if not wanted:
        return None
    materials = {slot: item.material_slots[slot].material for slot in wanted}
    for material in materials.values():
        check_saved(material)
    content = {
        **content_for_bakes(item, wanted, depsgraph),
        "pictures": [[slot, pictures] for slot, pictures in wanted.items()],
        "settings": to_plain(inputs_settings()),
        "software": software(),
    }
    letters = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:HASH_LETTERS]
    return baked_folder() / f"inputs-{letters}.exr"  # without names, as copies share it


def input_bake_of(scene: Any, item: Any, output: Path) -> InputBake:
    """Make everything ready that a background Blender needs to bake an object's inputs.

    Parameters
    ----------
    scene : bpy.types.Scene
    item : bpy.types.Object
    output : Path
        See `inputs_file`.

    Raises
    ------
    SceneError
        This is no Blender that could be started again.
    OutputFileError
        The open file cannot be copied.
    """
    chosen = to_plain(inputs_settings())
    options = [text for name, value in chosen.items() for text in (f"--{name}", str(value))]
    job = CommandJob(("inputs", item.name, *options, "--output", str(output), "--force"))
    return in_background(f"{item.name}: materials", job, scene, [item], output, True, InputBake)
