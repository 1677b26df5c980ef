"""Lobe fits as JSON files, number by number as they are."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputFileError, RsibrError
from ..core.lobes.bank import KernelBank
from ..core.lobes.fit import Fit
from .atomic import written_aside
from .reading import opened

KIND, FORMAT = "rsibr lobe fit", 1
_ARRAYS = {"mu": 1, "weights": 4, "scale": 3, "offsets": 4, "taps": 3}


def write_fit(path: str | Path, fit: Fit, report: dict[str, Any], force: bool = False) -> None:
    """Write a fit.

    Parameters
    ----------
    path : str or Path
        By custom NAME.json.
    fit : Fit
    report : dict
        What to state beside it, its errors for example: JSON values.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        The file cannot be written, or exists and is not to be replaced.
    """
    text = {
        "kind": KIND,
        "format": FORMAT,
        "brdf": fit.brdf,
        "method": fit.method,
        "report": report,
        "concentrations": list(fit.bank.concentrations),
        **{name: getattr(fit, name).tolist() for name in _ARRAYS},
    }
    with written_aside(path, force) as aside:
        aside.write_text(json.dumps(text, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


def read_fit(path: str | Path) -> Fit:
    """Read a fit.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Fit
        Equal to what was written, to the last bit.

    Raises
    ------
    InputFileError
        The file is missing, unreadable or no fit, of a newer format, or its values do not make one.
    """
    with opened(path) as stream:
        data = stream.read()
    try:
        text = json.loads(data)
    except ValueError as error:
        raise InputFileError(f"{path} is no JSON: give a file that rsibr fit wrote.") from error
    if not isinstance(text, dict) or text.get("kind") != KIND:
        raise InputFileError(f"{path} is no lobe fit: give a file that rsibr fit wrote.")
    if text.get("format") != FORMAT:
        raise InputFileError(f"{path} has format {text.get('format')}, which is newer: update the program.")
    try:
        arrays = {name: np.array(text[name], dtype=np.float64) for name in _ARRAYS}
        kernels = [float(kappa) for kappa in text["concentrations"]]
        if any(arrays[name].ndim != axes for name, axes in _ARRAYS.items()):
            raise ValueError
        return Fit(str(text["brdf"]), str(text["method"]), bank=KernelBank(tuple(kernels)), **arrays)
    except (KeyError, TypeError, ValueError, RsibrError) as error:
        raise InputFileError(f"{path} is damaged: fit again, or restore the file.") from error
