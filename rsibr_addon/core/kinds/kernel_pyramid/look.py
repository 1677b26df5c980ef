"""Which material a kernel pyramid is shaded as."""

from dataclasses import dataclass

from ...options import option
from ..look_options import antialiased_option
from ..principled_material import PrincipledMaterial


@dataclass(frozen=True)
class PrincipledLook(PrincipledMaterial):
    """How a kernel pyramid is shaded."""

    own: bool = option(
        True,
        label="Own Materials",
        help="Shade an object with the materials of its slots instead of the one below",
    )
    antialiased: bool = antialiased_option("gloss")
