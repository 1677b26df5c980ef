"""The parts of a material as options: of a bake, and of a look that changes what was baked."""

from typing import Any

from ...options import option
from .material import MODELS, Emission

_TOLD = {
    "diffuse": ("Diffuse", "Light by the normal: lambert:kd=0.5/0.4/0.3 or luminous:kd=0.5"),
    "emission": ("Emission", "Radiance that is added to the diffuse table: 2/1/0.5"),
    "specular": ("Specular", "Light by the mirror direction: mirror:ks=0.9 or phong:n=50,ks=0.3"),
    "coat": (
        "Coat",
        "Clear varnish, which mirrors its share and lets the rest through: fresnel:eta=1.5, constant:k=0.5",
    ),
    "retro": ("Retro", "Retro-reflection, light by the view direction: phong:n=200,ks=0.3 or mirror:"),
    "refraction": ("Refraction", "Light by the refracted direction: clear:eta=1.5,tint=1/0.9/0.8"),
    "weights": (
        "Weights",
        "How angles share light out between the tables: constant:k=0.3, fresnel:eta=1.5, "
        "fresnel:metal=copper, curve:wd=0:0.5/1:1,ws=0:1/1:0.04 of the cosine between normal and view, or "
        "albedo:brdf=(BRDF), a BRDF's albedo part by part",
    ),
}
"""Part -> its label, and what it is."""


def part_option(part: str, none: str) -> Any:
    """One of `material.PARTS` as a text.

    Parameters
    ----------
    part : str
    none : str
        What the part is where it is not given.
    """
    label, help = _TOLD[part]
    return option(
        None,
        label=label,
        help=f"{help}; none for no such part",
        none=none,
        none_as="",
        metavar="SPEC",
        models=MODELS.get(part, (Emission,)),
    )
