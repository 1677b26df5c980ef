"""Radiance views of a material, rendered by Cycles into a map set."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import InputFileError, SceneError
from ...core.geometry.camera import Camera
from ...core.geometry.geodesic import geodesic_sphere
from ...core.maps.sphere_map import fill_rim
from ...core.options import to_plain
from ...core.progress import Progress, Steps, drain
from ...core.warned import warn
from ...files.atomic import written_aside
from ...files.exr import Part, read_attributes, read_parts, write_parts
from ...files.map_set_data import ENVIRONMENT, MapsInTurn
from ...files.map_set_header import Origin, Recipe, make_header
from ...files.memory import check_memory
from ...files.work_folder import kept_parts, work_folder_beside
from ...host.cameras import add_camera
from ...host.cycles import BYTES_BESIDES, RenderedView, RenderSettings, bytes_needed, render_view
from ...host.furnace import directional_albedo
from ...host.materials import fingerprint, lasting_spec, load_material, material_name
from ...host.scenes import temporary_scene
from ...host.shape_dependence import shape_dependence
from ...host.spheres import add_sphere
from ...host.version import software
from ...host.worlds import LIGHT_OF_TEXEL, light_with
from ...job import BakeJob
from ...settings.radiance_views import RadianceViewsSettings
from .method import (
    ENVIRONMENT_MEMORY,
    RGB,
    STORED,
    Baked,
    Cost,
    Method,
    Sources,
    cost_in_blender,
    read_light,
    written,
)

ALBEDO = "albedo"
"""Name and role of the part that holds the material's directional albedo."""

NOISE = "noise"
"""Attribute of a finished view: its relative standard error."""


def material(settings: RadianceViewsSettings) -> str:
    """See `Method`."""
    return settings.material.removeprefix(":")


def sources(settings: RadianceViewsSettings) -> Sources:
    """See `Method`."""
    return Sources(material=settings.material)


def cost(settings: RadianceViewsSettings) -> Cost:
    """See `Method`; measured on a sphere in Blender's `forest`."""
    texels = settings.views * settings.size**2
    rendering = settings.views * (0.5 + 1.5 * settings.denoise) + 2.5e-6 * texels * settings.samples
    maps = 2 * texels * RGB
    albedo = 4.0
    return cost_in_blender(albedo + rendering, 2 * maps + 8 * ENVIRONMENT_MEMORY, STORED * maps)


def bake(job: BakeJob[RadianceViewsSettings], recipe: Recipe) -> Steps[Baked]:
    """Render the views of a material. Between two steps, the open file holds nothing that this adds.

    Raises
    ------
    RangeError, InputFileError, SceneError, OutputFileError
        The job cannot be done, or takes more memory than there is; found before the first view is rendered.
    RenderError, SceneError, OutputFileError
        Cycles did not deliver; the material was changed meanwhile; the disk is full.

    Warns
    -----
    RsibrWarning
        The material depends on more than normal and view; the environment was clamped; views of
        another job were removed.

    Notes
    -----
    Each finished view is kept in OUTPUT.partial until the map set is whole. A job that was
    interrupted, even killed, goes on with them, and the result is the same, bit by bit. Never more than
    one view is in memory.
    """
    asked = job.settings
    settings = [
        RenderSettings(asked.size, asked.samples, asked.denoise, asked.seed + view)
        for view in range(asked.views)
    ]
    # Its own steps would be of another total than the views
    yield Progress(0, asked.views, "reading the environment")
    captured = _Captured(asked, drain(read_light(job)))
    captured.check_memory(job.output)
    folder = work_folder_beside(Path(job.output))
    with kept_parts(folder, {**recipe}):
        paths = [folder / f"view{view:03d}.exr" for view in range(asked.views)]
        for view, path in enumerate(paths):
            yield Progress(view, asked.views, f"rendering view {view + 1} of {asked.views}")
            if not _is_finished(path):
                _write_view(path, captured.render(view, settings[view]))
        path = drain(written(job, recipe, _map_set(captured, paths)))
    figures = {"views": asked.views, "size": asked.size}
    return Baked(path, f"{asked.views} views of {asked.size}x{asked.size}", figures)


