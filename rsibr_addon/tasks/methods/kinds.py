"""The kinds of map sets: how each is read, uploaded and shaded."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.environment import Environment
from ...core.errors import RangeError
from ...core.kinds.environment import EnvironmentLook
from ...core.kinds.kernel_bank.shading import BankLook
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.kinds.mip_chain.shading import MipLook
from ...core.kinds.radiance_views.shading import ViewsLook
from ...core.kinds.reflection_tables.shading import TablesLook
from ...device.context import ensure_context
from ...device.drawing import OnDevice
from ...device.kinds.environment import EnvironmentOnDevice
from ...device.kinds.lobe_stack import LobeStackOnDevice
from ...device.kinds.mip_chain import MipChainOnDevice
from ...device.kinds.radiance_views import RadianceViewsOnDevice
from ...device.kinds.reflection_tables import ReflectionTablesOnDevice
from ...files.kinds import (
    environment,
    kernel_bank,
    lobe_stack,
    mip_chain,
    radiance_views,
    reflection_tables,
)
from ...files.map_set import read_map_set, read_map_set_header
from ...files.map_set_data import MapSet
from ..compare import lobe_stack as stack_truth
from ..compare import radiance_views as views_truth
from ..compare.truth import Truth
from .live_materials import LiveMaterials


@dataclass(frozen=True)
class Kind:
    """What can be done with map sets of one kind.

    Attributes
    ----------
    from_map_set : callable
        The file's path, for messages, and a `MapSet` to what it holds, its content.
    on_device : callable
        The content to an `OnDevice`.
    look : type
        How it is shaded; its defaults are this kind's best.
    newest : callable
        What is uploaded and looks that were asked for, oldest first, to the last that can be drawn, or None.
    truth : Truth or None
        What pictures drawn from it are compared with; None for nothing.
    menu : str
        A menu of Blender that its preview offers beside its look; empty for none.
    """

    from_map_set: Callable[[Path, MapSet], Any]
    on_device: Callable[[Any], OnDevice]
    look: type
    newest: Callable[[Any, list[Any]], Any] = lambda on_device, looks: looks[-1]
    truth: Truth | None = None
    menu: str = ""


KINDS = {
    radiance_views.KIND: Kind(
        radiance_views.from_map_set, RadianceViewsOnDevice, ViewsLook, truth=views_truth.TRUTH
    ),
    lobe_stack.KIND: Kind(lobe_stack.from_map_set, LobeStackOnDevice, StackLook, truth=stack_truth.TRUTH),
    reflection_tables.KIND: Kind(reflection_tables.from_map_set, ReflectionTablesOnDevice, TablesLook),
    mip_chain.KIND: Kind(mip_chain.from_map_set, MipChainOnDevice, MipLook),
    environment.KIND: Kind(environment.from_map_set, EnvironmentOnDevice, EnvironmentLook),
    kernel_bank.KIND: Kind(
        kernel_bank.from_map_set, LiveMaterials, BankLook, LiveMaterials.newest, menu="RSIBR_MT_live_models"
    ),
}


@dataclass(frozen=True)
class OpenedMapSet:
    """A map set as tasks use it.

    Attributes
    ----------
    kind : str
    content : object
        What `Kind.from_map_set` made of it.
    environment : Environment or None
        The light it was made in; None where the file does not hold it.
    material : dict
        Of the map set's header.
    texels : int
        How many the file holds.
    """

    kind: str
    content: Any
    environment: Environment | None
    material: dict[str, Any]
    texels: int

    def upload(self) -> OnDevice:
        """Put the content on the GPU.

        Raises
        ------
        DeviceError
            There is no graphics driver, or it refuses a shader.
        """
        ensure_context()
        return KINDS[self.kind].on_device(self.content)


def kind_of(path: Path) -> str:
    """The kind of map set that a file is.

    Parameters
    ----------
    path : Path
        A map set, or a picture of an environment.

    Returns
    -------
    str
        One of `KINDS`.

    Raises
    ------
    MapSetError
        As `files.map_set.read_map_set_header`.
    """
    if environment.is_environment(path):
        return environment.KIND
    return str(read_map_set_header(path)["kind"])


def open_map_set(path: Path, kind: str | None = None, clamp: float | None = None) -> OpenedMapSet:
    """Read a map set.

    Parameters
    ----------
    path : Path
        A map set; where any kind will do, a picture of an environment as well.
    kind : str, optional
        The only kind that will do.
    clamp : float, optional
        Of a picture: see `core.environment.usable_radiance`.

    Returns
    -------
    OpenedMapSet

    Raises
    ------
    MapSetError
        As `files.map_set.read_map_set`, or the kind's own `from_map_set`.
    InputFileError
        A picture cannot be used: see `files.environments.read_environment`.
    RangeError
        A map set is to be clamped.
    """
    if kind is None and environment.is_environment(path):
        map_set = environment.read_as_map_set(path, clamp)
    elif clamp is not None:
        raise RangeError(f"{path} is a map set, whose light is filtered already: clamp where it is baked.")
    else:
        map_set = read_map_set(path, kind)
    return OpenedMapSet(
        map_set.kind,
        KINDS[map_set.kind].from_map_set(path, map_set),
        environment.from_map_set(path, map_set) if map_set.header["environment"]["part"] else None,
        map_set.header["material"],
        sum(pixels.shape[0] * pixels.shape[1] for pixels in map_set.maps.values()),
    )
