"""How well captured views predict each other, by every warp: the error that radiance views state."""

import numpy as np

from ...conventions import Array, texel_centres
from ...geometry.directions import camera_frame
from ...geometry.geodesic import GeodesicSphere
from ...geometry.reflection_warp import TRUSTED_COSINE, Warp, confidence, source_cosine, source_uv
from ...maps import sphere_map
from ...resample import bilinear
from .warping import Warping, albedo_at, albedo_table, carried

POINTS = 2000
"""Texels of each view that are predicted, about."""

INSIDE = 0.98
"""Radius of the disk within which texels are predicted: those at the rim show many directions each."""


class LeftOut:
    """Captured views, each predicted from its neighbours as if it had not been captured.

    Views are added one after another, so that one at a time need be in memory. All neighbours of a view count
    as equally far from it, as about they are on a geodesic sphere: confidences alone, those of the cosine,
    make their shares.

    Parameters
    ----------
    sphere : GeodesicSphere
        The views' directions.
    size : int
        Width and height of each in texels.
    albedo : ndarray, shape (2, M, 3)
        See `RadianceViews.albedo`.
    """

    def __init__(self, sphere: GeodesicSphere, size: int, albedo: Array) -> None:
        count = len(sphere.vertices)
        self._surrounds = sphere.surrounds
        self._dirs, self._frames = sphere.vertices, camera_frame(sphere.vertices)
        edges = np.concatenate([sphere.triangles[:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
        edges = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0)
        self._neighbours = [edges[edges[:, 0] == view, 1] for view in range(count)]
        centres = texel_centres(size, size).reshape(-1, 2)
        inside = np.flatnonzero(np.linalg.norm(2.0 * centres - 1.0, axis=-1) < INSIDE)
        self._texels = inside[np.linspace(0, len(inside) - 1, min(POINTS, len(inside))).astype(np.intp)]
        self._normal = sphere_map.normal_from_uv(centres[self._texels])
        self._tables = {warping: albedo_table(albedo, warping) for warping in Warping}
        points = (count, len(self._texels))
        self._true = np.zeros((*points, 3))
        self._shares = {warp: np.zeros(points) for warp in Warp}
        self._sums = {(warping, warp): np.zeros((*points, 3)) for warping in Warping for warp in Warp}

    def add(self, view: int, diffuse: Array, glossy: Array) -> None:
        """Add one view.

        Parameters
        ----------
        view : int
            Its number.
        diffuse, glossy : ndarray, shape (size, size, 3)
        """
        self._true[view] = (diffuse + glossy).reshape(-1, 3)[self._texels]
        # The neighbours of a view are those that it predicts
        for other in self._neighbours[view]:
            normal = self._normal @ self._frames[other].T
            for warp in Warp:
                self._carry(view, other, warp, normal, diffuse, glossy)

    def errors(self) -> dict[Warping, float]:
        """Relative root-mean-square error over the texels of all views, by warp; 0 where all is black.

        Empty for directions without triangles between them.
        """
        if not self._surrounds:
            return {}
        power = float(np.sum(self._true**2))
        cosine = self._normal[:, 2]
        found = {}
        for warping, table in self._tables.items():
            predicted = sum(
                self._sums[warping, warp] / self._shares[warp][..., None] * albedo_at(table, warp, cosine)
                for warp in Warp
            )
            found[warping] = float(np.sqrt(np.sum((predicted - self._true) ** 2) / power)) if power else 0.0
        return found

    def _carry(self, view: int, other: int, warp: Warp, normal: Array, diffuse: Array, glossy: Array) -> None:
        """Add to the prediction of another view what a warp carries there of this one."""
        uv = source_uv(warp, normal, self._dirs[other], self._frames[view])
        cosine = source_cosine(warp, normal, self._dirs[other], self._dirs[view])
        share = confidence(cosine / TRUSTED_COSINE)
        self._shares[warp][other] += share
        # Interpolation is linear, so that sums of maps need no lookups of their own
        seen = bilinear(np.concatenate([diffuse, glossy], axis=-1), uv, sphere_map.wrap)
        for warping, table in self._tables.items():
            radiance = carried(seen[..., :3], seen[..., 3:], warping).get(warp)
            if radiance is not None:
                self._sums[warping, warp][other] += share[:, None] * radiance / albedo_at(table, warp, cosine)
