"""A description in words, for panels, reports and `rsibr info` alike."""

from pathlib import Path
from typing import Any

from ..core.brdf.gallery import gallery_name
from ..core.options import declared_options
from .kinds.registry import STORED


def told_facts(header: dict[str, Any]) -> dict[str, str]:
    """The main facts about a map set.

    Parameters
    ----------
    header : dict
        A whole description, from `files.map_set.read_map_set_header`, as for all functions here.

    Returns
    -------
    dict
        In words: name -> value.
    """
    material = header["material"]
    named = material.get("name") or gallery_name(material.get("brdf", ""))
    return {
        "Kind": STORED[header["kind"]].settings.LABEL,
        "Light": in_words(Path(header["environment"]["name"]).stem),
        **({"Material": in_words(named)} if named else {}),
        "Maps": f"{len(header['parts'])}, {_size(header['size'])}",
        **STORED[header["kind"]].facts(header),
    }


def told_errors(header: dict[str, Any]) -> dict[str, str]:
    """The errors that its maker promises, in words; or that there is none."""
    stated = {in_words(f"error, {name}"): f"{error:.2g}" for name, error in largest_errors(header).items()}
    return stated or {"Error": "none stated"}


def largest_errors(header: dict[str, Any]) -> dict[str, float]:
    """The errors that its maker promises, by the description's names: of several of a name, the largest."""
    stated = header["error_bound"] or {}
    return {name: max(value) if isinstance(value, list) else value for name, value in stated.items()}


def told_making(header: dict[str, Any]) -> dict[str, str]:
    """The environment, material, settings and software of the bake, and what was painted since."""
    environment = header["environment"]
    clamped = f", clamped to {environment['clamp']:g}" if "clamp" in environment else ""
    return {
        "Environment": f"{environment['name']}, {_size(environment['size'])}{clamped}",
        "Layout": in_words(header["layout"]),
        "Axes": header["axes"],
        **_settings(header),
        **({"Painted": ", ".join(header["painted"]["parts"]) or "nothing"} if "painted" in header else {}),
        "Made by": header["software"],
    }


def in_words(name: str) -> str:
    """A name for programs as one for people: "sphere_map" as "Sphere map"."""
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def _size(size: list[int]) -> str:
    return "{} x {}".format(*size)


def _settings(header: dict[str, Any]) -> dict[str, str]:
    """Material and settings by their labels, but for what facts tell already and what is for programs."""
    options = {each.name: each.option for each in declared_options(STORED[header["kind"]].settings)}
    known, told = told_facts(header), {}
    for name, value in (header["material"] | header["settings"]).items():
        option = options.get(name)
        label = option.label if option else in_words(name)
        for_programs = name == "fingerprint" or isinstance(value, dict | None)
        if for_programs or label in known or value in known.values():
            continue
        if option and isinstance(value, str | int) and value in option.choices:
            told[label] = option.choices[value].label
        else:
            told[label] = f"{_value(value)} {option.unit if option else ''}".rstrip()
    return told


def _value(value: Any) -> str:
    match value:
        case bool():
            return "yes" if value else "no"
        case float():
            return f"{value:.3g}"
        case list():
            return ", ".join(map(_value, value))
    return str(value)
