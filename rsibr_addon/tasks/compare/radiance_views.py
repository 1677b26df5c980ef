"""Radiance views against Cycles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.geometry.camera import Camera
from ...core.kinds.radiance_views.shading import Mode, ViewsLook, Warping
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.progress import Progress, Steps
from ...device.kinds.radiance_views import GpuRadianceViews
from ...device.preview import PreviewRenderer
from ...host.materials import names_other_file
from ...host.meshes import load_mesh
from ...settings.radiance_views import ViewsComparison
from .comparison import Comparison, cameras_of
from .references import (
    Captured,
    Reference,
    check_material,
    error_beyond_noise,
    noise_of,
    notes,
    quality,
    render_reference,
)
from .truth import Drawn, Truth


@dataclass(frozen=True)
class ViewsWay:
    """One way to draw radiance views.

    Attributes
    ----------
    captured_views : int
        How many views it blends from.
    mode : Mode
    warping : Warping
    """

    captured_views: int
    mode: Mode
    warping: Warping

    @property
    def slug(self) -> str:
        """A name for files and reports: 12-fragment-split."""
        return f"{self.captured_views}-{self.mode}-{self.warping}"

    @property
    def name(self) -> str:
        """A name for people."""
        return f"{self.captured_views} views, {self.mode}, {self.warping} warp"


def draw(
    map_set: Path,
    views: RadianceViews,
    environment: Environment,
    material: dict[str, Any],
    settings: ViewsComparison,
) -> Steps[Drawn]:
    """Render random views with Cycles, and draw them: see `Truth.draw`.

    Notes
    -----
    Cycles' noise is not counted: see `core.metrics.relative_rmse_beyond_noise`.
    """
    captured = _captured(map_set, environment, material, settings)
    easel = _Easel(views, settings)
    references: list[Reference] = []
    drawn: dict[ViewsWay, list[Array]] = {way: [] for way in easel.ways}
    for number, camera in enumerate(cameras_of(settings)):
        what = f"rendering reference {number + 1} of {settings.views}"
        yield Progress(number + 1, settings.views + 2, what)
        seed = settings.seed + 2 * number
        references.append(render_reference(captured, camera, settings.size, settings.samples, seed))
        for way, pictures in drawn.items():
            pictures.append(easel.draw(way, camera))
    return Drawn(
        material=captured.material,
        map_size=views.size,
        settings=settings,
        references=[reference.rgba for reference in references],
        drawn=drawn,
        errors=tuple(error_beyond_noise(way, pictures, references) for way, pictures in drawn.items()),
        noise=noise_of(references),
    )


class _Easel:
    """A map set and a mesh, uploaded, to be drawn in every way asked for."""

    def __init__(self, views: RadianceViews, settings: ViewsComparison) -> None:
        self._mesh = load_mesh(settings.mesh)
        self._size = settings.size
        counts = settings.captured_views or (len(views.diffuse),)
        self._renderers = {count: PreviewRenderer(GpuRadianceViews(views.coarser(count))) for count in counts}
        self.ways = [
            ViewsWay(count, mode, warping)
            for count in counts
            for mode in settings.modes
            for warping in settings.warpings
        ]

    def draw(self, way: ViewsWay, camera: Camera) -> Array:
        """A picture of radiance times coverage, and coverage, shape (size, size, 4)."""
        mesh = self._mesh.positions, self._mesh.normals, self._mesh.triangles
        return self._renderers[way.captured_views].draw(
            *mesh, camera, self._size, ViewsLook(way.mode, way.warping)
        )


def _captured(
    map_set: Path, environment: Environment, told: dict[str, Any], settings: ViewsComparison
) -> Captured:
    material = settings.material or told["spec"]
    if settings.material is None and names_other_file(material):
        raise InputFileError(
            f"{map_set} names the material {material}, in a file that is opened only if you name it: "
            f"do so with --material."
        )
    check_material(material, told["fingerprint"])
    mesh = None if settings.mesh == "sphere" else load_mesh(settings.mesh)
    return Captured(material, environment, mesh)


def views_table(comparisons: Sequence[Comparison]) -> str:
    """Pooled errors of several comparisons as a table in Markdown.

    Parameters
    ----------
    comparisons : sequence of Comparison
        With the same ways of drawing, whatever the numbers of captured views.

    Returns
    -------
    str
        A row for each material, environment and number of captured views, in the order given; a
        column for each mode and warp, and one for the noise of the references.
    """
    columns = list(dict.fromkeys((e.way.mode, e.way.warping) for c in comparisons for e in c.errors))
    head = ["material", "environment", "views", *(f"{mode}, {warping}" for mode, warping in columns), "noise"]
    rows = [head, ["---"] * 3 + ["---:"] * (len(columns) + 1)]
    for comparison in comparisons:
        pooled = {(e.way.captured_views, e.way.mode, e.way.warping): e.pooled for e in comparison.errors}
        for captured_views in dict.fromkeys(way[0] for way in pooled):
            errors = (pooled.get((captured_views, *column), math.nan) for column in columns)
            numbers = [f"{number:.3f}" for number in (*errors, comparison.reference_noise)]
            rows.append([comparison.material, comparison.environment, str(captured_views), *numbers])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


TRUTH = Truth(
    way=ViewsWay,
    draw=draw,
    name=lambda settings: "Cycles",
    made=lambda settings: "rendered by Cycles",
    notes=notes,
    quality=quality,
    table=views_table,
    is_look=lambda way, look: (way.mode, way.warping) == (look.mode, look.warping),
)
