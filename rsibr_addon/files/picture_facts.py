"""What a picture's header says, and what is used of it."""

from dataclasses import dataclass

GREY = "grey"
"""The colours of a picture that has none."""


@dataclass(frozen=True)
class PictureFacts:
    """What is known of a picture of radiance before its pixels are read.

    Attributes
    ----------
    format : str
    size : tuple of int
        Width and height in texels.
    window : str
        Which of them the file stores.
    channels : str
        Those that are used.
    layers : tuple of str
        All that the file has.
    colours : str
        What the values are, and who says so.
    exposure : str
        What is divided out.
    remarks : tuple of str
        What is not used of the header: predicates, whose subject is the file.
    """

    format: str
    size: tuple[int, int]
    window: str
    channels: str
    layers: tuple[str, ...]
    colours: str
    exposure: str
    remarks: tuple[str, ...]
