"""Materials that come with us: each is one BSDF node of Cycles and its inputs."""

from dataclasses import dataclass, field

from .metals import METALS

Value = float | tuple[float, ...]


@dataclass(frozen=True)
class Preset:
    """A material in words and in numbers.

    Attributes
    ----------
    summary : str
        One line for people.
    node : str
        Type of the BSDF node.
    inputs : dict of str to float or tuple
        Values of its inputs by name; others keep their defaults. Colours are linear Rec. 709 with
        alpha, roughness is the square root of GGX's alpha.
    options : dict of str to str
        Its other properties.
    """

    summary: str
    node: str
    inputs: dict[str, Value]
    options: dict[str, str] = field(default_factory=dict)


def _metal(summary: str, eta: Value, k: Value, alpha: float) -> Preset:
    """A conductor of refractive index eta + i k at about 650, 550 and 450 nm, under GGX."""
    return Preset(
        summary,
        "ShaderNodeBsdfMetallic",
        {"IOR": eta, "Extinction": k, "Roughness": alpha**0.5},
        {"fresnel_type": "PHYSICAL_CONDUCTOR"},
    )


def _coated(summary: str, colour: Value, alpha: float) -> Preset:
    """A Lambert base beneath a dielectric GGX surface of index 1.5."""
    return Preset(
        summary,
        "ShaderNodeBsdfPrincipled",
        {"Base Color": colour, "Roughness": alpha**0.5, "IOR": 1.5},
    )


PRESETS: dict[str, Preset] = {
    "mirror": Preset(
        "a perfect mirror, without loss",
        "ShaderNodeBsdfAnisotropic",
        {"Color": (1.0, 1.0, 1.0, 1.0), "Roughness": 0.0},
    ),
    "copper": _metal("rough copper, alpha .3", (0.200, 0.924, 1.102), (3.912, 2.452, 2.142), 0.3),
    "gold": _metal("polished gold, alpha .05", (0.143, 0.375, 1.442), (3.983, 2.386, 1.603), 0.05),
    "silver": _metal("rough silver, alpha .3", METALS["silver"].eta, METALS["silver"].k, 0.3),
    "nickel": _metal("rough nickel, alpha .3", METALS["nickel"].eta, METALS["nickel"].k, 0.3),
    "satin-aluminium": _metal(
        "satin aluminium, alpha .15", (1.345, 0.965, 0.617), (7.474, 6.400, 5.303), 0.15
    ),
    "chrome": _metal("chrome, alpha .005", (3.110, 3.180, 2.320), (3.310, 3.330, 3.140), 0.005),
    "plastic": _coated("clear-coated red plastic, alpha .1", (0.50, 0.05, 0.03, 1.0), 0.1),
    "black-plastic": _coated("black plastic, alpha .2", (0.02, 0.02, 0.02, 1.0), 0.2),
    "varnished-wood": _coated("varnished brown wood, alpha .08", (0.35, 0.15, 0.05, 1.0), 0.08),
    "ceramic": _coated("glazed white ceramic, alpha .01", (0.80, 0.78, 0.72, 1.0), 0.01),
    "clay": Preset("matte clay: Lambert alone", "ShaderNodeBsdfDiffuse", {"Color": (0.55, 0.40, 0.30, 1.0)}),
    "satin": Preset(
        "red cloth with a soft sheen",
        "ShaderNodeBsdfPrincipled",
        {
            "Base Color": (0.15, 0.03, 0.05, 1.0),
            "Roughness": 0.6,
            "Sheen Weight": 0.6,
            "Sheen Roughness": 0.3,
            "Sheen Tint": (1.0, 0.4, 0.5, 1.0),
        },
    ),
    "car-paint": Preset(
        "blue paint with metallic flakes, alpha .25, beneath a clear coat, alpha .013",
        "ShaderNodeBsdfPrincipled",
        {
            "Base Color": (0.03, 0.12, 0.45, 1.0),
            "Metallic": 0.5,
            "Roughness": 0.5,
            "Coat Weight": 1.0,
            "Coat Roughness": 0.013**0.5,  # The sharpest lobe of a measured paint, [Guenther2005] table 1.
            "Coat IOR": 1.5,
        },
    ),
}


def preset_title(name: str) -> str:
    """The name of one of `PRESETS` for people."""
    return name.replace("-", " ").title()
