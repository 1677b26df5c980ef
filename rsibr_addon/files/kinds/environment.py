"""Pictures of an environment, read as map sets of kind `environment`."""

from contextlib import suppress
from pathlib import Path

from ...core.environment import Environment
from ...core.errors import InputFileError, MapSetError
from ..environments import read_environment
from ..map_set_data import ENVIRONMENT, MapSet
from ..map_set_mark import is_map_set
from ..pictures import split_layer
from ..radiance_pictures import holds_radiance

KIND = "environment"


def is_environment(path: Path) -> bool:
    """Whether a file is a picture of radiance and not a map set.

    Returns
    -------
    bool
        False also where it cannot be read; reading it as a map set then tells why.
    """
    with suppress(InputFileError):
        return not is_map_set(split_layer(path)[0]) and holds_radiance(path)
    return False


def read_as_map_set(path: Path, clamp: float | None = None) -> MapSet:
    """Read a picture as if it were a map set.

    Parameters
    ----------
    path : Path
    clamp : float, optional
        See `read_environment`.

    Returns
    -------
    MapSet
        It has the environment as its only part, and no material.

    Raises
    ------
    InputFileError
        See `read_environment`.
    """
    environment = read_environment(path, clamp)
    header = {"environment": {"name": environment.name, "part": ENVIRONMENT}, "material": {}}
    return MapSet(KIND, {ENVIRONMENT: environment.radiance}, header)


def from_map_set(path: Path, map_set: MapSet) -> Environment:
    """The environment that a map set of any kind was made in.

    Raises
    ------
    MapSetError
        The file does not hold its environment.
    """
    described = map_set.header["environment"]
    if described["part"] is None:
        raise MapSetError(f"{path} does not hold the environment it was made in: give that as a picture.")
    return Environment(map_set.maps[described["part"]], described["name"])
