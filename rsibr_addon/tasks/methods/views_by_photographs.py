"""Radiance views from photographs of a ball of the material: the first method of [Cabral1999] section 2."""

from collections.abc import Sequence
from math import ceil

import numpy as np

from ...core.conventions import Array, texel_centres
from ...core.light.ball_circle import Circle
from ...core.light.ball_photograph import cut_ball
from ...core.maps.sphere_map import fill_rim
from ...core.progress import Progress, Steps, drain
from ...files.ball_list import BallPhotograph
from ...settings.radiance_views import RadianceViewsSettings
from ..light.ball import ball_picture
from .views_by_model import KeepView

LEAST_ACROSS = 4
"""Points along each side of a texel, at least: its part within the outline counts."""


class ViewsByPhotographs:
    """Photographs as views; for the rest, see `ViewsByModel`.

    What a camera far away sees of a ball is a sphere map: it is cut out and reduced. All light counts as
    glossy, as no photograph tells its parts, and the albedo is not known.
    """

    def __init__(self, settings: RadianceViewsSettings, photographs: Sequence[BallPhotograph]) -> None:
        self._photographs, self._size = photographs, settings.size
        self.material = {"spec": settings.material, "name": settings.material.removeprefix(":")}

    def check_memory(self, output: str) -> None:
        """A photograph is checked as it is read."""

    def capture(self, keep: KeepView, view_dirs: Array, numbers: Sequence[int]) -> Steps[None]:
        """Read some of the photographs.

        Raises
        ------
        InputFileError
            See `tasks.light.ball.illuminate_from_ball`.
        """
        for view in numbers:
            photograph = self._photographs[view]
            yield Progress(view, len(self._photographs), f"reading {photograph.path.name}")
            picture, _ = drain(ball_picture([photograph.path], photograph.circle))
            keep(view, np.zeros((self._size, self._size, 3), np.float32), _reduced(picture, self._size), 0.0)

    def albedo(self) -> Array:
        """See `RadianceViews.albedo`."""
        return np.ones((2, 1, 3), np.float32)


def _reduced(picture: Array, size: int) -> Array:
    """A square that touches the ball's outline as a sphere map: means over the texels' parts of the disk."""
    across = max(LEAST_ACROSS, ceil(len(picture) / size))
    middle = 0.5 * len(picture)
    points = cut_ball(picture, Circle(middle, middle, middle), across * size)
    uv = texel_centres(across * size, across * size)
    covered = (np.linalg.norm(2.0 * uv - 1.0, axis=-1) < 1.0)[..., None]

    def means(values: Array) -> Array:
        reduced: Array = values.reshape(size, across, size, across, -1).mean(axis=(1, 3))
        return reduced

    return fill_rim(means(points * covered), means(covered)[..., 0])
