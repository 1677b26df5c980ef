"""Cycles' own sheen, measured: its tables lie in its program."""

import bpy
import numpy as np

from ..core.brdf.sheen import Sheen, transform_of
from ..core.conventions import Array
from .goniophotometer import measure
from .scenes import temporary_scene

APART = np.radians(50.0)
"""Angle between views and lights."""

LIGHTS = 16
"""Lights about a view; of a low view half of them are below the horizon."""

LEAST_HEIGHT = 0.02
"""Least n.l of the lights that count."""


def measured_sheen(roughness: float, mu: Array) -> Sheen:
    """Measure the Sheen BSDF of Cycles.

    Parameters
    ----------
    roughness : float
        In [0, 1].
    mu : ndarray, shape (S,)
        n.v, ascending, in (0.001, 1).

    Returns
    -------
    Sheen
        With an albedo of 0 where Cycles reflects nothing.

    Raises
    ------
    RenderError
        Cycles did not deliver.
    """
    view = np.stack([np.sqrt(1.0 - mu**2), np.zeros_like(mu), mu], axis=-1)[:, None]
    across = np.stack([-view[..., 2], np.zeros_like(view[..., 2]), view[..., 0]], axis=-1)
    azimuth = 2.0 * np.pi * (np.arange(LIGHTS) + 0.5)[:, None] / LIGHTS
    around = np.cos(azimuth) * across + np.sin(azimuth) * np.array([0.0, 1.0, 0.0])
    lights = np.cos(APART) * view + np.sin(APART) * around
    above = lights[..., 2] > LEAST_HEIGHT
    with temporary_scene() as scene:
        views = np.broadcast_to(view, lights.shape)
        diffuse, glossy = measure(scene, _material(roughness), lights[above], views[above])
    reflectance = np.zeros(above.shape)
    reflectance[above] = (diffuse + glossy)[:, 1]
    found = np.array(
        [
            transform_of(light[up], values[up]) if np.all(values[up] > 0.0) else (1.0, 0.0, 0.0)
            for light, values, up in zip(lights, reflectance, above, strict=True)
        ]
    )
    return Sheen(mu, *found.T)


def _material(roughness: float) -> bpy.types.Material:
    """A white Sheen BSDF."""
    material = bpy.data.materials.new("RSIBR sheen")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    sheen, output = nodes.new("ShaderNodeBsdfSheen"), nodes.new("ShaderNodeOutputMaterial")
    sheen.distribution = "MICROFIBER"
    sheen.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    sheen.inputs["Roughness"].default_value = roughness
    links.new(sheen.outputs["BSDF"], output.inputs["Surface"])
    return material
