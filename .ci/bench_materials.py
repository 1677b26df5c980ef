"""Measure Principled materials from a pyramid of kernels, beside the split sum of the same.

Materials that are the same all over are compared with the sum over all texels. Against Cycles there is a
picture of a sphere in tiles, each flat, with the sphere's normal at its middle and inputs of its own: what a
textured sphere shows, without what the filters of textures and pixels add. All errors are relative
root-mean-square errors over the picture.
"""

import argparse
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.brdf.principled import Principled, Surface, layers_of
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.filtering.prefilter import analysis_degree, prefilter
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe
from rsibr.rsibr_addon.core.filtering.zonal import ZonalSeries, expand
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.lit_sphere import environment_about, ring_radiance
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import Families, principled_radiance
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderSettings, render_view
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.surfaces import INPUTS
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings
from rsibr.rsibr_addon.tasks.light.environments import load_environment

TILES, PIXELS, EDGE = 32, 5, 1
"""Along a side of the picture; pixels along a tile; and those at its edges that Cycles' filter mixes."""

LEAST_COSINE, LEAST_ALPHA = 0.05, 0.008
RINGS, EVERY = 24, 16
"""Rings of points of a sphere, and columns of the environment from one of its points to the next."""

STEPS = 12
"""Roughnesses of a textured sphere, so that the split sum has as many maps."""
RED, GOLD = (0.5, 0.05, 0.03), (1.0, 0.75, 0.3)
MATERIALS: dict[str, dict[str, Any]] = {
    "metal, roughness .09": {"base_color": GOLD, "metallic": 1.0, "roughness": 0.09},
    "metal, roughness .2": {"base_color": GOLD, "metallic": 1.0, "roughness": 0.2},
    "metal, roughness .3": {"base_color": GOLD, "metallic": 1.0, "roughness": 0.3},
    "metal, roughness .55": {"base_color": GOLD, "metallic": 1.0, "roughness": 0.55},
    "metal, roughness 1": {"base_color": GOLD, "metallic": 1.0, "roughness": 1.0},
    "plastic, roughness .3": {"base_color": RED, "roughness": 0.3},
    "plastic, roughness .6": {"base_color": RED, "roughness": 0.6},
    "coated plastic": {"base_color": RED, "roughness": 0.5, "coat_weight": 1.0, "coat_roughness": 0.15},
    "tinted coat on metal": {
        "base_color": GOLD,
        "metallic": 1.0,
        "roughness": 0.5,
        "coat_weight": 0.8,
        "coat_roughness": 0.3,
        "coat_tint": (0.6, 0.8, 1.0),
    },
    "clay": {"base_color": (0.55, 0.4, 0.3), "specular_level": 0.0, "diffuse_roughness": 1.0},
}

CLOTH = {"base_color": RED, "roughness": 0.8, "sheen_weight": 1.0, "sheen_tint": (1.0, 0.8, 0.7)}
SHEENS = (0.25, 0.5, 0.8)
"""Roughnesses of its sheen, which engines' split sum does not have."""


def tiles() -> tuple[Array, Array, Array]:
    """Column and row of each tile, shapes (N,), and the sphere's normal there in the camera's axes (N, 3)."""
    middle = -1.0 + 2.0 * (np.arange(TILES) + 0.5) / TILES
    x, y = (grid.ravel() for grid in np.meshgrid(middle, middle))
    inside = x**2 + y**2 < 1.0 - LEAST_COSINE**2
    x, y = x[inside], y[inside]
    column, row = (np.rint((each + 1.0) * TILES / 2.0 - 0.5).astype(int) for each in (x, y))
    return column, row, np.stack([x, y, np.sqrt(1.0 - x**2 - y**2)], axis=-1)


def textured(normal: Array) -> tuple[Surface, Array]:
    """A material of another colour, roughness and metallic at each tile, and normals off the sphere's."""
    rng = np.random.default_rng(15)
    checker = (np.floor(4.0 * normal[:, 0]) + np.floor(4.0 * normal[:, 1])) % 2.0
    roughness = np.rint(STEPS * (0.25 + 0.6 * rng.random(len(normal)))) / STEPS
    bumped = normalize(normal + 0.15 * rng.normal(size=normal.shape))
    bumped = np.where((bumped[:, 2] > LEAST_COSINE)[:, None], bumped, normal)
    return Surface(base_color=rng.random(normal.shape), metallic=checker, roughness=roughness), bumped


