"""Materials of reflection tables, as texts: one ``model:key=value,key=value`` for each part.

===========  ================================================================================
part         models
===========  ================================================================================
diffuse      ``lambert:kd=0.5/0.4/0.3``, ``luminous:kd=0.5``
emission     ``2/1/0.5``: radiance that is added to the diffuse table
specular     ``mirror:ks=0.9``, ``phong:n=50,ks=0.3``
coat         ``constant:k=0.5``, ``fresnel:eta=1.5``
retro        ``mirror:``, ``phong:n=200,ks=0.3``
refraction   ``clear:eta=1.5,tint=1/0.9/0.8``
weights      ``constant:k=0.3``, ``fresnel:eta=1.5``, ``fresnel:metal=copper``,
             ``curve:wd=0:0.5/1:1,ws=0:1/1:0.04``, ``albedo:brdf=(ggx:alpha=0.3,f0=0.04)``
===========  ================================================================================

``none`` in place of any of them leaves the part out.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from ...brdf.parameters import Checked, Color, Range
from ...brdf.spec import ReadMeasured, arguments_from_text
from ...errors import RangeError
from ...near_names import did_you_mean
from .models import (
    AlbedoReflectance,
    ClearTable,
    CoatModel,
    ConstantReflectance,
    Curves,
    DiffuseModel,
    FresnelReflectance,
    LambertTable,
    LobeModel,
    LuminousTable,
    MirrorTable,
    PhongTable,
    WeightModel,
)
from .tables import Role

MODELS: dict[str, tuple[type[Any], ...]] = {
    "diffuse": (LambertTable, LuminousTable),
    "specular": (MirrorTable, PhongTable),
    "coat": (ConstantReflectance, FresnelReflectance),
    "retro": (MirrorTable, PhongTable),
    "refraction": (ClearTable,),
    "weights": (ConstantReflectance, FresnelReflectance, Curves, AlbedoReflectance),
}
"""Part of a material -> its possible models; a material may also have an emission."""

PARTS = ("diffuse", "emission", "specular", "coat", "retro", "refraction", "weights")
"""Every part of a material."""

NO_PART = "none"
"""The text of a part that the material does not have."""

PRESETS: dict[str, dict[str, str]] = {
    "chrome": {"specular": "mirror:"},
    "clay": {"diffuse": "lambert:kd=0.55/0.4/0.3"},
    "plastic": {"diffuse": "lambert:kd=0.5/0.05/0.05", "specular": "phong:n=50,ks=0.3"},
    "varnished-wood": {
        "diffuse": "lambert:kd=0.35/0.15/0.05",
        "specular": "phong:n=20,ks=0.3",
        "coat": "fresnel:eta=1.5",
    },
    "copper": {"specular": "phong:n=100,ks=1", "weights": "fresnel:metal=copper"},
    "gold": {"specular": "phong:n=100,ks=1", "weights": "fresnel:metal=gold"},
    "silver": {"specular": "phong:n=100,ks=1", "weights": "fresnel:metal=silver"},
    "satin": {"diffuse": "lambert:kd=0.15/0.03/0.05", "specular": "phong:n=8,ks=0.2"},
    "car-paint": {
        "diffuse": "lambert:kd=0.02/0.06/0.25",
        "specular": "phong:n=30,ks=0.2",
        "coat": "fresnel:eta=1.5",
    },
    "glass": {
        "specular": "mirror:",
        "refraction": "clear:eta=1.5",
        "weights": "fresnel:eta=1.5",
    },
    "cats-eye": {
        "diffuse": "lambert:kd=1",
        "retro": "phong:n=200,ks=1",
        "weights": "albedo:brdf=(sum:parts=(lambert:kd=0.2)+(retroreflective:n=200,ks=0.6))",
    },
    "glowing": {"emission": "1/0.5/0.1", "coat": "fresnel:eta=1.5"},
}
"""Name -> the parts of a material; the materials that [Miller1984] speaks of."""

_OLD_NAMES = {"matte": "clay", "varnished": "varnished-wood"}
"""Names of presets in version 0.1, which go with 0.3."""


@dataclass(frozen=True, kw_only=True)
class Emission(Checked):
    """Radiance that a surface emits."""

    radiance: Annotated[Color, Range(0.0, 1e6)]


@dataclass(frozen=True, kw_only=True)
class TableMaterial:
    """The parts of a material that tables are made of; made by `material_from_texts`.

    Attributes
    ----------
    diffuse, specular, coat, retro, refraction : model or None
        Model of each table; None where the material has no such part.
    emission : Emission or None
    weights : model or None
        Model of the tables' shares of light by angle; None where each has all of it.
    """

    diffuse: DiffuseModel | None = None
    emission: Emission | None = None
    specular: LobeModel | None = None
    coat: CoatModel | None = None
    retro: LobeModel | None = None
    refraction: ClearTable | None = None
    weights: WeightModel | None = None

    @property
    def eta(self) -> float:
        """Index of refraction by which rays bend; 1 where nothing refracts."""
        return self.refraction.eta if self.refraction is not None else 1.0

    @property
    def lobes(self) -> dict[Role, LobeModel]:
        """Models of all tables but the diffuse one, in the order of `Role`."""
        there = {
            Role.SPECULAR: self.specular,
            Role.COAT: None if self.coat is None else MirrorTable(),
            Role.RETRO: self.retro,
            Role.REFRACTION: None if self.refraction is None else MirrorTable(),
        }
        return {role: model for role, model in there.items() if model is not None}

    @property
    def roles(self) -> tuple[Role, ...]:
        """The tables that the material has, in the order of `Role`."""
        dark = self.diffuse is None and self.emission is None
        return (*(() if dark else (Role.DIFFUSE,)), *self.lobes)


def preset(name: str) -> dict[str, str]:
    """The parts of one of `PRESETS`.

    Raises
    ------
    RangeError
        There is no such preset.
    """
    name = _OLD_NAMES.get(name, name)
    if name not in PRESETS:
        near = did_you_mean(name, PRESETS)
        raise RangeError(f"There is no preset {name}{near}: choose one of {', '.join(PRESETS)}.")
    return PRESETS[name]


def changed_parts(texts: Mapping[str, str], changes: Any) -> dict[str, str]:
    """The parts of a material, some of them changed.

    Parameters
    ----------
    texts : mapping of str to str
        Some of `PARTS`.
    changes : object
        Has the text of each of `PARTS` that is another, and None for others.

    Returns
    -------
    dict
        Without those that are `NO_PART`.
    """
    given = {part: getattr(changes, part) for part in PARTS if getattr(changes, part) is not None}
    return {part: text for part, text in ({**texts} | given).items() if text != NO_PART}


def material_from_texts(texts: Mapping[str, str], read_measured: ReadMeasured) -> TableMaterial:
    """Make the material that texts describe.

    Parameters
    ----------
    texts : mapping of str to str
        Some of `PARTS`, as above.
    read_measured : callable
        Reads measured BRDFs: see `brdf.spec`.

    Raises
    ------
    RangeError
        A part or model does not exist, a key is missing or wrong, or no part reflects, emits or transmits;
        one sentence that names the part.
    InputFileError
        From `read_measured`.
    """
    parts: dict[str, Any] = {}
    for part, text in texts.items():
        try:
            parts[part] = _part(part, text, read_measured)
        except RangeError as error:
            raise RangeError(f"{part}: {error}") from error
    material = TableMaterial(**parts)
    if not material.roles:
        raise RangeError("A material needs a table at least: give it a diffuse or a specular part.")
    return material


def _part(part: str, text: str, read_measured: ReadMeasured) -> Any:
    if part not in PARTS:
        raise RangeError(f"a material has no such part: choose from {', '.join(PARTS)}.")
    if part == "emission":
        return Emission(**arguments_from_text(Emission, f"radiance={text}", read_measured))
    name, _, rest = (piece.strip() for piece in text.partition(":"))
    owners = {owner.model: owner for owner in MODELS[part]}
    if name not in owners:
        near = did_you_mean(name, owners)
        raise RangeError(f'there is no model "{name}" for it{near}: choose one of {", ".join(owners)}.')
    owner = owners[name]
    try:
        return owner(**arguments_from_text(owner, rest, read_measured))
    except RangeError as error:
        raise RangeError(f"{name}: {error}") from error
