"""Reflectance models from their texts, including models of measured files."""

from collections.abc import Callable

from ..core.brdf import spec as brdf_spec
from ..core.brdf.albedo import warn_of_gain
from ..core.brdf.model import Brdf
from .cornell import read_cornell
from .merl import read_merl
from .rgl import read_rgl

READERS: dict[str, Callable[[str], Brdf]] = {"merl": read_merl, "cornell": read_cornell, "rgl": read_rgl}
"""Format of a measured model -> its reader."""


def brdf_from_spec(spec: str) -> Brdf:
    """Make the model that a text describes, reading files where it names them.

    Parameters
    ----------
    spec : str
        See `core/brdf/spec.py`.

    Raises
    ------
    RangeError
        The text describes no model; the message names the wrong key and the values that it takes.
    InputFileError
        A measured file is missing or not of its format.

    Warns
    -----
    RsibrWarning
        The model reflects more light than it receives, or values of a measured file had to be replaced.
    """
    brdf = brdf_spec.brdf_from_spec(spec, read_measured)
    warn_of_gain(brdf, spec)
    return brdf


def read_measured(name: str, path: str) -> Brdf:
    """Read a measured model.

    Parameters
    ----------
    name : str
        Its format, one of `READERS`.
    path : str
        Its file.

    Raises
    ------
    InputFileError
        The file is missing or not of its format.

    Warns
    -----
    RsibrWarning
        Values had to be replaced.
    """
    return READERS[name](path)
