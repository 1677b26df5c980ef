"""The kinds of map sets: what is known of them without Blender."""

from ...core.lazy_table import LazyTable
from ...core.options import Options
from ..map_set_data import ENVIRONMENT
from ..map_set_header import StoredKind

AS_ADDED = ("radiance_views", "lobe_stack", "reflection_tables", "mip_chain", "kernel_bank", "kernel_pyramid")
"""The kinds in the order in which they were added: files of Blender keep a choice as its place here."""

STORED = LazyTable[StoredKind](
    __package__,
    "STORED",
    ("kernel_pyramid", "radiance_views", "lobe_stack", "reflection_tables", "mip_chain", "kernel_bank"),
)
"""Kind, as descriptions name it -> its options, and the fields and words of its descriptions. In the order of
menus."""


def look_types() -> dict[str, type[Options]]:
    """Kind, a picture of an environment included -> how it is shaded, as options."""
    from ...core.kinds.environment import EnvironmentLook

    return {**{kind: stored.look for kind, stored in STORED.items()}, ENVIRONMENT: EnvironmentLook}
