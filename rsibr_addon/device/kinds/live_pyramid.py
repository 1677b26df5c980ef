"""Changing light filtered on the GPU for Principled materials, with every change.

The pyramid is an atlas as `kernel_pyramid` shades from. A pass cannot read the texture that it writes, so
each map that others are made of is copied to a second atlas, where it is looked up.
"""

from dataclasses import replace
from functools import partial

import gpu
import numpy as np

from ...core.conventions import Array
from ...core.kinds.kernel_pyramid.atlas import AtlasLayout, atlas_layout
from ...core.kinds.kernel_pyramid.live import LiveMaps, live_maps
from ...core.kinds.kernel_pyramid.pyramid import resolved
from ...core.kinds.kernel_pyramid.shading import Families
from ...core.kinds.live_environment import FACE_COUNT
from ...core.lobes.rings import WIDTHS
from ...core.suns import NO_SUNS, lamp_suns
from .. import buffers
from ..passes import plain_state
from ..textures import GpuTexture, texels_shader
from .kernel_pyramid import SUNS, GpuPrincipled, family_textures
from .kernel_pyramid_texels import lookup_texels
from .live_environment_shaders import mirror_shader, tapped_shader
from .live_faces import LiveFaces, Target

_FIRST_TAP = 3
"""As gpu_shaders/lib/live_pyramid_lib.glsl has it."""

_COSINE_MAP, _LEANING_MAP, _RING_MAPS = 1, 2, 3
"""As gpu_shaders/lib/pyramid_lib.glsl has them."""


class GpuLivePyramid(LiveFaces, GpuPrincipled):
    """Six faces, black at first, and the pyramid that is made of them.

    Parameters
    ----------
    size : int
        Width of a face in texels.
    families : Families

    Raises
    ------
    RangeError
        The faces are too small: see `core.kinds.kernel_pyramid.live.live_maps`.
    ShapeError
        See `GpuPyramid`.
    DeviceError
        The driver refuses a shader.

    Notes
    -----
    Reference: `core.kinds.kernel_pyramid.live.live_pyramid`.
    """

    def __init__(self, size: int, families: Families) -> None:
        LiveFaces.__init__(self, size)
        how = live_maps(size)
        layout = atlas_layout(how.widths, how.bank)
        families = replace(families, ggx=resolved(families.ggx, how.bank, how.mirror_width))
        self._bordered = Target(FACE_COUNT * (size + 2), size + 2)
        self._atlas, self._sources = (Target(layout.width, layout.height) for _ in range(2))
        self._taps = buffers.texture(_tap_texels(how, layout))
        self._looked_up = {each.source for each in how.others}
        self._places = [
            (*corner, width + 2, width + 2) for corner, width in zip(layout.corners, how.widths, strict=True)
        ]
        self._lookups_of = partial(lookup_texels, families, layout.places, resolved=len(how.bank))
        lookups = GpuTexture("lookups", self._lookups_of(suns=NO_SUNS))
        light = GpuTexture.drawn(self._atlas.texture), lookups
        GpuPrincipled.__init__(self, (*light, *family_textures(families)), has_suns=False)
        self._lamps: tuple[bytes, bytes, float] | None = None

    def set_lamps(self, direction: Array, irradiance: Array, angle: float) -> None:
        """Set the lamps that are suns and in no face; `filter` has to be called before they show.

        Parameters
        ----------
        direction, irradiance : ndarray, shape (N, 3)
        angle : float
            See `core.suns.lamp_suns`.
        """
        lamps = direction.tobytes(), irradiance.tobytes(), angle
        if lamps == self._lamps:  # as at most changes; their texels take longer than issuing the filter
            return
        self._lamps, suns = lamps, lamp_suns(direction, irradiance, angle)
        atlas, _, *of_families = self.textures
        lookups = GpuTexture("lookups", self._lookups_of(suns=suns))
        self.textures, self._suns = (atlas, lookups, *of_families), (SUNS,) if len(suns) else ()
        self._lately.clear()  # looks are drawn from other textures now

    def filter(self) -> None:
        """Make the pyramid anew."""
        with plain_state():
            self._border(self._faces, 0, self._bordered)
            shader = mirror_shader()
            shader.bind()
            shader.uniform_sampler("faces", self._bordered.texture)
            shader.uniform_int("width", self._places[0][2] - 2)
            self._make(0, shader)
            for number in range(1, len(self._places)):
                shader = tapped_shader(self._suns)
                shader.bind()
                shader.uniform_sampler("sources", self._sources.texture)
                shader.uniform_sampler("taps", self._taps)
                shader.uniform_sampler("lookups", self.textures[1].whole())
                shader.uniform_int("row", number - 1)
                self._make(number, shader)

    def finish(self) -> None:
        """Wait until the GPU has finished."""
        self._atlas.framebuffer.read_color(0, 0, 1, 1, 4, 0, "FLOAT")

    def _make(self, number: int, shader: gpu.types.GPUShader) -> None:
        """Draw a map into the atlas, and copy it where others are made of it."""
        self._fill(self._atlas, shader, self._places[number])
        if number in self._looked_up:
            copied = texels_shader()
            copied.bind()
            copied.uniform_sampler("piece", self._atlas.texture)
            copied.uniform_int("above", 0)
            self._fill(self._sources, copied, self._places[number])


def _tap_texels(how: LiveMaps, layout: AtlasLayout) -> Array:
    """A row for each map but the mirror, as gpu_shaders/lib/live_pyramid_lib.glsl reads it."""
    texels = np.zeros(
        (len(how.others), _FIRST_TAP + max(len(each.taps) for each in how.others), 4), np.float32
    )
    corners = np.array(layout.corners)
    for number, (row, each) in enumerate(zip(texels, how.others, strict=True), 1):
        left, bottom = corners[each.source] + 1
        row[0] = (
            left / layout.width,
            bottom / layout.height,
            how.widths[each.source] / layout.width,
            len(each.taps),
        )
        row[1, :2], row[1, 2] = corners[number] + 1, each.width
        row[_FIRST_TAP : _FIRST_TAP + len(each.taps)] = each.taps
    rings = len(WIDTHS)
    texels[len(how.bank) :, 2, 0] = [*range(_RING_MAPS, _RING_MAPS + rings), _COSINE_MAP, _LEANING_MAP]
    texels[len(how.bank) : len(how.bank) + rings, 2, 1] = WIDTHS
    return texels
