"""A mip chain on the GPU: its mips in an atlas, one pass over a mesh.

Blender's `gpu` module makes cube maps, but cannot look up between their mips. So the mips lie in one picture,
each face within a border of its neighbours' texels.
"""

import numpy as np

from ...core.conventions import Array
from ...core.filtering.irradiance import irradiance_matrix
from ...core.kinds.mip_chain.chain import MipChain
from ...core.kinds.mip_chain.shading import MipLook
from ...core.kinds.mip_chain.texture_space import with_borders
from ..drawing import Inputs, ProgramMapSet
from ..textures import GpuTexture
from .mip_chain_shaders import look_fields, mip_chain_shader


class GpuMipChain(ProgramMapSet):
    """A map set's mip chain."""

    def __init__(self, chain: MipChain) -> None:
        self._chain = chain
        self._atlas = GpuTexture("mip chain", atlas_texels(chain))
        self.textures = (self._atlas,)
        self._irradiance = irradiance_matrix(chain.harmonics)

    def inputs(self, look: MipLook) -> Inputs:
        """See `ProgramMapSet.inputs`. Reference: core/kinds/mip_chain/shading.py."""
        fields = look_fields(look, look.level(self._chain), len(self._chain.mips))
        return Inputs(mip_chain_shader, (*self._irradiance, *fields), {"atlas": self._atlas})


def atlas_texels(chain: MipChain) -> Array:
    """The mips as gpu_shaders/lib/mip_chain_lib.glsl reads them.

    Returns
    -------
    ndarray, shape (height, 6 * (size + 2), 4), float32
        A row of six bordered faces for each mip, from the bottom up; alpha is 1.
    """
    rows = [with_borders(faces) for faces in chain.mips]
    atlas = np.ones((sum(row.shape[1] for row in rows), 6 * rows[0].shape[1], 4), dtype=np.float32)
    bottom = 0
    for faces in rows:
        size = faces.shape[1]
        for face, texels in enumerate(faces):
            atlas[bottom : bottom + size, face * size : (face + 1) * size, :3] = texels
        bottom += size
    return atlas
