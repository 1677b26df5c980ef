"""Reflectance models to choose from, as texts."""

from .car_paint import PAINTS
from .cycles_presets import preset_title
from .metals import METALS
from .spec import MATERIAL


def _lacquer(alpha: float, base: str) -> str:
    return f"layered:coat=(ggx:alpha={alpha},eta=1.5),base=({base})"


_PAINT_NAMES = {
    "ford_f8": "Black (Ford)",
    "polaris_silber": "Polaris silver",
    "opel_titan": "Titanium (Opel)",
    "bmw_339": "Titanium (BMW)",
    "2k_acrylack": "Yellow acrylic",
    "blue_matte": "Matte blue",
}
"""Measured paint -> its name for people, by its colour, where its own is not that."""

GALLERY: dict[str, dict[str, str]] = {
    "Metals": {
        **{f"Brushed {metal}": f"ggx:alpha=0.3,metal={metal}" for metal in METALS},
        "Satin aluminium": "ggx:alpha=0.15,metal=aluminium",
        "Chrome": "ggx:alpha=0.04,metal=chromium",
        "Polished gold": "ggx:alpha=0.06,metal=gold",
    },
    "Plastics": {
        "Red plastic": _lacquer(0.1, "lambert:kd=0.5/0.05/0.03"),
        "Black plastic": _lacquer(0.2, "lambert:kd=0.02"),
        "White ceramic": _lacquer(0.04, "lambert:kd=0.8/0.78/0.72"),
    },
    "Car paints": {_PAINT_NAMES.get(name, name.capitalize()): f"car_paint:name={name}" for name in PAINTS},
    "Wood and cloth": {
        "Varnished wood": _lacquer(0.08, "lambert:kd=0.35/0.15/0.05"),
        "Satin": "sum:parts=(lambert:kd=0.15/0.03/0.05)+(ward:alpha=0.35,ks=0.4)",
        "Matte clay": "lambert:kd=0.55/0.4/0.3",
    },
}
"""Group -> name for people -> text of a model, for `core.brdf.spec`."""


def gallery_name(spec: str) -> str:
    """A model's name for people: that in the gallery, that of a material of Blender's, or else its text."""
    model, _, material = spec.partition(":")
    if model.strip() == MATERIAL:
        # FILE.blend:NAME, :NAME, or a preset's
        name = material.removeprefix(":") if material.startswith(":") else material.partition(".blend:")[2]
        return name or preset_title(material)
    names = {spec: name for models in GALLERY.values() for name, spec in models.items()}
    return names.get(spec, spec)
