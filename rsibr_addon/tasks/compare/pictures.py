"""The pictures of a comparison: references, drawings and their differences, each on one sheet."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.metrics import unpremultiplied
from ...host.pictures import save_png
from .comparison import Way
from .contact_sheet import contact_sheet

COLUMNS = 5
"""Views in a row of a sheet."""

FULL_DIFFERENCE = 0.2
"""Difference that is shown in full colour, in parts of the references' root mean square luminance."""

BRIGHTER, DARKER = (1.0, 0.12, 0.05), (0.05, 0.25, 1.0)
"""Colours of drawings brighter and darker than the reference, scene-linear."""

LUMINANCE = (0.2126, 0.7152, 0.0722)
"""Luminance of the Rec. 709 primaries: [BT709] item 3.2."""


@dataclass(frozen=True)
class Sheets:
    """PNG files, each with all views, `COLUMNS` in a row, the first at the top left."""

    reference: Path
    drawing: dict[Way, Path]
    difference: dict[Way, Path]


def save_sheets(folder: Path, references: list[Array], drawn: dict[Way, list[Array]]) -> Sheets:
    """Write the pictures of a comparison.

    Parameters
    ----------
    folder : Path
        To be made.
    references : list of ndarray, each of shape (size, size, 4)
        Radiance times coverage, and coverage; row 0 at the bottom.
    drawn : dict of Way to list of ndarray
        The same views, drawn.
    """
    folder.mkdir()
    sheets = Sheets(
        folder / "reference.png",
        {way: folder / f"{way.slug}.png" for way in drawn},
        {way: folder / f"{way.slug}-difference.png" for way in drawn},
    )
    full = FULL_DIFFERENCE * _root_mean_square_luminance(references)
    save_png(sheets.reference, contact_sheet(references, COLUMNS))
    for way, pictures in drawn.items():
        differences = [difference_picture(*pair, full) for pair in zip(pictures, references, strict=True)]
        save_png(sheets.drawing[way], contact_sheet(pictures, COLUMNS))
        save_png(sheets.difference[way], contact_sheet(differences, COLUMNS))
    return sheets


def difference_picture(ours: Array, reference: Array, full: float) -> Array:
    """Show where a drawing is too bright and where it is too dark.

    Parameters
    ----------
    ours, reference : ndarray, shape (size, size, 4)
        Radiance times coverage, and coverage.
    full : float
        Difference of luminance that is shown in full colour.

    Returns
    -------
    ndarray, shape (size, size, 4)
        `BRIGHTER` or `DARKER`, as opaque as the difference is large, premultiplied; transparent where
        both are equal, or one of them covers nothing.
    """
    weight = np.minimum(ours[..., 3], reference[..., 3])
    excess = weight * ((unpremultiplied(ours) - unpremultiplied(reference)) @ np.array(LUMINANCE))
    opacity = np.clip(np.abs(excess) / full, 0.0, 1.0)[..., None]
    colour = np.where(excess[..., None] > 0.0, BRIGHTER, DARKER)
    return np.concatenate([opacity * colour, opacity], axis=-1)


def _root_mean_square_luminance(references: list[Array]) -> float:
    stacked = np.stack(references)
    luminance = unpremultiplied(stacked) @ np.array(LUMINANCE)
    return float(np.sqrt(np.average(luminance**2, weights=stacked[..., 3])))
