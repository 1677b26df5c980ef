"""Fit the families of lobes that come with us, and measure them for docs/materials.md.

Without the option --fit, what there is is measured.
"""

import argparse
from pathlib import Path

import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.brdf import sheen_polynomials
from rsibr.rsibr_addon.core.brdf.fresnel import Fresnel, Index, Schlick
from rsibr.rsibr_addon.core.brdf.fresnel_powers import dielectric, schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.sheen_polynomials import fit_polynomials
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.lobes.accuracy import FitErrors, fit_errors
from rsibr.rsibr_addon.core.lobes.family import Family
from rsibr.rsibr_addon.core.lobes.family_fit import fit_gaussian, fit_ggx, fit_leaning
from rsibr.rsibr_addon.core.lobes.rings import elevations, fit_sheen, ring_errors
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.families import (
    SHIPPED,
    shipped_family,
    shipped_sheen,
    write_family,
    write_sheen,
)
from rsibr.rsibr_addon.host.sheen import measured_sheen

MATERIALS: dict[str, tuple[Fresnel, Array]] = {
    "white metal": (Schlick(f0=1.0), schlick(1.0)),
    "F0 = .04": (Schlick(f0=0.04), schlick(0.04)),
    "glass, 1.5": (Index(eta=1.5), dielectric(1.5)),
    "water, 1.33": (Index(eta=1.33), dielectric(1.33)),
}
"""Name -> its Fresnel term, and that as a sum of powers."""

SAMPLES = (0, 12, 18, 24, 28, 32, 36, 40, 44, 48)


def measured(family: Family, alpha: float, material: str) -> FitErrors:
    """Errors of a material's lobes at the fitted elevations."""
    fresnel, coefficients = MATERIALS[material]
    fit = family.fit(alpha, np.repeat(coefficients[:, None], 3, axis=1), material)
    return fit_errors(fit, Ggx(alpha=alpha, fresnel=fresnel))


def errors(family: Family) -> str:
    """E at samples of alpha, and halfway to the next one."""
    lines = [
        f"| alpha | {' | '.join(MATERIALS)} | albedo error | amplification |",
        f"|---|{(len(MATERIALS) + 2) * '---|'}",
    ]
    for row in SAMPLES:
        alpha = family.alpha[row : row + 2]
        for between in (False, True)[: len(alpha)]:
            width = float(np.sqrt(np.prod(alpha))) if between else float(alpha[0])
            found = [measured(family, width, name) for name in MATERIALS]
            columns = " | ".join(f"{each.error:.3f}" for each in found)
            lines.append(
                f"| {width:.3f}{' (between)' * between} | {columns} "
                f"| {max(each.albedo_error for each in found):.2%} "
                f"| {max(each.amplification.max() for each in found):.1f} |"
            )
    return "\n".join(lines)


def sheen_errors() -> str:
    """Errors of sheen towards views, and its albedo."""
    mu = elevations(4)
    lines = [
        f"| roughness | {' | '.join(f'n.v {each:.3f}' for each in mu)} |",
        f"|---|{len(mu) * '---|'}",
    ]
    for roughness in (0.2, 0.3, 0.4, 0.5, 0.7, 1.0):
        sheen = measured_sheen(roughness, mu)
        found = ring_errors(sheen, shipped_sheen().at(roughness, mu))
        columns = " | ".join(f"{e:.2f} ({a:.3f})" for e, a in zip(found, sheen.albedo, strict=True))
        lines.append(f"| {roughness} | {columns} |")
    return "\n".join(lines)


def write_polynomials(coefficients: Array) -> None:
    """Write polynomials of sheen into their module."""
    rows = "".join(" ".join(f"{number:.5g}" for number in row) + "\n" for row in np.concatenate(coefficients))
    path = Path(sheen_polynomials.__file__)
    text = path.read_text(encoding="utf-8")
    before, start, rest = text.partition('_ROWS = """\n')
    _, end, after = rest.partition('"""')
    path.write_text(f"{before}{start}{rows}{end}{after}", encoding="utf-8")


def main() -> None:
    """Fit, where asked to, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fit", action="store_true", help="fit anew, three minutes of processor time")
    if parser.parse_args().fit:
        write_family(SHIPPED / "ggx.npz", drain(fit_ggx()))
        write_family(SHIPPED / "gaussian.npz", drain(fit_gaussian()))
        write_family(SHIPPED / "leaning.npz", drain(fit_leaning()))
        write_sheen(SHIPPED / "sheen.npz", drain(fit_sheen(measured_sheen)))
        write_polynomials(drain(fit_polynomials(measured_sheen)))
    write_table("materials.md", "family", errors(shipped_family("ggx")))
    write_table("materials.md", "sheen", sheen_errors())


if __name__ == "__main__":
    main()
