"""Radiance views of a material that Cycles renders."""

from collections.abc import Sequence
from typing import Any

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import SceneError
from ...core.geometry.camera import Camera
from ...core.maps.sphere_map import fill_rim
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...files.memory import check_memory
from ...host.cameras import add_camera
from ...host.cycles import BYTES_BESIDES, RenderedView, RenderSettings, bytes_needed, render_view
from ...host.furnace import directional_albedo
from ...host.materials import fingerprint, lasting_spec, load_material, material_name
from ...host.scenes import temporary_scene
from ...host.shape_dependence import shape_dependence
from ...host.spheres import add_sphere
from ...host.worlds import LIGHT_OF_TEXEL, light_with
from ...settings.radiance_views import RadianceViewsSettings
from .views_by_model import KeepView


class ViewsByCycles:
    """A material in an environment; for the rest, see `ViewsByModel`.

    Raises
    ------
    InputFileError, SceneError
        See `host.materials.load_material`.

    Warns
    -----
    RsibrWarning
        The material depends on more than normal and view.
    """

    def __init__(self, settings: RadianceViewsSettings, light: Environment, most: int) -> None:
        self._settings, self._environment = settings, light
        # All of them at once: a seed that is out of range is found before the first view is rendered
        self._renders = [
            RenderSettings(settings.size, settings.samples, settings.denoise, settings.seed + view)
            for view in range(most)
        ]
        with temporary_scene():
            material = load_material(settings.material)
            self._fingerprint = fingerprint(material)
            reasons = shape_dependence(material)
        if reasons:
            warn(
                f"No radiance map can hold {settings.material}, so it is captured as it looks on a sphere: "
                f"{'; '.join(reasons)}."
            )
        self.material = {
            "spec": lasting_spec(settings.material),
            "name": material_name(settings.material),
            "fingerprint": self._fingerprint,
        }

    def check_memory(self, output: str) -> None:
        """Refuse what does not fit into this machine's memory: see `files.memory.check_memory`."""
        height, width = self._environment.radiance.shape[:2]
        light, size = LIGHT_OF_TEXEL * height * width, self._settings.size
        check_memory(light, self._environment.name, (width, height), BYTES_BESIDES)
        view = bytes_needed(size**2, self._settings.denoise)
        check_memory(view, output, (size, size), BYTES_BESIDES + light)

    def capture(self, keep: KeepView, view_dirs: Array, numbers: Sequence[int]) -> Steps[None]:
        """Render some of the views.

        Raises
        ------
        RenderError, SceneError
            Cycles did not deliver; the material was changed meanwhile.
        """
        for view in numbers:
            count = len(self._renders)
            yield Progress(view, count, f"rendering view {view + 1} of {count}")
            seen = self._render(view_dirs[view], self._renders[view])
            diffuse, glossy = (fill_rim(part, seen.coverage) for part in (seen.diffuse, seen.glossy))
            keep(view, diffuse, glossy, seen.noise)

    def albedo(self) -> Array:
        """See `RadianceViews.albedo`."""
        with temporary_scene() as scene:
            return directional_albedo(scene, self._material(), self._settings.seed)

    def _render(self, view_dir: Array, how: RenderSettings) -> RenderedView:
        with temporary_scene() as scene:
            material = self._material()
            light_with(scene, self._environment)
            add_sphere(scene, material)
            add_camera(scene, Camera(tuple(view_dir)))
            return render_view(scene, how)

    def _material(self) -> Any:
        """The material in Blender, if it has not changed."""
        material = load_material(self._settings.material)
        if fingerprint(material) != self._fingerprint:
            raise SceneError(
                f"Material {self._settings.material} was changed while it was captured: capture it again."
            )
        return material
