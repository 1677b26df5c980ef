"""A picture's header, and the use that is made of it."""

from dataclasses import dataclass

GREY = "grey"
"""Colours of a picture that has none."""


@dataclass(frozen=True)
class PictureFacts:
    """Facts about a picture of radiance before its pixels are read.

    Attributes
    ----------
    format : str
    size : tuple of int
        Width and height in texels.
    window : str
        The texels that the file stores.
    channels : str
        The channels that are used.
    layers : tuple of str
        All layers of the file.
    colours : str
        Meaning of the values, and its source.
    exposure : str
        Factors that are divided out.
    comments : str
        What the file says of itself in words.
    remarks : tuple of str
        Parts of the header that are not used: predicates, whose subject is the file.
    """

    format: str
    size: tuple[int, int]
    window: str
    channels: str
    layers: tuple[str, ...]
    colours: str
    exposure: str
    comments: str
    remarks: tuple[str, ...]
