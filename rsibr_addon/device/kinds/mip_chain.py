"""A mip chain on the GPU: its mips in an atlas, one pass over a mesh.

Blender's `gpu` module makes cube maps, but cannot look up between their mips. So the mips lie in one picture,
each face within a border of its neighbours' texels.
"""

import numpy as np

from ...core.conventions import Array
from ...core.filtering.irradiance import irradiance_coefficients
from ...core.kinds.mip_chain.chain import MipChain
from ...core.kinds.mip_chain.shading import MipLook
from ...core.kinds.mip_chain.texture_space import with_borders
from ..buffers import with_alpha
from ..drawing import Inputs, ProgramMapSet
from ..textures import GpuTexture
from .mip_chain_shaders import look_fields, mip_chain_shader, place_rows


class GpuMipChain(ProgramMapSet):
    """A map set's mip chain."""

    def __init__(self, chain: MipChain) -> None:
        self._atlas = GpuTexture("mip chain", atlas_texels(chain))
        self._harmonics = GpuTexture("harmonics", harmonics_texels(chain.harmonics))
        self._places = GpuTexture("rooms", place_texels(chain))
        self.textures = (self._atlas, self._harmonics, self._places)
        self._lobes, self._probes = chain.lobes, len(chain.probes)

    def inputs(self, look: MipLook) -> Inputs:
        """See `ProgramMapSet.inputs`. Reference: core/kinds/mip_chain/shading.py."""
        textures = {"atlas": self._atlas, "harmonics": self._harmonics, "places": self._places}
        return Inputs(mip_chain_shader, look_fields(look, self._lobes, self._probes), textures)


def harmonics_texels(harmonics: Array) -> Array:
    """The coefficients of irradiance as gpu_shaders/lib/irradiance_lib.glsl reads them, shape (1, n, 4)."""
    return with_alpha(irradiance_coefficients(harmonics)[None])


def place_texels(chain: MipChain) -> Array:
    """The probes' places as gpu_shaders/lib/probes_lib.glsl reads them, shape (n, 3, 4); zeros if none."""
    rows = [place_rows(probe.place) for probe in chain.probes]
    return np.array(rows or [np.zeros((3, 4))], dtype=np.float32)


def atlas_texels(chain: MipChain) -> Array:
    """The mips as gpu_shaders/lib/mip_chain_lib.glsl reads them.

    Returns
    -------
    ndarray, shape (height, 6 * (size + 2), 4), float32
        A row of six bordered faces for each mip, from the bottom up, of the chain and then of each probe;
        alpha is 1.
    """
    chains = chain.mips, *(probe.mips for probe in chain.probes)
    rows = [with_borders(faces) for mips in chains for faces in mips]
    atlas = np.ones((sum(row.shape[1] for row in rows), 6 * rows[0].shape[1], 4), dtype=np.float32)
    bottom = 0
    for faces in rows:
        size = faces.shape[1]
        for face, texels in enumerate(faces):
            atlas[bottom : bottom + size, face * size : (face + 1) * size, :3] = texels
        bottom += size
    return atlas
