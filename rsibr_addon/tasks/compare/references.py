"""References by Cycles, which renders a material in an environment."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.geometry.camera import Camera
from ...core.metrics import relative_rmse, relative_rmse_beyond_noise, unpremultiplied
from ...core.progress import Progress, Steps
from ...host.cameras import add_camera
from ...host.cycles import RenderedView, RenderSettings, render_view
from ...host.materials import fingerprint, load_material
from ...host.meshes import TriangleMesh, add_mesh
from ...host.scenes import temporary_scene
from ...host.spheres import add_sphere
from ...host.worlds import light_with
from .comparison import Comparison, Way, WayError, way_error
from .truth import Telling


@dataclass(frozen=True)
class Captured:
    """What is rendered.

    Attributes
    ----------
    material : str
        As `host.materials.load_material` takes it.
    environment : Environment
    mesh : TriangleMesh or None
        None for the unit sphere, without tessellation.
    """

    material: str
    environment: Environment
    mesh: TriangleMesh | None


@dataclass(frozen=True)
class Reference:
    """One view, rendered twice with different noise.

    Attributes
    ----------
    first, second : ndarray, shape (size, size, 4), float32
        Radiance times coverage, and coverage; row 0 at the bottom.
    """

    first: Array
    second: Array

    @property
    def rgba(self) -> Array:
        """The reference: the mean of both renders, shape (size, size, 4)."""
        mean: Array = 0.5 * (self.first + self.second)
        return mean

    @property
    def noise(self) -> Array:
        """Half the difference of both renders' radiance, shape (size, size, 3).

        It varies as the error of their mean does: Var((a - b) / 2) = Var((a + b) / 2).
        """
        half: Array = 0.5 * (unpremultiplied(self.first) - unpremultiplied(self.second))
        return half


def check_material(spec: str, expected_fingerprint: str) -> None:
    """Refuse a material that is not the one that was captured.

    Parameters
    ----------
    spec : str
    expected_fingerprint : str
        As a map set states it.

    Raises
    ------
    InputFileError
        The material has changed since.
    """
    with temporary_scene():
        found = fingerprint(load_material(spec))
    if found != expected_fingerprint:
        raise InputFileError(
            f"The material {spec} has changed since it was captured: capture it again, or restore it."
        )


def render_reference(captured: Captured, camera: Camera, size: int, samples: int, seed: int) -> Reference:
    """Render one view with Cycles, without denoising.

    Parameters
    ----------
    captured : Captured
    camera : Camera
    size : int
        Width and height in pixels.
    samples : int
        A pixel, at least 4; each render takes half of them, rounded down.
    seed : int
        Seed of the first render; the second's is `seed` + 1.

    Returns
    -------
    Reference
        A mesh that is not convex hides parts of the environment from itself, but does not light
        itself: light is reflected once, as in a capture.

    Raises
    ------
    RenderError, InputFileError, SceneError, RangeError
    """
    with temporary_scene() as scene:
        light_with(scene, captured.environment)
        material = load_material(captured.material)
        if captured.mesh is None:
            add_sphere(scene, material)
        else:
            add_mesh(scene, captured.mesh, material)
        add_camera(scene, camera)
        first, second = (
            render_view(scene, RenderSettings(size, samples // 2, seed=each)) for each in (seed, seed + 1)
        )
    return Reference(_rgba(first), _rgba(second))


def rendered(captured: Captured, cameras: Sequence[Camera], settings: Any) -> Steps[list[Reference]]:
    """Render all views: see `render_reference`.

    Parameters
    ----------
    captured : Captured
    cameras : sequence of Camera
    settings : ComparisonOptions
        With `samples`.
    """
    references = []
    for number, camera in enumerate(cameras):
        yield Progress(number + 1, len(cameras) + 2, f"rendering reference {number + 1} of {len(cameras)}")
        seed = settings.seed + 2 * number
        references.append(render_reference(captured, camera, settings.size, settings.samples, seed))
    return references


def error_beyond_noise(way: Way, pictures: Sequence[Array], references: Sequence[Reference]) -> WayError:
    """Error of a way to draw, without Cycles' noise: see `core.metrics.relative_rmse_beyond_noise`."""
    ours = np.stack(pictures)
    first = np.stack([reference.first for reference in references])
    second = np.stack([reference.second for reference in references])
    coverage = np.minimum(ours[..., 3], np.minimum(first[..., 3], second[..., 3]))
    compared = unpremultiplied(ours), unpremultiplied(first), unpremultiplied(second), coverage
    return way_error(way, relative_rmse_beyond_noise, *compared)


def noise_of(references: Sequence[Reference]) -> float:
    """See `Comparison.reference_noise`."""
    rgba = np.stack([reference.rgba for reference in references])
    radiance = unpremultiplied(rgba)
    noise = np.stack([reference.noise for reference in references])
    return relative_rmse(radiance + noise, radiance, rgba[..., 3])


def telling(settings: Any) -> Telling:
    """What is told of pictures by Cycles."""
    return Telling(
        name="Cycles" if settings.material is None else f"{settings.material} by Cycles",
        made="rendered by Cycles",
        quality=f"two renders of {settings.samples // 2} samples a pixel, not denoised",
        notes=_notes,
    )


def _notes(comparison: Comparison) -> str:
    noise = f"{100.0 * comparison.reference_noise:.2g}&thinsp;%"
    told = (
        f"Cycles&rsquo; own noise, which makes <b>{noise}</b> of the reference, is not counted: two renders "
        "tell it apart."
    )
    if comparison.settings.mesh == "sphere":
        return told
    return (
        f"{told} In Cycles&rsquo; pictures the mesh hides parts of its surroundings from itself; no map "
        "knows that."
    )


def _rgba(view: RenderedView) -> Array:
    return np.dstack([view.diffuse + view.glossy, view.coverage])
