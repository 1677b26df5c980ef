"""A lobe stack on the GPU: its maps in one 3D texture, one pass over a mesh."""

import numpy as np

from ...core.conventions import Array
from ...core.errors import DeviceError
from ...core.half_floats import half_holds
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.kinds.lobe_stack.stack import LAYOUTS, LobeStack
from ...core.suns import far_from
from ..drawing import Inputs, ProgramMapSet
from ..shaders import MeshProgram
from ..textures import GpuTexture

DEEPEST = 2048
"""Greatest number of slices of a 3D texture in every driver."""

_ROUNDING = 1e-6
"""Of cosines between directions in single precision."""

lobe_stack_shader = MeshProgram(
    "lobe_stack",
    "Stack stack",
    "float layout_number; float lobes; float taps; float slices; "
    "float suns; float kernels; float sun_row; float reach; vec4 cone; "
    "float antialiased; float unused_0; float unused_1; float unused_2;",
    {"elevations": "FLOAT_2D", "maps": "FLOAT_3D"},
)
"""Draws a mesh from a lobe stack."""


class GpuLobeStack(ProgramMapSet):
    """A map set's lobe stack.

    Raises
    ------
    DeviceError
        It has more maps than a 3D texture has slices.
    """

    def __init__(self, stack: LobeStack) -> None:
        self._stack = stack
        texels = map_texels(stack)
        if len(texels) > DEEPEST:
            raise DeviceError(
                f"{len(texels)} maps do not fit into a texture of {DEEPEST}: fit fewer lobes or slices."
            )
        half = half_holds([maps for lobe in stack.maps for maps in lobe])
        self._maps = GpuTexture("lobe stack", texels, "RGBA16F" if half else "RGBA32F", deep=True)
        self.textures = (self._maps,)
        lobes, slices = stack.maps.shape[:2]
        numbers = LAYOUTS.index(stack.layout), lobes, stack.taps.shape[2], slices
        self._numbers = np.array(numbers, dtype=np.float64)
        self._elevations: dict[tuple[int, ...], GpuTexture] = {}

    def inputs(self, look: StackLook) -> Inputs:
        """See `ProgramMapSet.inputs`. Reference: core/kinds/lobe_stack/shading.py."""
        fields = self._numbers, sun_numbers(self._stack), np.array([float(look.antialiased)])
        return Inputs(
            lobe_stack_shader, fields, {"elevations": self._elevations_of(look), "maps": self._maps}
        )

    def _elevations_of(self, look: StackLook) -> GpuTexture:
        """The elevations' texture, one per choice of lobes: a frame may show two; steady ones upload none."""
        shown = look.shown(self._stack)
        if shown not in self._elevations:
            self._elevations[shown] = GpuTexture("elevations", elevation_texels(self._stack, shown))
        return self._elevations[shown]


def map_texels(stack: LobeStack) -> Array:
    """The maps as gpu_shaders/lib/lobe_stack_lib.glsl reads them.

    Returns
    -------
    ndarray, shape (L * sheets * P, size + 2, size + 2, 4), float32
        Alpha is 1.
    """
    size, representation = stack.size, stack.representation
    lobes, slices, sheets = stack.maps.shape[:3]
    beyond = np.arange(-1, size + 1)
    sheet, row, column = np.meshgrid(np.arange(sheets), beyond, beyond, indexing="ij")
    columns, rows, wrapped = representation.wrap(column, row, sheet, size, size)
    texels = np.ones((lobes, sheets, slices, size + 2, size + 2, 4), dtype=np.float32)
    texels[..., :3] = stack.maps[:, :, wrapped, rows, columns].swapaxes(1, 2)
    return texels.reshape(-1, size + 2, size + 2, 4)


def elevation_texels(stack: LobeStack, shown: tuple[int, ...]) -> Array:
    """All values that depend on the view's elevation, for gpu_shaders/lib/lobe_stack_lib.glsl.

    Parameters
    ----------
    stack : LobeStack
    shown : tuple of int
        Lobes that are shown: see `StackLook.shown`.

    Returns
    -------
    ndarray, shape (1 + L * (1 + T) + R, S, 4), float32
        Lobes that are not shown have a scale of 0. R rows are those of suns.
    """
    lobes, slices, taps = stack.taps.shape
    of_suns = _sun_texels(stack)
    texels = np.zeros((1 + lobes * (1 + taps) + len(of_suns), slices, 4), dtype=np.float32)
    texels[len(texels) - len(of_suns) :] = of_suns
    texels[0, :, 0] = stack.mu
    of_lobes = texels[1 : 1 + lobes * (1 + taps)].reshape(lobes, 1 + taps, slices, 4)
    for lobe in shown:
        of_lobes[lobe, 0, :, :3] = stack.scale[lobe]
    of_lobes[:, 1:, :, :2] = stack.offsets.swapaxes(1, 2)
    of_lobes[:, 1:, :, 2] = stack.taps.swapaxes(1, 2)
    return texels


def sun_numbers(stack: LobeStack) -> Array:
    """A stack's `LobeSuns`, shape (2, 4): see gpu_shaders/lib/lobe_stack_lib.glsl."""
    if stack.sunlight is None:
        return np.zeros((2, 4))
    lobes, _, taps = stack.taps.shape
    suns, bank = stack.sunlight.suns, stack.sunlight.bank
    reach = far_from(suns.widened(bank))
    total = suns.direction.sum(axis=0)
    middle = total / max(float(np.linalg.norm(total)), _ROUNDING)
    within = np.arccos(np.clip(suns.direction @ middle, -1.0, 1.0)).max() + np.arccos(1.0 - reach)
    least = np.cos(min(within, np.pi)) - _ROUNDING
    return np.array([[len(suns), len(bank), 1 + lobes * (1 + taps), reach], [*middle, least]])


def _sun_texels(stack: LobeStack) -> Array:
    """Their rows, shape (R, S, 4); none without suns."""
    slices = len(stack.mu)
    if stack.sunlight is None:
        return np.zeros((0, slices, 4))
    suns, weights = stack.sunlight.suns, stack.sunlight.weights
    widened = suns.widened(stack.sunlight.bank)
    texels = np.zeros((2 * len(suns) + (1 + len(weights)) * len(widened), slices, 4))
    of_suns, of_kernels, of_lobes = np.split(texels, [2 * len(suns), 2 * len(suns) + len(widened)])
    of_suns[0::2, 0, :3], of_suns[1::2, 0, :3] = suns.direction, suns.irradiance
    of_kernels[:, 0, :2] = np.stack([widened.kappa, widened.peaks], axis=-1)
    by_kernel = weights.swapaxes(1, 2).reshape(len(of_lobes), -1, 3)
    of_lobes[..., :3] = by_kernel  # one for all elevations, or one for each
    return texels
