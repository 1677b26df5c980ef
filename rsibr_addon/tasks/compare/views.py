"""Hold pictures drawn from a map set against Cycles' own, as numbers and as pages for people."""

import json
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, MapSetError
from ...core.geometry.camera import Camera
from ...core.kinds.radiance_views.shading import ViewsLook
from ...core.metrics import relative_rmse, relative_rmse_beyond_noise, unpremultiplied
from ...core.progress import Progress, Steps
from ...device.context import ensure_context
from ...device.kinds.radiance_views import RadianceViewsOnDevice
from ...device.preview import PreviewRenderer
from ...files.folders import check_folder_target, folder_written_aside
from ...files.map_set import read_map_set_header
from ...files.map_set_header import content_hash
from ...host.materials import names_other_file
from ...host.meshes import load_mesh
from ..methods.kinds import OpenedMapSet, open_map_set
from .comparison import RESULT, Comparison, ComparisonSettings, StackWay, Way, WayError
from .page import comparison_page
from .pictures import save_sheets
from .references import Reference, Subject, check_material, render_reference


def compare(
    map_set: Path,
    settings: ComparisonSettings,
    output: Path,
    force: bool = False,
    material: str | None = None,
) -> Steps[Comparison[Way]]:
    """Render random views with Cycles, draw the same views from a map set, and tell the difference.

    Parameters
    ----------
    map_set : Path
        Radiance views, with the environment that they were captured in.
    settings : ComparisonSettings
    output : Path
        A folder to be made: comparison.json (`Comparison.to_json`), index.html, which shows all of
        it by itself, and its pictures as images/*.png.
    force : bool
        Whether an earlier comparison in `output` is replaced.
    material : str, optional
        The material that was captured, as `host.materials.load_material` takes it; by default the one that
        the map set names, which must not be in another file.

    Yields
    ------
    Progress

    Returns
    -------
    Comparison

    Raises
    ------
    MapSetError
        The map set does not hold its environment.
    InputFileError
        The material is gone, is not what it was, or is in another file; or the mesh cannot be used.
    OutputFileError, RangeError, RenderError, DeviceError

    Notes
    -----
    Errors are those of radiance where both pictures cover a pixel, weighted by the lesser coverage,
    so that how each samples a silhouette does not count. Cycles' noise is not counted either: see
    `core.metrics.relative_rmse_beyond_noise`.
    """
    check_folder_target(output, RESULT, force)
    total = settings.views + 2
    yield Progress(0, total, f"reading {map_set.name}")
    captured = open_map_set(map_set, "radiance_views")
    subject = _subject(map_set, captured, settings, material)
    easel = _Easel(captured, settings)
    cameras = settings.cameras
    references: list[Reference] = []
    drawn: dict[Way, list[Array]] = {way: [] for way in easel.ways}
    for number, camera in enumerate(cameras):
        yield Progress(number + 1, total, f"rendering reference {number + 1} of {settings.views}")
        seed = settings.seed + 2 * number
        references.append(render_reference(subject, camera, settings.size, settings.samples, seed))
        for way, pictures in drawn.items():
            pictures.append(easel.draw(way, camera))
    yield Progress(total - 1, total, f"writing {output.name}")
    comparison = Comparison(
        map_set=map_set.name,
        content=content_hash(read_map_set_header(map_set)),
        environment=subject.environment.name,
        material=subject.material,
        map_size=captured.subject.size,
        settings=settings,
        view_dirs=tuple(camera.view_dir for camera in cameras),
        reference_noise=_noise(references),
        errors=tuple(_error(way, pictures, references) for way, pictures in drawn.items()),
    )
    save_comparison(output, comparison, [reference.rgba for reference in references], drawn, force)
    return comparison


class _Easel:
    """A map set and a mesh, uploaded, to be drawn in every way asked for."""

    def __init__(self, captured: OpenedMapSet, settings: ComparisonSettings) -> None:
        self._mesh = load_mesh(settings.mesh)
        self._size = settings.size
        whole = len(captured.subject.diffuse)
        counts = settings.captured_views or (whole,)
        ensure_context()
        self._renderers = {
            count: PreviewRenderer(RadianceViewsOnDevice(captured.subject.coarser(count))) for count in counts
        }
        self.ways = [
            Way(count, mode, warping)
            for count in counts
            for mode in settings.modes
            for warping in settings.warpings
        ]

    def draw(self, way: Way, camera: Camera) -> Array:
        """A picture of radiance times coverage, and coverage, shape (size, size, 4)."""
        mesh = self._mesh.positions, self._mesh.normals, self._mesh.triangles
        return self._renderers[way.captured_views].draw(
            *mesh, camera, self._size, ViewsLook(way.mode, way.warping)
        )


def save_comparison(
    output: Path,
    comparison: Comparison,
    references: list[Array],
    drawn: dict[Way, list[Array]] | dict[StackWay, list[Array]],
    force: bool,
) -> None:
    """Write a comparison's folder.

    Parameters
    ----------
    output : Path
    comparison : Comparison
    references : list of ndarray, each of shape (size, size, 4)
        Radiance times coverage, and coverage; row 0 at the bottom.
    drawn : dict of Way or StackWay to list of ndarray
        The same views, drawn.
    force : bool
        Whether an earlier comparison is replaced.

    Raises
    ------
    OutputFileError
    """
    with folder_written_aside(output, RESULT, force) as folder:
        sheets = save_sheets(folder / "images", references, drawn)
        page = comparison_page(comparison, sheets)
        (folder / "index.html").write_text(page, encoding="utf-8", errors="replace")
        (folder / RESULT).write_text(json.dumps(comparison.to_json(), indent=1), encoding="utf-8")


def _subject(
    map_set: Path, captured: OpenedMapSet, settings: ComparisonSettings, named: str | None
) -> Subject:
    if captured.environment is None:
        raise MapSetError(
            f"{map_set} does not hold the environment to render a reference in: capture it again."
        )
    material = named or captured.material["spec"]
    if named is None and names_other_file(material):
        raise InputFileError(
            f"{map_set} says that its material is {material}, in a file that is opened only if you name it: "
            f"do so with --material."
        )
    check_material(material, captured.material["fingerprint"])
    mesh = None if settings.mesh == "sphere" else load_mesh(settings.mesh)
    return Subject(material, captured.environment, mesh)


def _error(way: Way, pictures: list[Array], references: list[Reference]) -> WayError[Way]:
    ours = np.stack(pictures)
    first = np.stack([reference.first for reference in references])
    second = np.stack([reference.second for reference in references])
    coverage = np.minimum(ours[..., 3], np.minimum(first[..., 3], second[..., 3]))
    compared = unpremultiplied(ours), unpremultiplied(first), unpremultiplied(second), coverage
    per_view = tuple(relative_rmse_beyond_noise(*each) for each in zip(*compared, strict=True))
    return WayError(way, per_view, pooled=relative_rmse_beyond_noise(*compared))


def _noise(references: list[Reference]) -> float:
    rgba = np.stack([reference.rgba for reference in references])
    radiance = unpremultiplied(rgba)
    noise = np.stack([reference.noise for reference in references])
    return relative_rmse(radiance + noise, radiance, rgba[..., 3])
