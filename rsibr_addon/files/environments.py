"""Environments from disk: OpenEXR and Radiance HDR."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from pathlib import Path

from ..core.environment import Environment, environment_from_pixels
from ..core.warned import recorded_warnings, warn
from .radiance_pictures import read_radiance
from .read_once import read_once


def read_environment(path: str | Path, clamp: float | None = None) -> Environment:
    """Read a latitude-longitude map of incoming radiance.

    Parameters
    ----------
    path : str or Path
        OpenEXR or Radiance HDR, recognised by its first bytes, not by its name.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Returns
    -------
    Environment
        Named as the file.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, of another format, truncated or damaged, has no colour, is not
        twice as wide as high, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `core.environment.usable_radiance`.
    """
    environment, warnings = _read.get()(Path(path), clamp)
    for warning in warnings:
        warn(warning)
    return environment


@contextmanager
def environment_kept() -> Iterator[None]:
    """Within, the environment that was read last is kept: bakes that follow in it do not read it again."""
    token = _read.set(partial(read_once, most=1)(_read_environment))
    try:
        yield
    finally:
        _read.reset(token)


def _read_environment(path: Path, clamp: float | None) -> tuple[Environment, list[str]]:
    """An environment, and the warnings of reading it, which whoever gets it again is to hear too."""
    # A name that is not UTF-8 could not be written into a map set
    name = os.fsencode(path.name).decode("utf-8", "replace")
    with recorded_warnings() as warnings:
        return environment_from_pixels(read_radiance(path), name, clamp), warnings


_read: ContextVar[Callable[[Path, float | None], tuple[Environment, list[str]]]] = ContextVar(
    "_read", default=_read_environment
)
