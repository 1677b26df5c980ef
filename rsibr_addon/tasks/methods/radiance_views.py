"""Radiance views of a material, rendered by Cycles into a map set."""

import dataclasses
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, MapSetError, RsibrWarning, SceneError
from ...core.geometry.camera import Camera
from ...core.geometry.geodesic import geodesic_sphere
from ...core.maps.sphere_map import fill_rim
from ...core.progress import Progress, Steps
from ...files.atomic import check_target, written_aside
from ...files.exr import Part, read_attributes, read_parts, write_parts
from ...files.map_set import read_map_set_header, write_map_set
from ...files.map_set_data import ENVIRONMENT, MapsInTurn
from ...files.map_set_header import make_header
from ...files.memory import check_memory
from ...files.work_folder import clear_work_folder, work_folder, work_folder_beside
from ...host.cameras import add_camera
from ...host.cycles import BYTES_BESIDES, RenderedView, RenderSettings, bytes_needed, render_view
from ...host.furnace import directional_albedo
from ...host.materials import fingerprint, lasting_spec, load_material, material_name
from ...host.scenes import temporary_scene
from ...host.shape_dependence import shape_dependence
from ...host.spheres import add_sphere
from ...host.version import software
from ...host.worlds import LIGHT_OF_TEXEL, light_with
from ...job import CaptureJob
from ..light.environments import load_environment

ALBEDO = "albedo"
"""Name and role of the part that holds the material's directional albedo."""

NOISE = "noise"
"""Attribute of a finished view: its relative standard error."""


def capture(job: CaptureJob) -> Steps[Path]:
    """Render the views of a material into a map set.

    Parameters
    ----------
    job : CaptureJob

    Yields
    ------
    Progress
        Before each view. Between two steps nothing of ours is in the open file.

    Returns
    -------
    Path
        The map set.

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
    settings = [
        RenderSettings(job.size, job.samples, job.denoise, job.seed + view) for view in range(job.views)
    ]
    output = Path(job.output)
    # A capture that was killed at its very end has named its output, and its views are still there
    named = not job.force and output.is_file() and work_folder_beside(output).is_dir()
    check_target(output, job.force or named)
    yield Progress(0, job.views, "reading the environment")
    subject = _Subject(job)
    if named and subject.is_in(output):
        clear_work_folder(work_folder_beside(output))
        return output
    check_target(output, job.force)
    subject.check_memory(output)
    with work_folder(work_folder_beside(output), subject.identity) as folder:
        paths = [folder / f"view{view:03d}.exr" for view in range(job.views)]
        for view, path in enumerate(paths):
            yield Progress(view, job.views, f"rendering view {view + 1} of {job.views}")
            if not _is_finished(path):
                _write_view(path, subject.render(view, settings[view]))
        write_map_set(output, _map_set(subject, paths), job.force)
    return output


class _Subject:
    """What is captured: a material in an environment, from the vertices of a geodesic sphere."""

    def __init__(self, job: CaptureJob) -> None:
        self.job = job
        self.environment = load_environment(job.environment, job.clamp)
        with temporary_scene():
            material = load_material(job.material)
            self.fingerprint = fingerprint(material)
            reasons = shape_dependence(material)
        if reasons:
            warnings.warn(
                f"No radiance map can hold {job.material}, so it is captured as it looks on a sphere: "
                f"{'; '.join(reasons)}.",
                RsibrWarning,
                stacklevel=3,
            )
        self.view_dirs = geodesic_sphere(job.views).vertices

    @property
    def identity(self) -> dict[str, Any]:
        """All that views depend on, as JSON values."""
        job = dataclasses.asdict(self.job)
        del job["output"], job["force"]
        return {
            "job": job,
            "environment": self.environment.sha256,
            "material": self.fingerprint,
            "software": software(),
        }

    def check_memory(self, output: Path) -> None:
        height, width = self.environment.radiance.shape[:2]
        light, size = LIGHT_OF_TEXEL * height * width, self.job.size
        check_memory(light, self.environment.name, (width, height), BYTES_BESIDES)
        view = bytes_needed(size**2, self.job.denoise)
        check_memory(view, str(output), (size, size), BYTES_BESIDES + light)

    def is_in(self, path: Path) -> bool:
        """Whether a map set is a capture of this, with the same settings."""
        try:
            found = read_map_set_header(path)
        except MapSetError:
            return False
        wanted = json.loads(json.dumps(_header(self, [], 0.0)))
        fields = ("layout", "environment", "material", "settings", "software")
        return all(found.get(field) == wanted[field] for field in fields)

    def render(self, view: int, settings: RenderSettings) -> RenderedView:
        with temporary_scene() as scene:
            material = self._material()
            light_with(scene, self.environment)
            add_sphere(scene, material)
            add_camera(scene, Camera(tuple(self.view_dirs[view])))
            return render_view(scene, settings)

    def albedo(self) -> Array:
        with temporary_scene() as scene:
            return directional_albedo(scene, self._material(), self.job.seed)

    def _material(self) -> Any:
        """The material as Blender has it, if it is still what it was."""
        material = load_material(self.job.material)
        if fingerprint(material) != self.fingerprint:
            raise SceneError(
                f"Material {self.job.material} was changed while it was captured: capture it again."
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


def _map_set(subject: _Subject, paths: list[Path]) -> MapsInTurn:
    environment, albedo = subject.environment.radiance, subject.albedo()
    shapes = {ENVIRONMENT: environment.shape[:2], ALBEDO: albedo.shape[:2]}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in shapes]
    variance = 0.0
    for view, path in enumerate(paths):
        view_dir = subject.view_dirs[view].tolist()
        for attributes in read_attributes(path):
            role = attributes["name"]
            name = f"view{view:03d}.{role}"
            shapes[name] = (subject.job.size,) * 2
            parts.append({"name": name, "role": role, "view": view, "view_dir": view_dir})
        variance += float(attributes[NOISE]) ** 2 / len(paths)

    def maps() -> Iterator[Array]:
        yield from (environment, albedo)
        for path in paths:
            for part in read_parts(path):
                yield np.stack([part.channels[channel] for channel in "RGB"], axis=-1)

    return MapsInTurn("radiance_views", shapes, maps(), _header(subject, parts, variance**0.5))


def _header(subject: _Subject, parts: list[dict[str, Any]], noise: float) -> dict[str, Any]:
    job = subject.job
    return make_header(
        layout="sphere_map",
        size=(job.size, job.size),
        environment=subject.environment,
        embedded=True,
        material={
            "spec": lasting_spec(job.material),
            "name": material_name(job.material),
            "fingerprint": subject.fingerprint,
        },
        parts=parts,
        error_bound={"relative_noise": noise},
        settings={
            "views": job.views,
            "size": job.size,
            "samples": job.samples,
            "denoise": job.denoise,
            "seed": job.seed,
        },
        software=software(),
    )
