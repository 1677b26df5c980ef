"""The options of every kind of map sets: how it is made, and how it is shaded."""

from ..core.kinds.environment import EnvironmentLook
from ..core.kinds.kernel_bank.shading import BankLook
from ..core.kinds.lobe_stack.shading import StackLook
from ..core.kinds.mip_chain.shading import MipLook
from ..core.kinds.radiance_views.shading import ViewsLook
from ..core.kinds.reflection_tables.shading import TablesLook
from ..core.options import Options
from .kernel_bank import KernelBankSettings
from .lobe_stack import LobeStackSettings
from .method import MethodSettings
from .mip_chain import MipChainSettings
from .radiance_views import RadianceViewsSettings
from .reflection_tables import ReflectionTablesSettings

METHOD_SETTINGS: dict[str, type[MethodSettings]] = {
    settings.KIND: settings
    for settings in (
        RadianceViewsSettings,
        LobeStackSettings,
        ReflectionTablesSettings,
        MipChainSettings,
        KernelBankSettings,
    )
}
"""Kind of map sets -> the settings of the method that makes them, in the order of menus."""

LOOKS: dict[str, type[Options]] = {
    "radiance_views": ViewsLook,
    "reflection_tables": TablesLook,
    "lobe_stack": StackLook,
    "mip_chain": MipLook,
    "environment": EnvironmentLook,
    "kernel_bank": BankLook,
}
"""Kind of map sets -> how it is shaded; its defaults are the kind's best."""
