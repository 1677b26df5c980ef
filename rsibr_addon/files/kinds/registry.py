"""The kinds of map sets that files hold."""

from ..map_set_header import StoredKind
from . import kernel_bank, lobe_stack, mip_chain, radiance_views, reflection_tables

STORED: dict[str, StoredKind] = {
    radiance_views.KIND: radiance_views.STORED,
    lobe_stack.KIND: lobe_stack.STORED,
    reflection_tables.KIND: reflection_tables.STORED,
    mip_chain.KIND: mip_chain.STORED,
    kernel_bank.KIND: kernel_bank.STORED,
}
"""Kind, as descriptions name it -> the fields and words of its descriptions."""
