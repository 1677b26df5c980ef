"""Environments by file, by the names of Blender's own, or the world."""

from pathlib import Path

from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.near_names import did_you_mean
from ...files.environments import read_environment
from ...host.installation import studio_environments

WORLD_HEIGHT = 512
"""Height in texels of the environment that a world is sampled into."""


def load_environment(spec: str | None, clamp: float | None = None, bare_world: bool = False) -> Environment:
    """An environment from a file, one of Blender's own, or the world of the open file.

    Parameters
    ----------
    spec : str or None
        A file as `files.environments.read_environment` takes it, or a name such as "forest"; None for the
        world as it is, sampled through Cycles.
    clamp : float, optional
        See `core.environment.usable_radiance`.
    bare_world : bool
        Whether a world's rotation and strength are left out.

    Returns
    -------
    Environment

    Raises
    ------
    InputFileError
        There is neither; or the file cannot be used.
    SceneError, RenderError
        There is no world, or none whose rotation and strength can be left out; or Cycles did not deliver its
        picture.

    Warns
    -----
    RsibrWarning
        See `files.environments.read_environment`.
    """
    if spec is None:
        from ...host.scenes import find_scene
        from ...host.worlds import sample_world, world_of

        return sample_world(world_of(find_scene(None)), WORLD_HEIGHT, clamp, bare_world)
    return read_environment(environment_file(spec), clamp)


def environment_file(spec: str) -> str:
    """The file that a text of `load_environment` names, which may be missing.

    Raises
    ------
    InputFileError
        There is no environment of this name.
    """
    own = studio_environments()
    # A folder may have the name of one of Blender's own
    if spec in own and not Path(spec).is_file():
        spec = str(own[spec])
    is_path = Path(spec).suffix or Path(spec).name != spec
    if not is_path and not Path(spec).exists():
        near = did_you_mean(spec, own)
        known = f", or one of {', '.join(own)}" if own else "; those with names come with Blender"
        raise InputFileError(f"There is no environment {spec}{near}: give a file{known}.")
    return spec
