"""Finished views in the folder of a capture's work, so that a capture which was interrupted goes on."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, SchemaError
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.schema import decode, loads
from ...files.atomic import written_aside
from ...files.ball_list import Triple
from ...files.exr import read_parts, write_parts
from ...files.exr_part import Part

NOISE = "noise"
"""Attribute of a finished view: its relative standard error."""


@dataclass(frozen=True)
class KeptViews:
    """The views of one capture.

    Attributes
    ----------
    folder : Path
        See `files.work_folder.kept_parts`.
    """

    folder: Path

    def keep(self, view: int, diffuse: Array, glossy: Array, noise: float) -> None:
        """Write a view; see `views_by_model.KeepView`."""
        parts = [
            Part(name, {"RGB": radiance}, {NOISE: repr(noise)})
            for name, radiance in {"diffuse": diffuse, "glossy": glossy}.items()
        ]
        with written_aside(self._path(view), force=True) as aside:
            write_parts(aside, parts)

    def missing(self, count: int) -> list[int]:
        """Numbers of those of `count` views that are not there whole."""
        return [view for view in range(count) if not self._is_finished(view)]

    def parts(self, view: int) -> list[Part]:
        """Diffuse and glossy part of a view."""
        return read_parts(self._path(view))

    def read(self, view_dirs: Array) -> RadianceViews:
        """All views, in memory, of V directions, shape (V, 3)."""
        read = [[part.side_by_side("RGB") for part in self.parts(view)] for view in range(len(view_dirs))]
        diffuse, glossy = (np.stack(maps) for maps in zip(*read, strict=True))
        return RadianceViews(diffuse, glossy, view_dirs=view_dirs)

    def noise(self, count: int) -> float:
        """Relative standard error of the texels of `count` views, which are there."""
        squares = [float(self.parts(view)[0].attributes[NOISE]) ** 2 for view in range(count)]
        return float(np.sqrt(np.mean(squares)))

    def choose(self, view_dirs: Array) -> None:
        """Write the directions of further views, shape (n, 3): all that are chosen so far."""
        with written_aside(self._chosen, force=True) as aside:
            aside.write_text(json.dumps(view_dirs.tolist()))

    def chosen(self) -> Array:
        """What was written last by `choose`, shape (n, 3); nothing before that."""
        try:
            rows = decode(list[Triple], loads(self._chosen.read_bytes()))
        except (OSError, SchemaError):
            rows = []
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    @property
    def _chosen(self) -> Path:
        return self.folder / "chosen.json"

    def _path(self, view: int) -> Path:
        return self.folder / f"view{view:03d}.exr"

    def _is_finished(self, view: int) -> bool:
        try:
            return len(self.parts(view)) == 2
        except InputFileError:
            return False