def uniform(inputs: dict[str, Any], count: int) -> Surface:
    """A material, the same at each of some points."""
    return Surface(
        **{
            name: np.broadcast_to(np.asarray(value, np.float64), (count, *np.shape(value)))
            for name, value in inputs.items()
        }
    )


def summed(material: Principled, radiance: Array) -> tuple[Array, Array]:
    """Normals of a sphere's points in the camera's axes, and the sum over all texels of light times BRDF."""
    frame = Camera((0.0, 0.0, 1.0)).frame
    cosine = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    width = radiance.shape[1]
    column = np.arange(0, width, EVERY)
    azimuth = np.pi * (1.0 - 2.0 * (column + 0.5) / width)[None, :]
    radius = np.sqrt(1.0 - cosine**2)[:, None]
    across = np.broadcast_arrays(radius * np.cos(azimuth), radius * np.sin(azimuth), cosine[:, None])
    exact = ring_radiance(material, environment_about(radiance, frame), cosine)[:, column]
    return np.stack(across, axis=-1).reshape(-1, 3), exact.reshape(-1, 3)


def by_cycles(environment: Environment, surface: Surface, bumped: Array, samples: int) -> list[Array]:
    """Radiance of each tile, twice, of as many samples each."""
    column, row, normal = tiles()
    camera = Camera((0.0, 0.0, 1.0))
    names = [name for name in INPUTS if hasattr(surface, name)]
    inputs = {INPUTS[name]: np.asarray(getattr(surface, name)) for name in names}
    varied = {name: each for name, each in inputs.items() if len(each.shape) and len(each) == len(normal)}
    varied["Normal"] = bumped @ camera.frame.T
    seen = []
    for seed in (1, 2):
        with temporary_scene() as scene:
            light_with(scene, environment)
            add_camera(scene, camera)
            _add_tiles(scene, normal, camera.frame, varied)
            view = render_view(scene, RenderSettings(TILES * PIXELS, samples, seed=seed))
        parts = (view.diffuse + view.glossy).reshape(TILES, PIXELS, TILES, PIXELS, 3)
        inner = slice(EDGE, PIXELS - EDGE)
        seen.append(parts[:, inner, :, inner].mean(axis=(1, 3), dtype=np.float64)[row, column])
    return seen


def _add_tiles(scene: bpy.types.Scene, normal: Array, frame: Array, varied: dict[str, Array]) -> None:
    """A tile for each normal, seen by the camera alone, of a Principled BSDF with inputs of its own."""
    corners = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) / TILES
    drop = -(normal[:, None, :2] * corners).sum(axis=-1) / normal[:, 2:]
    across = normal[:, None, :2] + corners
    vertices = np.concatenate([across, drop[..., None]], axis=-1).reshape(-1, 3) @ frame.T
    mesh = bpy.data.meshes.new("tiles")
    mesh.from_pydata(vertices.tolist(), [], np.arange(len(vertices)).reshape(-1, 4).tolist())
    material = bpy.data.materials.new("tiles")
    nodes = material.node_tree.nodes
    (principled,) = (each for each in nodes if each.bl_idname == "ShaderNodeBsdfPrincipled")
    for name, values in varied.items():
        kind, output = ("FLOAT", "Fac") if values.ndim == 1 else ("FLOAT_VECTOR", "Vector")
        stored = mesh.attributes.new(f"tile {name}", kind, "FACE")
        field = "value" if values.ndim == 1 else "vector"
        stored.data.foreach_set(field, np.ascontiguousarray(values, np.float32).ravel())
        node = nodes.new("ShaderNodeAttribute")
        node.attribute_name = f"tile {name}"
        material.node_tree.links.new(node.outputs[output], principled.inputs[name])
    mesh.materials.append(material)
    shown = bpy.data.objects.new("tiles", mesh)
    shown.visible_diffuse = shown.visible_glossy = shown.visible_transmission = shown.visible_shadow = False
    scene.collection.objects.link(shown)


