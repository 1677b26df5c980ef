"""The library of assets of the materials that come with us, made in the background."""

from pathlib import Path
from typing import Any

from ...job import CommandJob
from .bake_request import ObjectBake, in_background

TITLE = "Materials for the Asset Browser"


def assets_bake_in(folder: Path, scene: Any) -> ObjectBake:
    """Make everything ready to write the library in place of an earlier one.

    Parameters
    ----------
    folder : Path
        The library's.
    scene : bpy.types.Scene

    Raises
    ------
    SceneError
        See `bake_request.bake_of`.
    """
    output = folder / "materials.blend"
    job = CommandJob(("assets", "--output", str(output), "--force"))
    return in_background(TITLE, job, scene, [], output, False, ObjectBake)
