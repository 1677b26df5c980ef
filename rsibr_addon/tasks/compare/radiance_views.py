"""Radiance views against Cycles; those of a model against the model."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.brdf.lobe_width import narrowest_alpha
from ...core.brdf.spec import is_model
from ...core.conventions import Array
from ...core.counted import counted
from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.geometry.camera import Camera
from ...core.kinds.radiance_views.exact import ring_count
from ...core.kinds.radiance_views.shading import Mode, ViewsLook
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.kinds.radiance_views.warping import WarpChoice, Warping
from ...core.progress import Steps
from ...device.kinds.radiance_views import GpuRadianceViews
from ...device.preview import PreviewRenderer
from ...host.materials import names_other_file
from ...host.meshes import load_mesh
from ...settings.radiance_views import ViewsComparison
from ..reflectance.brdfs import load_brdf, told_brdf
from . import exact, model_or_cycles, references
from .comparison import cameras_of
from .truth import Drawn, Telling, Truth


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
        return f"{counted(self.captured_views, 'view')}, {self.mode}, {self.warping} warp"


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
    settings = replace(settings, material=_material(map_set, material, settings))
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    truth: model_or_cycles.Pictures
    if _is_by_model(settings):
        model = yield from load_brdf(settings.material or "")
        rings = ring_count(views.size, len(environment.radiance), narrowest_alpha(model))
        pictures = yield from exact.exact_pictures(model, environment, cameras, mesh, settings.size, rings)
        truth = model_or_cycles.ByModel(pictures)
    else:
        if "fingerprint" in material:  # views of a reflectance model have none
            references.check_material(settings.material or "", material["fingerprint"])
        truth = yield from model_or_cycles.by_cycles(environment, mesh, cameras, settings)
    easel = _Easel(views, settings)
    drawn = {way: [easel.draw(way, camera) for camera in cameras] for way in easel.ways}
    return model_or_cycles.beside(truth, drawn, settings.material or "", views.size, settings)


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
            *mesh, camera, self._size, ViewsLook(way.mode, WarpChoice(way.warping))
        )


def _material(map_set: Path, told: dict[str, Any], settings: ViewsComparison) -> str:
    """The material that was captured; a file is opened only if settings name it."""
    if settings.material is not None:
        return settings.material
    spec = str(told["spec"])
    if is_model(spec):
        told_brdf(spec, "--material")
    elif names_other_file(spec):
        raise InputFileError(
            f"{map_set} names the material {spec}, in a file that is opened only if you name it: "
            f"do so with --material."
        )
    return spec


def _is_look(way: ViewsWay, look: ViewsLook) -> bool:
    """Whether a way is a look's, or may be: which warp is the best is not told here."""
    fades_alike = look.fading is ViewsLook().fading
    return fades_alike and way.mode is look.mode and look.warping in (WarpChoice.AUTO, way.warping)


def _is_by_model(settings: ViewsComparison) -> bool:
    return is_model(settings.material or "")


def _telling(settings: ViewsComparison) -> Telling:
    if _is_by_model(settings):
        return exact.telling_with("sums over rings of points")
    return references.telling(settings)


TRUTH = Truth(
    way=ViewsWay,
    draw=draw,
    telling=_telling,
    is_look=_is_look,
)