class SplitSum:
    """Light filtered with GGX at normal = view = mirror direction, times the exact albedo of each layer."""

    def __init__(self, radiance: Array, families: Families) -> None:
        self._radiance, self._families = radiance, families
        self._harmonics = analyse_environment(radiance, analysis_degree([_ggx(LEAST_ALPHA)]))

    def shaded(self, surface: Surface, normal: Array, view_dir: Array) -> Array:
        """Radiance of points, shape (N, 3)."""
        mu, mirror_dir = dot(normal, view_dir), reflect(view_dir, normal)
        layers = layers_of(surface, mu, self._families)
        # Engines have Lambert's reflection alone
        shown = layers.diffuse * surface.base_color * irradiance_exact(self._radiance, normal) / np.pi
        for roughness, coefficients in (
            (surface.roughness, layers.base),
            (surface.coat_roughness, layers.coat),
        ):
            each = np.broadcast_to(roughness, mu.shape)
            for value in np.unique(each[np.any(coefficients, axis=(1, 2))]):
                chosen = each == value
                albedo = self._families.powers(np.full(chosen.sum(), value**2), mu[chosen])
                factor = np.einsum("nc,nci->ni", albedo, coefficients[chosen])
                light = prefilter(self._harmonics, [_ggx(value**2)], mirror_dir[chosen]).radiance[0]
                shown[chosen] += factor * light
        return shown


def _ggx(alpha: float) -> ZonalSeries:
    return expand(ggx_n_dot_l_lobe(alpha), 1e-4)


def error(shown: Array, truth: list[Array]) -> float:
    """Relative root-mean-square error; in the product of differences the noise of two renders cancels."""
    first, second = truth
    square = np.sum((shown - first) * (shown - second)) / np.sum(first * second)
    return float(np.sqrt(max(square, 0.0)))


class Place:
    """An environment, and all that shades in it."""

    def __init__(self, environment: Environment, families: Families) -> None:
        self._environment, self._families = environment, families
        self._name = Path(environment.name).stem
        self._pyramid = drain(bake_pyramid(environment.radiance, KernelPyramidSettings().size)).pyramid
        self._split = SplitSum(environment.radiance, families)

    def rows(self, samples: int) -> Iterator[str]:
        """Lines of the table."""
        for name, inputs in MATERIALS.items():
            normal, exact = summed(Principled(**inputs), self._environment.radiance)
            yield self._row(name, "all texels", uniform(inputs, len(normal)), normal, [exact, exact])
        *_, normal = tiles()
        coated = uniform(MATERIALS["coated plastic"], len(normal)), normal
        for name, (surface, bumped) in {"textured": textured(normal), "coated plastic": coated}.items():
            truth = by_cycles(self._environment, surface, bumped, samples)
            yield self._row(name, "Cycles", surface, bumped, truth)
        for roughness in SHEENS:
            surface = uniform({**CLOTH, "sheen_roughness": roughness}, len(normal))
            truth = by_cycles(self._environment, surface, normal, samples)
            name = f"cloth, sheen of roughness {roughness:g}"
            yield f"| {name} | {self._name} | Cycles | {self._own(surface, normal, truth)[1]} | |"

    def _own(self, surface: Surface, normal: Array, truth: list[Array]) -> tuple[float, str]:
        """Our error, and its words."""
        shown = principled_radiance(self._pyramid, self._families, surface, *_seen(normal))
        ours = error(shown, truth)
        return ours, _in_words(ours)

    def _row(self, name: str, against: str, surface: Surface, normal: Array, truth: list[Array]) -> str:
        ours, own = self._own(surface, normal, truth)
        theirs = error(self._split.shaded(surface, *_seen(normal)), truth)
        ratio = f" ({theirs / ours:.1f}x)" if ours > 0.0 else ""
        return f"| {name} | {self._name} | {against} | {own} | {_in_words(theirs)}{ratio} |"


def _seen(normal: Array) -> tuple[Array, Array]:
    """Normals of the camera's axes in the world's, and the views of them."""
    frame = Camera((0.0, 0.0, 1.0)).frame
    return normal @ frame.T, np.broadcast_to(frame[:, 2], normal.shape)


def _in_words(error: float) -> str:
    return f"{error:.1%}" if error > 0.0 else "below the noise"


def main() -> None:
    """Print the table, and write it into docs/materials.md."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--environments", nargs="*", default=["forest", "city"])
    parser.add_argument("--samples", type=int, default=512)
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", RsibrWarning)
    families = shipped_families()
    lines = ["| material | environment | against | ours | split sum |", "|---|---|---|---:|---:|"]
    for environment in map(load_environment, chosen.environments):
        for line in Place(environment, families).rows(chosen.samples):
            lines.append(line)
            print(line, flush=True)
    write_table("materials.md", "spheres", "\n".join(lines))


if __name__ == "__main__":
    main()
