"""The kinds of map sets: how each is opened and shaded."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.environment import Environment
from ...core.errors import RangeError
from ...core.kinds.kernel_pyramid.pyramid import Pyramid
from ...core.lobes.bank import KernelBank
from ...core.lobes.family import KERNELS
from ...core.lobes.rings import WIDTHS
from ...device.drawing import GpuMapSet
from ...device.kinds.environment import GpuEnvironment
from ...device.kinds.kernel_pyramid import GpuPyramid
from ...device.kinds.live_environment import GpuLiveEnvironment
from ...device.kinds.live_pyramid import GpuLivePyramid
from ...device.kinds.lobe_stack import GpuLobeStack
from ...device.kinds.mip_chain import GpuMipChain
from ...device.kinds.radiance_views import GpuRadianceViews
from ...device.kinds.reflection_tables import GpuReflectionTables
from ...files.kinds import environment, kernel_pyramid, mip_chain
from ...files.kinds.registry import STORED
from ...files.map_set import read_map_set, read_map_set_header
from ...files.map_set_data import MapSet
from ..compare import kernel_pyramid as kernel_pyramid_truth
from ..compare import lobe_stack as lobe_stack_truth
from ..compare import mip_chain as mip_chain_truth
from ..compare import radiance_views as radiance_views_truth
from ..compare import reflection_tables as reflection_tables_truth
from .kind import Kind
from .live_materials import LiveFits, LiveMaterials
from .sliders import pyramid_by_sliders
from .views_figure import blending


def _pyramid(pyramid: Pyramid) -> GpuPyramid:
    return GpuPyramid(pyramid, kernel_pyramid.shipped_families())


KINDS: dict[str, Kind] = {
    "kernel_pyramid": Kind(_pyramid, kernel_pyramid_truth.TRUTH, own=True),
    "radiance_views": Kind(GpuRadianceViews, radiance_views_truth.TRUTH, figure=blending),
    "lobe_stack": Kind(GpuLobeStack, lobe_stack_truth.TRUTH),
    "reflection_tables": Kind(GpuReflectionTables, reflection_tables_truth.TRUTH),
    "mip_chain": Kind(GpuMipChain, mip_chain_truth.TRUTH),
    "kernel_bank": Kind(
        LiveMaterials,
        live=True,
        by_sliders=pyramid_by_sliders,
        menu="RSIBR_MT_live_models",
    ),
    environment.KIND: Kind(GpuEnvironment),
}
"""Kind of map sets, or `environment` for a picture -> what can be done with it."""


def own_materials_kind() -> str:
    """The kind that shades objects with their own materials."""
    return next(name for name, kind in KINDS.items() if kind.own)


def darkness() -> GpuMapSet:
    """No light, of the kind of `own_materials_kind`: in it, materials show what they emit."""
    none = np.zeros((len(WIDTHS), 2, 2, 3), np.float32)
    bank = KernelBank(KERNELS.concentrations[:1])
    return _pyramid(Pyramid(bank, none[:1], (none[:1],), none[:2], none))


def live_map_set(size: int, degree: int | None) -> tuple[str, GpuLivePyramid | GpuLiveEnvironment]:
    """What changing light is filtered into, and its kind.

    Parameters
    ----------
    size : int
        Width of a face in texels.
    degree : int or None
        Of the harmonics of a mip chain; None for a pyramid, which shades objects with their own materials.
    """
    if degree is None:
        return own_materials_kind(), GpuLivePyramid(size, kernel_pyramid.shipped_families())
    return mip_chain.KIND, GpuLiveEnvironment(size, degree=degree)


@dataclass(frozen=True)
class OpenedMapSet:
    """A map set as tasks use it.

    Attributes
    ----------
    kind : str
    content : object
        What the kind's `from_map_set` made of it.
    environment : Environment or None
        The light it was made in; None where the file does not hold it.
    material : dict
        The material in the map set's header.
    texels : int
        How many the file holds.
    header : dict
        What the map set tells of itself.
    """

    kind: str
    content: Any
    environment: Environment | None
    material: dict[str, Any]
    texels: int
    header: dict[str, Any]

    def drawable(self, fits: LiveFits | None = None) -> GpuMapSet:
        """The content, to be drawn with; made without the GPU, in any thread.

        Parameters
        ----------
        fits : LiveFits, optional
            Makes looks of a kind that is live; without, they are made at once when they are drawn.

        Raises
        ------
        DeviceError
            It holds more than a device has room for.
        """
        kind = KINDS[self.kind]
        return kind.drawable(self.content, fits) if kind.live else kind.drawable(self.content)


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
        Clamp of a picture: see `core.environment.usable_radiance`.

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
    return opened_map_set(path, map_set)


def opened_map_set(path: Path, map_set: MapSet) -> OpenedMapSet:
    """A map set as tasks use it.

    Raises
    ------
    MapSetError
        As the kind's own `from_map_set`.
    """
    light = environment.from_map_set(path, map_set) if map_set.header["environment"]["part"] else None
    is_picture = map_set.kind == environment.KIND
    return OpenedMapSet(
        map_set.kind,
        light if is_picture else STORED[map_set.kind].from_map_set(path, map_set),
        light,
        map_set.header["material"],
        sum(pixels.shape[0] * pixels.shape[1] for pixels in map_set.maps.values()),
        {"kind": map_set.kind, **map_set.header},
    )
