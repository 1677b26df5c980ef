"""Lobes from any file that states some: a fit, or a map set."""

from pathlib import Path

from ..core.errors import MapSetError
from ..core.lobes.fit import Fit
from .fits import read_fit
from .kinds.registry import STORED
from .map_set import read_map_set_header
from .map_set_mark import is_map_set


def stated_lobes(path: str | Path) -> Fit:
    """The lobes that a file states.

    Parameters
    ----------
    path : str or Path
        A fit, or a map set of a kind that may have lobes: see `StoredKind.lobes`.

    Raises
    ------
    InputFileError
        See `read_fit`.
    MapSetError
        The map set is damaged, or states no lobes.
    """
    if not is_map_set(path):
        return read_fit(path)
    header = read_map_set_header(path)
    fit = STORED[header["kind"]].lobes(Path(path), header)
    if fit is None:
        raise MapSetError(
            f"{path} states no lobes: capture with --fit, or fit lobes to captures by rsibr fit --captures."
        )
    return fit
