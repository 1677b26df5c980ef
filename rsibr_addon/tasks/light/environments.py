"""Environments by what a user calls them."""

from pathlib import Path

from ...core.environment import Environment
from ...core.errors import InputFileError
from ...files.environments import read_environment
from ...files.pictures import split_layer
from ...host.scenes import find_scene
from ...host.worlds import sample_world, studio_environments, world_of

WORLD_HEIGHT = 512
"""Of the environment that a world is sampled into, in texels."""


def load_environment(spec: str | None, clamp: float | None = None) -> Environment:
    """An environment from a file, one of Blender's own, or the world of the open file.

    Parameters
    ----------
    spec : str or None
        A file as `files.environments.read_environment` takes it, or a name such as "forest"; None for the
        world as it is, sampled through Cycles.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Returns
    -------
    Environment

    Raises
    ------
    InputFileError
        There is neither; or the file cannot be used.
    SceneError, RenderError
        There is no world, or Cycles did not deliver its picture.

    Warns
    -----
    RsibrWarning
        See `files.environments.read_environment`.
    """
    if spec is None:
        return sample_world(world_of(find_scene(None)), WORLD_HEIGHT, clamp)
    own = studio_environments()
    # A folder may well be called as one of Blender's own
    if spec in own and not Path(spec).is_file():
        return read_environment(own[spec], clamp)
    if not split_layer(spec)[0].exists():
        raise InputFileError(f"There is no environment {spec}: give a file, or one of {', '.join(own)}.")
    return read_environment(spec, clamp)
