"""Families of lobes and the table of sheen as files of arrays, and those that come with us."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, RangeError, ShapeError
from ..core.lobes.bank import KernelBank
from ..core.lobes.family import Family
from ..core.lobes.rings import SheenTable
from .atomic import written_aside

SHIPPED = Path(__file__).with_name("families")
"""The folder of what comes with us; `.ci/fit_families.py` makes it."""

_DIGITS = 14
"""Binary digits of stored numbers: lobes that cancel make of their rounding less than maps make of theirs."""


@cache
def shipped_family(name: str) -> Family:
    """A family that comes with us.

    Parameters
    ----------
    name : str
        "ggx": reflection from GGX microfacets times each of `fresnel_powers.POWERS`; "leaning": what leaning
        facets add to diffuse reflection, `oren_nayar.tilt`; "gaussian": Ward's and Beckmann's lobes, see
        `core.lobes.family_fit.fit_gaussian`.

    Raises
    ------
    InputFileError
        There is none of that name, or its file is damaged.
    """
    return read_family(SHIPPED / f"{name}.npz")


def write_family(path: Path, family: Family) -> None:
    """Write a family, replacing the file.

    Parameters
    ----------
    path : Path
        NAME.npz.
    family : Family
        Its tilts and weights are rounded to `_DIGITS`, which files compress well.
    """
    arrays = {
        "alpha": family.alpha,
        "mu": family.mu,
        "concentrations": family.bank.kappa,
        "tilts": _rounded(family.tilts),
        "weights": _rounded(family.weights),
    }
    with written_aside(path, force=True) as aside:
        np.savez_compressed(aside, allow_pickle=False, **arrays)


def _rounded(values: Array) -> Array:
    """Numbers of `_DIGITS`, in single precision."""
    mantissa, exponent = np.frexp(values)
    rounded: Array = np.ldexp(np.round(np.ldexp(mantissa, _DIGITS)), exponent - _DIGITS).astype(np.float32)
    return rounded


def read_family(path: Path) -> Family:
    """Read what `write_family` wrote.

    Raises
    ------
    InputFileError
        The file is missing, or no family of lobes.
    """
    with _arrays(path, "family of lobes") as arrays:
        alpha, mu, concentrations, tilts, weights = (
            arrays[name].astype(np.float64) for name in ("alpha", "mu", "concentrations", "tilts", "weights")
        )
        return Family(alpha, mu, KernelBank(tuple(concentrations.tolist())), tilts, weights)


@cache
def shipped_sheen() -> SheenTable:
    """The table of Cycles' sheen that comes with us.

    Raises
    ------
    InputFileError
        Its file is damaged.
    """
    with _arrays(SHIPPED / "sheen.npz", "table of sheen") as arrays:
        return SheenTable(arrays["weights"].astype(np.float64))


def write_sheen(path: Path, table: SheenTable) -> None:
    """Write a table of sheen in single precision, replacing the file, NAME.npz."""
    with written_aside(path, force=True) as aside:
        np.savez_compressed(aside, allow_pickle=False, weights=table.weights.astype(np.float32))


@contextmanager
def _arrays(path: Path, what: str) -> Iterator[Mapping[str, Array]]:
    """The arrays of a file; what goes wrong within is told as its fault."""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            yield arrays
    except (OSError, EOFError, KeyError, ValueError, BadZipFile, RangeError, ShapeError) as error:
        raise InputFileError(f"{path} is no {what}: install RSIBR again. ({error})") from error
