"""Qualities of methods, as properties have them."""

from typing import Any

from ..core.options import declared_options, quality_values
from .option_properties import property_name, show_option, shown_value

QUALITIES = ("draft", "good", "final")
"""From the quickest to the most exact."""


def has_quality(settings: type, group: Any, quality: str) -> bool:
    """Whether a method's settings are those of a quality.

    Parameters
    ----------
    settings : type
        The method's dataclass.
    group : bpy.types.PropertyGroup
        Its properties.
    quality : str
        One of `QUALITIES`.
    """
    values = quality_values(settings, quality)
    return all(
        getattr(group, property_name(each)) == shown_value(each, values[each.name])
        for each in declared_options(settings)
        if each.name in values
    )


def set_quality(settings: type, group: Any, quality: str) -> None:
    """Make a method's settings those of a quality; parameters are those of `has_quality`."""
    values = quality_values(settings, quality)
    for declared in declared_options(settings):
        if declared.name in values:
            show_option(declared, group, values[declared.name])
