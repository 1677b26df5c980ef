"""Words in panels."""

from textwrap import wrap

import bpy

from ..device.screen_scale import ui_scale

LETTER_WIDTH, MARGIN = 7, 60
"""Mean width of a letter in a panel, and width of a region's margins and an icon; in pixels at Blender's own
scale."""

BUTTON_WIDTH = 40
"""What icons beside a sentence take of its width, in pixels at Blender's own scale."""

LONGEST_LABEL, LONG_LABEL_SHARE = 14, 0.47
"""Letters of a label that fit into Blender's two fifths of a row, and the share that longer ones get."""

SOLID = "Solid shading has neither lamps nor world: choose Material Preview or Rendered for their light."
"""What of Blender's own shading surprises beside a preview, or as light."""


def panel_width(context: bpy.types.Context) -> int:
    """Width of the region that a panel is drawn in, in pixels at Blender's own scale."""
    return int(context.region.width / ui_scale())


def letters_in(width: int) -> int:
    """How many letters a line has room for beside an icon, in a region of a width by `panel_width`."""
    return max(20, (width - MARGIN) // LETTER_WIDTH)


def tell(layout: bpy.types.UILayout, message: str, width: int, icon: str = "ERROR") -> None:
    """A sentence, broken into lines; Blender would cut it off.

    Parameters
    ----------
    layout : bpy.types.UILayout
    message : str
    width : int
        Width of the region in pixels.
    icon : str
        Before the first line; "NONE" begins all lines at the left.
    """
    below = "NONE" if icon == "NONE" else "BLANK1"
    column = layout.column(align=True)
    for number, text in enumerate(wrap(message, letters_in(width), break_on_hyphens=False)):
        column.label(text=text, icon=icon if number == 0 else below)


def duration(seconds: float) -> str:
    """A duration in words."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 90:
        return f"about {10 * round(seconds / 10)} seconds"
    if seconds < 5400:
        return f"about {round(seconds / 60)} minutes"
    return f"about {seconds / 3600:.1f} hours"


def amount(size: float) -> str:
    """A number of bytes in words."""
    megabytes = size / 1e6
    if megabytes >= 1000:
        return f"{megabytes / 1000:.1f} GB"
    return f"{megabytes:.0f} MB" if megabytes >= 10 else f"{megabytes:.1f} MB"


def capital(words: str) -> str:
    """The same with a capital letter first."""
    return words[:1].upper() + words[1:]
