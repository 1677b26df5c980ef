"""The library of assets of the materials that come with us, made in the background."""

from pathlib import Path

from ...job import CommandJob
from .bake_request import ObjectBake, in_background

TITLE = "Materials for the Asset Browser"


def assets_bake_in(folder: Path) -> ObjectBake:
    """Make everything ready to write the library in place of an earlier one.

    Parameters
    ----------
    folder : Path
        The library's.

    Raises
    ------
    SceneError
        See `bake_request.bake_of`.
    """
    output = folder / "materials.blend"
    job = CommandJob(("assets", "--output", str(output), "--force"))
    return in_background(TITLE, job, None, [], output, ObjectBake)
