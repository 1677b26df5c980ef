"""Environments by what a user calls them."""

from pathlib import Path

from ..core.environment import Environment
from ..core.errors import InputFileError
from ..files.environments import read_environment
from ..host.worlds import studio_environments


def load_environment(spec: str) -> Environment:
    """An environment from a file, or one of Blender's own.

    Parameters
    ----------
    spec : str
        A file as `files.environments.read_environment` takes it, or a name such as "forest".

    Returns
    -------
    Environment

    Raises
    ------
    InputFileError
        There is neither; or the file cannot be used.

    Warns
    -----
    RsibrWarning
        Negative values were set to 0; says how many.
    """
    own = studio_environments()
    if Path(spec).exists():
        return read_environment(spec)
    if spec not in own:
        raise InputFileError(f"There is no environment {spec}: give a file, or one of {', '.join(own)}.")
    return read_environment(own[spec])
