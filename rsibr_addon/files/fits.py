"""Lobe fits as JSON files, with exact numbers."""

import json
from pathlib import Path
from typing import Annotated, Any, NotRequired, TypedDict

from ..core.errors import InputFileError, RangeError, SchemaError, ShapeError
from ..core.lobes.bank import KernelBank
from ..core.lobes.fit import Fit
from ..core.schema import LARGEST_TEXT, array, decode, length, loads
from .atomic import written_aside
from .map_set_header import MOST_KERNELS, Colour, Model
from .reading import opened

KIND, FORMAT = "rsibr lobe fit", 1
_ARRAYS = {"mu": 1, "weights": 4, "scale": 3, "offsets": 4, "taps": 3}


class FitFields(TypedDict):
    """A fit as JSON has it."""

    brdf: Model
    method: str
    concentrations: Annotated[list[float], length(1, MOST_KERNELS)]
    mu: list[float]
    weights: list[list[list[Colour]]]
    scale: list[list[Colour]]
    offsets: list[list[list[list[float]]]]
    taps: list[list[list[float]]]
    left_out: NotRequired[float]


def fields_of(fit: Fit) -> FitFields:
    """A fit as JSON values."""
    told: Any = {
        "brdf": fit.brdf,
        "method": fit.method,
        "concentrations": list(fit.bank.concentrations),
        **{name: getattr(fit, name).tolist() for name in _ARRAYS},
        **({} if fit.left_out is None else {"left_out": fit.left_out}),
    }
    fields: FitFields = told
    return fields


def fit_from(fields: FitFields) -> Fit:
    """The fit that `fields_of` told, to the last bit.

    Raises
    ------
    SchemaError, RangeError, ShapeError
        The values do not make a fit.
    """
    told: dict[str, Any] = {**fields}
    arrays = {name: array(told[name], axes, name) for name, axes in _ARRAYS.items()}
    bank = KernelBank(tuple(told["concentrations"]))
    return Fit(told["brdf"], told["method"], bank=bank, left_out=told.get("left_out"), **arrays)


def write_fit(path: str | Path, fit: Fit, report: dict[str, Any], force: bool = False) -> None:
    """Write a fit.

    Parameters
    ----------
    path : str or Path
        Usually NAME.json.
    fit : Fit
    report : dict
        Statements beside the fit, its errors for example: JSON values.
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
        "report": report,
        **fields_of(fit),
    }
    with written_aside(path, force) as aside:
        aside.write_text(json.dumps(text, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


def read_fit(path: str | Path) -> Fit:
    """Read a fit.

    Returns
    -------
    Fit
        Equal to what was written, to the last bit.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, no fit or of a newer format, or its values do not make a fit.
    """
    with opened(path) as stream:
        text = stream.read(LARGEST_TEXT + 1)
    no_fit = InputFileError(f"{path} is no lobe fit: give a file that rsibr fit wrote.")
    if not text.lstrip().startswith(b"{"):
        raise no_fit
    try:
        plain = loads(text)
        if not isinstance(plain, dict) or plain.get("kind") != KIND:
            raise no_fit
        if plain.get("format") != FORMAT:
            raise InputFileError(
                f"{path} has format {plain.get('format')!r:.40}, which is newer: update the program."
            )
        return fit_from(decode(FitFields, plain))
    except (SchemaError, RangeError, ShapeError) as error:
        raise InputFileError(f"{path} is damaged ({error}): fit again, or restore the file.") from error
