"""How radiance views are blended, as pictures of a report: Figure 4 of [Cabral1999]."""

import numpy as np

from ...core.conventions import Array
from ...core.geometry.directions import normalize
from ...core.kinds.radiance_views.shading import source_shares
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.kinds.radiance_views.warping import WarpChoice, chosen_warping
from ...core.maps import sphere_map
from .kind import Figure

MOST = 256
"""Largest width and height of a map in texels."""

OFF_CENTRE = (0.5, 0.3, 0.2)
"""Weights of the three sources in the direction of the view that is shown."""


def blending(views: RadianceViews) -> Figure:
    """Three captured views, each of them warped and weighted, and their sum."""
    corners = views.sphere.triangles[0]
    view_dir = normalize(np.array(OFF_CENTRE) @ views.sphere.vertices[corners])
    size, warping = min(views.size, MOST), chosen_warping(WarpChoice.AUTO, views.left_out)
    sources, shares = source_shares(views, view_dir, size, warping)
    pictures = {f"view {source + 1}, captured": _disk(views.combined[source]) for source in sources}
    for source, share in zip(sources, shares, strict=True):
        pictures[f"view {source + 1}, warped and weighted"] = _disk(share)
    pictures["their sum, the new view"] = _disk(shares.sum(axis=0))
    return Figure(
        "How a new view is blended",
        f"By the {warping} warp: three captured views, each warped to a view between them and weighted, and "
        "the sum of these, as in Figure 4 of Cabral, Olano & Nemec 1999.",
        pictures,
    )


def _disk(radiance: Array) -> Array:
    covered = sphere_map.texel_solid_angle(len(radiance))[..., None] > 0.0
    return np.concatenate([radiance * covered, covered], axis=-1).astype(np.float32)
