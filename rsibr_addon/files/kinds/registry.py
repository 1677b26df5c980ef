"""The kinds of map sets: what is known of them without Blender."""

from ...core.kinds.environment import EnvironmentLook
from ...core.options import Options
from ...settings.method import MethodSettings
from ..map_set_data import ENVIRONMENT
from ..map_set_header import StoredKind
from . import kernel_bank, lobe_stack, mip_chain, radiance_views, reflection_tables

STORED: dict[str, StoredKind] = {
    radiance_views.KIND: radiance_views.STORED,
    lobe_stack.KIND: lobe_stack.STORED,
    reflection_tables.KIND: reflection_tables.STORED,
    mip_chain.KIND: mip_chain.STORED,
    kernel_bank.KIND: kernel_bank.STORED,
}
"""Kind, as descriptions name it -> its options, and the fields and words of its descriptions."""

METHOD_SETTINGS: dict[str, type[MethodSettings]] = {kind: stored.settings for kind, stored in STORED.items()}
"""Kind -> the settings of the method that makes it, in the order of menus."""


def look_types() -> dict[str, type[Options]]:
    """Kind, a picture of an environment included -> how it is shaded, as options."""
    return {**{kind: stored.look for kind, stored in STORED.items()}, ENVIRONMENT: EnvironmentLook}
