"""Radiance views of a reflectance model or a measurement, without Blender."""

from collections.abc import Callable, Sequence

import numpy as np

from ...core.brdf.albedo import directional_albedo
from ...core.brdf.gallery import gallery_name
from ...core.brdf.lobe_width import is_resolved, narrowest_alpha
from ...core.brdf.model import Brdf
from ...core.conventions import Array
from ...core.environment import Environment
from ...core.kinds.radiance_views.exact import (
    bytes_needed,
    exact_maps,
    parts_of,
)
from ...core.progress import Steps
from ...core.warned import warn
from ...files.brdfs import brdf_from_spec
from ...files.memory import check_memory
from ...settings.radiance_views import RadianceViewsSettings

TOGETHER = 12
"""Views that are integrated at once: they share what is costly, the reflectance."""

ALBEDO_ROWS = 64
"""Cosines of the table of albedo."""

KeepView = Callable[[int, Array, Array, float], None]
"""Keeps a finished view: its number, its diffuse and its glossy map, and its relative noise."""


class ViewsByModel:
    """A model in an environment.

    Parameters
    ----------
    settings : RadianceViewsSettings
    light : Environment

    Attributes
    ----------
    material : dict
        What a map set states of it.

    Raises
    ------
    RangeError, InputFileError
        See `files.brdfs.brdf_from_spec`.

    Warns
    -----
    RsibrWarning
        Likewise; or the light is too coarse for a lobe.
    """

    def __init__(self, settings: RadianceViewsSettings, light: Environment) -> None:
        self._settings, self._radiance = settings, light.radiance
        brdf = brdf_from_spec(settings.material)
        self._parts, self._alpha = parts_of(brdf), narrowest_alpha(brdf)
        height, width = light.radiance.shape[:2]
        if not is_resolved(self._alpha, height):
            warn(
                f"{light.name} is too coarse, at {width}x{height}, for alpha {self._alpha:.2g}: take "
                f"a larger environment, or have Cycles render the material."
            )
        self.material = {"spec": settings.material, "name": gallery_name(settings.material)}

    def check_memory(self, output: str) -> None:
        """Refuse what does not fit into this machine's memory: see `files.memory.check_memory`."""
        size = self._settings.size
        check_memory(bytes_needed(len(self._radiance), TOGETHER, size, self._alpha), output, (size, size))

    def capture(self, keep: KeepView, view_dirs: Array, numbers: Sequence[int]) -> Steps[None]:
        """Integrate some of the views.

        Parameters
        ----------
        keep : callable
            Takes each.
        view_dirs : ndarray, shape (V, 3)
            Unit vectors from the object to the camera.
        numbers : sequence of int
            Of the views.
        """
        size = self._settings.size
        for first in range(0, len(numbers), TOGETHER):
            together = numbers[first : first + TOGETHER]
            maps = []
            for part in self._parts:
                black = [np.zeros((size, size, 3), np.float32)] * len(together)
                seen = exact_maps(part, self._radiance, list(view_dirs[together]), size) if part else None
                maps.append(black if seen is None else (yield from seen))
            for view, diffuse, glossy in zip(together, *maps, strict=True):
                keep(view, diffuse, glossy, 0.0)

    def albedo(self) -> Array:
        """See `RadianceViews.albedo`."""
        mu = (np.arange(ALBEDO_ROWS) + 0.5) / ALBEDO_ROWS

        def of(part: Brdf | None) -> Array:
            return directional_albedo(part, mu) if part else np.zeros((ALBEDO_ROWS, 3))

        return np.stack([of(part) for part in self._parts]).astype(np.float32)
