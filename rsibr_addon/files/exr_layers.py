"""Which channels of an OpenEXR file are the picture, by their names."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.errors import InputFileError

ROLES = {name: name.upper() for name in ("r", "g", "b", "a", "x", "y", "z", "ry", "by")} | {
    "red": "R",
    "green": "G",
    "blue": "B",
    "alpha": "A",
    "grey": "Y",
    "gray": "Y",
    "luminance": "Y",
}
"""Last word of a channel's name, in small letters -> what it is of a colour."""

KINDS = ("RGB", ("Y", "RY", "BY"), "XYZ", "Y")
"""What a picture is made of; the first that a layer has whole."""

PARTIAL = ("R", "G", "B", "RY", "BY")
"""Roles of what is no colour without others."""

MAIN = frozenset(
    ("combined", "beauty", "rgba", "rgb", "c", "ci", "color", "colour", "image", "main", "final")
)
"""What renderers call the layer that is the picture, the others being its passes."""


@dataclass(frozen=True)
class Layer:
    """A picture in a file.

    Attributes
    ----------
    part : int
    name : str
        What its channels' names begin with, or its part's name; empty where it has none.
    channels : dict of str to str
        Names of channels by their role, one of `KINDS` and perhaps "A".
    left : tuple of str
        Names of channels of a colour that has not all of its own, so that the picture is grey.
    """

    part: int
    name: str
    channels: dict[str, str]
    left: tuple[str, ...] = ()

    @property
    def is_grey(self) -> bool:
        """Whether it has no colour."""
        return self.channels.keys() <= {"Y", "A"}

    @property
    def rank(self) -> int:
        """0 of a picture without a name, 1 of one that renderers name so, 2 of others."""
        if not self.name:
            return 0
        return 1 if MAIN & set(self.name.lower().split(".")) else 2


def layers_of(headers: Sequence[dict[str, Any]]) -> list[Layer]:
    """Every picture in colour or grey.

    Parameters
    ----------
    headers : sequence of dict
        Of the file's parts, as `exr.OpenExr.headers` has them.

    Returns
    -------
    list of Layer
        Part by part, by name.
    """
    layers = []
    for number, header in enumerate(headers):
        found: dict[str, dict[str, str]] = {}
        # Capitals come first, and win
        for name in sorted(channel.name for channel in header["channels"]):
            prefix, _, word = name.rpartition(".")
            prefix = prefix if prefix.isprintable() else ascii(prefix)
            if role := ROLES.get(word.lower()):
                found.setdefault(prefix, {}).setdefault(role, name)
        for prefix, roles in found.items():
            kind = next((kind for kind in KINDS if roles.keys() >= set(kind)), None)
            if kind is not None:
                label = prefix or (str(header.get("name", "")) if len(headers) > 1 else "")
                channels = {role: roles[role] for role in (*kind, "A") if role in roles}
                left = tuple(roles[role] for role in PARTIAL if role in roles) if kind == "Y" else ()
                layers.append(Layer(number, label, channels, left))
    return layers


def choose(path: str | Path, layers: Sequence[Layer], wanted: str | None) -> tuple[Layer, list[str]]:
    """The picture to take.

    Parameters
    ----------
    path : str or Path
        Of the file, for messages.
    layers : sequence of Layer
        At least one.
    wanted : str or None
        A layer's name, or how it ends.

    Returns
    -------
    Layer
        The one that is wanted; else the one that renderers name so, or the first.
    list of str
        What was left although it might be meant: predicates, whose subject is the file.

    Raises
    ------
    InputFileError
        There is none of that name, or no telling which is meant.
    """
    if wanted is not None:
        return _named(path, layers, wanted), []
    coloured = [layer for layer in layers if not layer.is_grey] or list(layers)
    likely = [layer for layer in coloured if layer.rank == min(layer.rank for layer in coloured)]
    chosen = likely[0]
    if chosen.rank == 2 and len({layer.part for layer in likely}) < len(likely) and not _are_views(likely):
        raise InputFileError(
            f"{path} holds several layers ({_listed(likely)}): name one, as {path}:{chosen.name}."
        )
    # The passes of a part are known to be none; other parts, views and view layers may be meant
    others = [layer for layer in layers if layer.part != chosen.part or layer in likely]
    others.remove(chosen)
    if not others:
        return chosen, []
    return chosen, [
        f"holds several pictures: {chosen.name or 'that without a name'} is taken, {_listed(others)} not; "
        f"name another as {path}:{others[0].name}."
    ]


def _named(path: str | Path, layers: Sequence[Layer], wanted: str) -> Layer:
    low = wanted.lower()
    whole = [layer for layer in layers if layer.name.lower() == low]
    for layer in whole or [layer for layer in layers if layer.name.lower().endswith(f".{low}")]:
        return layer
    raise InputFileError(f"{path} holds no layer {wanted}: choose {_listed(layers)}.")


def _are_views(layers: Iterable[Layer]) -> bool:
    return all({"left", "right"} & set(layer.name.lower().split(".")) for layer in layers)


def _listed(layers: Sequence[Layer]) -> str:
    names = [layer.name or "that without a name" for layer in layers]
    return ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
