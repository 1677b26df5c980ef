"""How pictures are rendered from map sets."""

import re
from dataclasses import dataclass
from typing import Any

from ..core.errors import RangeError
from ..core.options import Options, option
from .matte import BackgroundOptions

LAST_FRAME = 1048574
"""Blender counts no further, and no further down than its negative."""


def _samples_option(default: int | None, **more: Any) -> Any:
    return option(
        default,
        label="Samples",
        help="Draws of a picture, each moved by a part of a pixel; their mean has smooth edges",
        least=1,
        most=4096,
        soft_most=256,
        **more,
    )


@dataclass(frozen=True, kw_only=True)
class RenderOptions(BackgroundOptions):
    """How the render engine draws a picture."""

    samples: int = _samples_option(16)
    background: str | None = option(
        None,
        label="Picture",
        help="Photograph behind the objects, whose middle fills the camera's frame",
        none="the world",
        none_as="",
        subtype="FILE_PATH",
        metavar="PICTURE",
    )


@dataclass(frozen=True, kw_only=True)
class FramesOptions(Options):
    """Which frames of a file are rendered, and how."""

    frames: str | None = option(
        None,
        label="Frames",
        help="A frame, or the first and the last of several and the step between them",
        none="the file's current frame",
        metavar="N|N-N[:STEP]",
    )
    samples: int | None = _samples_option(None, none="what the file says")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.frames is not None:
            _range_of(self.frames)

    @property
    def numbers(self) -> range | None:
        """The frames; None for the file's current one."""
        return None if self.frames is None else _range_of(self.frames)


def _range_of(frames: str) -> range:
    """The frames that a text names.

    Raises
    ------
    RangeError
        It names none, or one beyond Blender's.
    """
    named = re.fullmatch(r"(-?\d+)(?:-(-?\d+)(?::(\d+))?)?", frames)
    first, last, step = (int(named[1]), int(named[2] or named[1]), int(named[3] or 1)) if named else (1, 0, 1)
    if not -LAST_FRAME <= first <= last <= LAST_FRAME or step < 1:
        raise RangeError(
            f"Frames cannot be '{frames}': give one, such as 12, the first and the last, such as 1-48, or a "
            f"step as well, such as 1-48:2."
        )
    return range(first, last + 1, step)
