"""Plots of a fit: the model and its lobes in the plane of incidence, and the error over the elevations."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...core.brdf.model import Brdf
from ...core.conventions import Array
from ...core.lobes.accuracy import FitErrors, fit_errors
from ...core.lobes.fit import Fit
from ...core.lobes.target import elevation_slices
from ...files.folders import check_folder_target, folder_written_aside
from ...files.plots import Curve, line_plot, polar_picture, polar_plot

ELEVATIONS = (0.2, 0.5, 0.8)
"""n.v of the polar plots."""

_ERROR = "error.svg"
_ANGLES = np.linspace(-np.pi, np.pi, 721)
_DIRECTIONS = np.stack([np.sin(_ANGLES), np.zeros_like(_ANGLES), np.cos(_ANGLES)], axis=-1)
_BETWEEN = 4


def check_plots(folder: Path, force: bool) -> None:
    """Refuse a folder that cannot or must not be written, before long work begins.

    Parameters
    ----------
    folder : Path
    force : bool
        Whether earlier plots are replaced.

    Raises
    ------
    OutputFileError
    """
    check_folder_target(folder, _ERROR, force)


def write_plots(folder: Path, fits: Mapping[str, Fit], brdf: Brdf, errors: FitErrors, force: bool) -> None:
    """Write the plots of a fit: ``lobes-20.svg`` and so on, by 100 n.v, and ``error.svg``.

    Parameters
    ----------
    folder : Path
        A new one, or one with earlier plots.
    fits : mapping of str to Fit
        The fit by its name, and after it those whose errors are plotted beside.
    brdf : Brdf
        What they stand for.
    errors : FitErrors
        Of the first, at its own elevations.
    force : bool
        Whether earlier plots are replaced.

    Raises
    ------
    OutputFileError
        The folder cannot be written, or exists and is not to be replaced.
    """
    fit, *others = fits.values()
    error = _errors(fits, brdf) if others else _error(fit, brdf, errors)
    with folder_written_aside(folder, _ERROR, force) as aside:
        for mu in ELEVATIONS:
            _write(aside / f"lobes-{100 * mu:.0f}.svg", lobe_plot(fit, brdf, mu))
        _write(aside / _ERROR, error)


def _write(path: Path, plot: str) -> None:
    # Its title may name a file by bytes that are no UTF-8
    path.write_text(plot, encoding="utf-8", errors="replace")


def lobe_plot(fit: Fit, brdf: Brdf | None, mu: float) -> str:
    """The lobes of a fit towards one view, as SVG, and beside them what they stand for.

    Parameters
    ----------
    fit : Fit
    brdf : Brdf or None
        None leaves it out.
    mu : float
        n.v, in (0, 1].
    """
    angle = np.degrees(np.arccos(mu))
    truth = [] if brdf is None else [_truth(brdf, mu)]
    title = f"{fit.brdf}, view {angle:.0f} degrees from the normal"
    return polar_plot(title, [*truth, *_lobe_curves(fit, mu)])


def lobe_picture(fit: Fit, mu: float) -> Array:
    """The lobes of a fit towards one view, as pixels: see `polar_picture`."""
    return polar_picture(_lobe_curves(fit, mu))


def _lobe_curves(fit: Fit, mu: float) -> list[Curve]:
    """The green channel, most of luminance, in the plane of incidence; the view comes from the left."""
    lobes = fit.evaluate_lobes(_DIRECTIONS, mu)[..., 1]
    return [
        Curve("fit", _ANGLES, lobes.sum(axis=0), dashed=True),
        *(Curve(f"lobe {number}", _ANGLES, values) for number, values in enumerate(lobes, 1)),
    ]


def _truth(brdf: Brdf, mu: float) -> Curve:
    view_dir = np.array([-np.sqrt(1.0 - mu**2), 0.0, mu])
    values = brdf(_DIRECTIONS, view_dir) * np.maximum(_DIRECTIONS[:, 2:], 0.0)
    return Curve("brdf n.l", _ANGLES, values[:, 1])


def _error(fit: Fit, brdf: Brdf, errors: FitErrors) -> str:
    fine = elevation_slices(_BETWEEN * len(fit.mu))
    between = fit_errors(fit, brdf, fine)
    curves = [
        Curve("interpolated", fine, between.shape),
        Curve("at fitted elevations", errors.mu, errors.shape, dashed=True),
    ]
    return line_plot(f"{fit.brdf}, {fit.method}", "n.v", (0.0, 1.0), "relative error", curves)


def _errors(fits: Mapping[str, Fit], brdf: Brdf) -> str:
    """Errors of several fits, interpolated between their elevations."""
    fine = elevation_slices(_BETWEEN * max(len(fit.mu) for fit in fits.values()))
    curves = [Curve(name, fine, fit_errors(fit, brdf, fine).shape) for name, fit in fits.items()]
    title = next(iter(fits.values())).brdf
    return line_plot(title, "n.v", (0.0, 1.0), "relative error", curves)
