"""Files of measured materials, and the texts that stand for them."""

from pathlib import Path

from ..core.errors import InputFileError

MEASURED_FORMATS = {".binary": "merl", ".brdf": "cornell", ".bsdf": "rgl"}
"""Suffix of a measured material's file -> its model."""


def measured_spec(path: str) -> str:
    """The text of a measured material's file.

    Returns
    -------
    str
        As `files.brdfs.brdf_from_spec` takes it.

    Raises
    ------
    InputFileError
        Its suffix is none of `MEASURED_FORMATS`.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MEASURED_FORMATS:
        raise InputFileError(
            f"{path} is no measured material: give a MERL .binary, a Cornell .brdf or an RGL .bsdf."
        )
    return f"{MEASURED_FORMATS[suffix]}:path={path}"
