"""Families of lobes as files of arrays, and the families that come with us."""

from functools import cache
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ..core.errors import InputFileError, RangeError, ShapeError
from ..core.lobes.bank import KernelBank
from ..core.lobes.family import Family
from .atomic import written_aside

SHIPPED = Path(__file__).with_name("families")
"""The folder of the families that come with us; `.ci/fit_families.py` makes them."""


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
        Its tilts and weights are written in single precision.
    """
    arrays = {
        "alpha": family.alpha,
        "mu": family.mu,
        "concentrations": family.bank.kappa,
        "tilts": family.tilts.astype(np.float32),
        "weights": family.weights.astype(np.float32),
    }
    with written_aside(path, force=True) as aside:
        np.savez_compressed(aside, allow_pickle=False, **arrays)


def read_family(path: Path) -> Family:
    """Read what `write_family` wrote.

    Raises
    ------
    InputFileError
        The file is missing, or no family of lobes.
    """
    try:
        with np.load(path, allow_pickle=False) as arrays:
            alpha, mu, concentrations, tilts, weights = (
                arrays[name].astype(np.float64)
                for name in ("alpha", "mu", "concentrations", "tilts", "weights")
            )
        return Family(alpha, mu, KernelBank(tuple(concentrations.tolist())), tilts, weights)
    except (OSError, EOFError, KeyError, ValueError, BadZipFile, RangeError, ShapeError) as error:
        raise InputFileError(f"{path} is no family of lobes: install RSIBR again. ({error})") from error
