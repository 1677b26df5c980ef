"""The picture's channels in an OpenEXR file, found by their names."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.counted import in_short
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
"""Last word of a channel's name, in small letters -> its part of a colour."""

KINDS = ("RGB", ("Y", "RY", "BY"), "XYZ", "Y")
"""Sets of channels that make a picture; the first that a layer has in full is used."""

PARTIAL = ("R", "G", "B", "RY", "BY")
"""Roles of channels that make no colour without others."""

MAIN = frozenset(
    ("combined", "beauty", "rgba", "rgb", "c", "ci", "color", "colour", "image", "main", "final")
)
"""Renderers' names for the layer that is the picture; the others are its passes."""


@dataclass(frozen=True)
class Layer:
    """A picture in a file.

    Attributes
    ----------
    part : int
    name : str
        Beginning of its channels' names, or its part's name; empty where there is none.
    channels : dict of str to str
        Names of channels by their role, one of `KINDS` and perhaps "A".
    left : tuple of str
        Names of channels of an incomplete colour, so that the picture is grey.
    """

    part: int
    name: str
    channels: dict[str, str]
    left: tuple[str, ...] = ()

    @property
    def is_grey(self) -> bool:
        """Whether the picture has no colour."""
        return self.channels.keys() <= {"Y", "A"}

    @property
    def rank(self) -> int:
        """0 for a picture without a name, 1 for one of `MAIN`, 2 for others."""
        if not self.name:
            return 0
        return 1 if MAIN & set(self.name.lower().split(".")) else 2


def layers_of(headers: Sequence[dict[str, Any]]) -> list[Layer]:
    """Every picture of a file, in colour or grey.

    Parameters
    ----------
    headers : sequence of dict
        Headers of the file's parts: see `exr.OpenExr.headers`.

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
        The file's path, for messages.
    layers : sequence of Layer
        At least one.
    wanted : str or None
        A layer's name, or its ending.

    Returns
    -------
    Layer
        The wanted one; else one of `MAIN`, or the first.
    list of str
        Other pictures that may be meant: predicates, whose subject is the file.

    Raises
    ------
    InputFileError
        There is no such layer, or it is not clear which is meant.
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
    # Passes of a part are not meant; other parts, views and view layers may be
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
    return in_short([layer.name or "that without a name" for layer in layers])
