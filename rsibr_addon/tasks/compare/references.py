"""References of radiance views: Cycles renders the captured material in its environment."""

from dataclasses import dataclass

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.geometry.camera import Camera
from ...core.metrics import unpremultiplied
from ...host.cameras import add_camera
from ...host.cycles import RenderedView, RenderSettings, render_view
from ...host.materials import fingerprint, load_material
from ...host.meshes import TriangleMesh, add_mesh
from ...host.scenes import temporary_scene
from ...host.spheres import add_sphere
from ...host.worlds import light_with


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
        """The reference: the mean of both renders."""
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


def _rgba(view: RenderedView) -> Array:
    return np.dstack([view.diffuse + view.glossy, view.coverage])