class _Captured:
    """A material in an environment, from the vertices of a geodesic sphere."""

    def __init__(self, settings: RadianceViewsSettings, light: Environment) -> None:
        self.settings, self.environment = settings, light
        with temporary_scene():
            material = load_material(settings.material)
            self.fingerprint = fingerprint(material)
            reasons = shape_dependence(material)
        if reasons:
            warn(
                f"No radiance map can hold {settings.material}, so it is captured as it looks on a sphere: "
                f"{'; '.join(reasons)}."
            )
        self.view_dirs = geodesic_sphere(settings.views).vertices

    def check_memory(self, output: str) -> None:
        height, width = self.environment.radiance.shape[:2]
        light, size = LIGHT_OF_TEXEL * height * width, self.settings.size
        check_memory(light, self.environment.name, (width, height), BYTES_BESIDES)
        view = bytes_needed(size**2, self.settings.denoise)
        check_memory(view, output, (size, size), BYTES_BESIDES + light)

    def render(self, view: int, settings: RenderSettings) -> RenderedView:
        with temporary_scene() as scene:
            material = self._material()
            light_with(scene, self.environment)
            add_sphere(scene, material)
            add_camera(scene, Camera(tuple(self.view_dirs[view])))
            return render_view(scene, settings)

    def albedo(self) -> Array:
        with temporary_scene() as scene:
            return directional_albedo(scene, self._material(), self.settings.seed)

    def _material(self) -> Any:
        """The material in Blender, if it has not changed."""
        material = load_material(self.settings.material)
        if fingerprint(material) != self.fingerprint:
            raise SceneError(
                f"Material {self.settings.material} was changed while it was captured: capture it again."
            )
        return material


def _write_view(path: Path, view: RenderedView) -> None:
    maps = {"diffuse": view.diffuse, "glossy": view.glossy}
    parts = []
    for name, radiance in maps.items():
        filled = fill_rim(radiance, view.coverage)
        channels = {channel: filled[..., i] for i, channel in enumerate("RGB")}
        parts.append(Part(name, channels, {NOISE: repr(view.noise)}))
    with written_aside(path, force=True) as aside:
        write_parts(aside, parts)


def _is_finished(path: Path) -> bool:
    try:
        return len(read_parts(path)) == 2
    except InputFileError:
        return False


def _map_set(captured: _Captured, paths: list[Path]) -> MapsInTurn:
    environment, albedo = captured.environment.radiance, captured.albedo()
    shapes = {ENVIRONMENT: environment.shape[:2], ALBEDO: albedo.shape[:2]}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in shapes]
    variance = 0.0
    for view, path in enumerate(paths):
        view_dir = captured.view_dirs[view].tolist()
        for attributes in read_attributes(path):
            role = attributes["name"]
            name = f"view{view:03d}.{role}"
            shapes[name] = (captured.settings.size,) * 2
            parts.append({"name": name, "role": role, "view": view, "view_dir": view_dir})
        variance += float(attributes[NOISE]) ** 2 / len(paths)

    def maps() -> Iterator[Array]:
        yield from (environment, albedo)
        for path in paths:
            for part in read_parts(path):
                yield np.stack([part.channels[channel] for channel in "RGB"], axis=-1)

    return MapsInTurn("radiance_views", shapes, maps(), _header(captured, parts, variance**0.5))


def _header(captured: _Captured, parts: list[dict[str, Any]], noise: float) -> dict[str, Any]:
    settings = captured.settings
    origin = Origin(
        captured.environment,
        {name: value for name, value in to_plain(settings).items() if name != "material"},
        software(),
        {
            "spec": lasting_spec(settings.material),
            "name": material_name(settings.material),
            "fingerprint": captured.fingerprint,
        },
        {"relative_noise": noise},
    )
    return make_header("sphere_map", (settings.size, settings.size), parts, origin)


METHOD = Method(bake, cost, material, sources)
