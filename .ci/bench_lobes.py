"""Measure spheres shaded from lobes against the BRDF itself, beside the split sum and radiance views.

Every radiance is that of surface points on rings of equal area, as seen from afar from four sides. The
reference is the sum over all texels of the environment. All errors are relative root-mean-square errors.
"""

import argparse
import time
import warnings
from dataclasses import dataclass

import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.prefilter import analysis_degree, prefilter
from rsibr.rsibr_addon.core.filtering.zonal import expand
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, reflect
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.geometry.lit_sphere import environment_about, lit_spheres, ring_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, LobeStack
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import views_fragment
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.lobes.bake import bake_stack
from rsibr.rsibr_addon.core.lobes.fit import Fit, lobe_axes
from rsibr.rsibr_addon.core.lobes.layers import layered_fit
from rsibr.rsibr_addon.core.lobes.target import elevation_slices
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.lobe_stack import elevation_texels, map_texels
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.tests.glsl.evaluation import evaluate
from split_sum import split_sum

MATERIALS = {
    "copper, alpha .3": "ggx:alpha=0.3,eta=0.2/0.924/1.102,k=3.912/2.452/2.142",
    "Ward, alpha .04": "ward:alpha=0.04,ks=0.8",
    "coat, alpha .1, f0 .04": "ggx:alpha=0.1,f0=0.04",
    "car paint bmw_339": "car_paint:name=bmw_339",
}
TARGETS = {
    "copper, alpha .3": "2 %, 8x, 5x",
    "Ward, alpha .04": "2 %, -, 5x",
    "coat, alpha .1, f0 .04": "4 %, 5x, 5x",
    "car paint bmw_339": "1.5 %, -, 5x",
}
"""Error, and how much closer than the split sum and than radiance views."""

ENVIRONMENTS = ("forest", "city")
LOBES, SLICES = 3, 16
SIDES = np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)])
"""Directions of the views: front, right, back, left."""

RINGS, EVERY = 48, 16
CAPTURED, CAPTURED_SIZE, CAPTURED_RINGS = 12, 256, 128


@dataclass(frozen=True)
class Points:
    """Surface points, and what they should show.

    Attributes
    ----------
    normal, view_dir, radiance : ndarray, shape (N, 3)
        View after view.
    """

    normal: Array
    view_dir: Array
    radiance: Array

    def error(self, shaded: Array, views: int = len(SIDES)) -> float:
        """Relative root-mean-square error of what the first views show instead."""
        seen = slice(views * len(self.normal) // len(SIDES))
        square = np.sum((shaded[seen] - self.radiance[seen]) ** 2)
        return float(np.sqrt(square / np.sum(self.radiance[seen] ** 2)))


def lit_points(brdf: Brdf, radiance: Array) -> Points:
    """Spheres from all sides, each point with as much area."""
    mu = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    frames = camera_frame(SIDES)
    seen = np.stack([environment_about(radiance, frame) for frame in frames])
    width = radiance.shape[1]
    column = np.arange(0, width, EVERY)
    azimuth = np.pi * (1.0 - 2.0 * (column + 0.5) / width)[None, :]
    radius = np.sqrt(1.0 - mu**2)[:, None]
    across = np.broadcast_arrays(radius * np.cos(azimuth), radius * np.sin(azimuth), mu[:, None])
    normal = np.einsum("vij,rcj->vrci", frames, np.stack(across, axis=-1))
    view_dir = np.broadcast_to(frames[:, None, None, :, 2], normal.shape)
    exact = ring_radiance(brdf, seen, mu)[..., column, :]
    return Points(*(values.reshape(-1, 3) for values in (normal, view_dir, exact)))


def from_profiles(fit: Fit, radiance: Array, points: Points) -> Array:
    """The fit itself, filtered along every point's own axes."""
    series = [expand(kernel) for kernel in fit.bank.lobes()]
    harmonics = analyse_environment(radiance, analysis_degree(series))
    mu = dot(points.normal, points.view_dir)
    position = np.interp(mu, fit.mu, np.arange(len(fit.mu)))
    below = np.floor(position).astype(np.intp)
    above = np.minimum(below + 1, len(fit.mu) - 1)
    mirror_dir = reflect(points.view_dir, points.normal)

    def between(table: Array) -> Array:
        share = (position - below).reshape(-1, *[1] * (table.ndim - 1))
        return (1.0 - share) * table[below] + share * table[above]

    total = np.zeros(points.normal.shape)
    for lobe in range(len(fit.weights)):
        weights = between(fit.weights[lobe]) * between(fit.scale[lobe])[:, None]
        offsets, taps = between(fit.offsets[lobe]), between(fit.taps[lobe])
        for tap in range(taps.shape[1]):
            axes = lobe_axes(points.normal, mirror_dir, offsets[:, tap])
            filtered = prefilter(harmonics, series, axes).radiance
            total += taps[:, tap, None] * np.einsum("pkc,kpc->pc", weights, filtered)
    return np.maximum(total, 0.0)


def from_graphics_memory(stack: LobeStack, points: Points) -> Array:
    """The stack as half floats in a 3D texture, shaded by the shaders' own function."""
    lobes, slices = stack.maps.shape[:2]
    numbers = LAYOUTS.index(stack.layout), lobes, stack.taps.shape[2], slices
    suns = "LobeSuns(0, 0, 0, 0.0, vec4(0.0))"  # they are in the maps
    code = (
        f"result_0.rgb = stack_radiance(maps, elevations, {', '.join(map(str, numbers))}, {suns}, "
        f"normalize(in_0.xyz), normalize(in_1.xyz), vec3(0.0), vec3(0.0));"
    )
    samplers = {
        "maps": ("FLOAT_3D", GpuTexture("maps", map_texels(stack), "RGBA16F", deep=True).whole()),
        "elevations": ("FLOAT_2D", buffers.texture(elevation_texels(stack, StackLook().shown(stack)))),
    }
    arguments = [points.normal, points.view_dir]
    return evaluate("lobe_stack_lib.glsl", code, arguments, samplers=samplers)[:, 0, :3]


def from_captured_views(brdf: Brdf, radiance: Array, points: Points) -> Array:
    """[Cabral1999]: exact pictures from the icosahedron's vertices, warped and blended for each point."""
    vertices = geodesic_sphere(CAPTURED).vertices
    spheres = drain(lit_spheres(brdf, radiance, list(vertices), CAPTURED_RINGS))
    in_camera = sphere_map.normal_from_uv(texel_centres(CAPTURED_SIZE, CAPTURED_SIZE))
    maps = np.stack([sphere.at(in_camera @ sphere.frame.T) for sphere in spheres]).astype(np.float32)
    views = RadianceViews(np.zeros_like(maps), maps)
    return views_fragment(views, points.normal, points.view_dir, Warping.SINGLE)


def row(name: str, environment: Environment) -> str:
    """One line of the table."""
    brdf = brdf_from_spec(MATERIALS[name])
    start = time.process_time()
    fit = drain(layered_fit(brdf, elevation_slices(SLICES), LOBES))
    seconds = time.process_time() - start
    radiance = environment.radiance
    points = lit_points(brdf, radiance)
    start = time.process_time()
    stack = drain(bake_stack(radiance, fit, LAYOUTS[0])).stack
    baking = time.process_time() - start
    profiles = from_profiles(fit, radiance, points)
    front, ours = points.error(profiles, 1), points.error(profiles)
    baked = points.error(from_graphics_memory(stack, points))
    split = points.error(split_sum(brdf, radiance, points.normal, points.view_dir))
    views = points.error(from_captured_views(brdf, radiance, points))
    return (
        f"| {name} | {environment.name} | {len(fit.weights)} | {front:.2%} | {ours:.2%} "
        f"| {stack.size} | {baked:.2%} "
        f"| {split:.1%} ({split / ours:.1f}x) | {views:.1%} ({views / ours:.1f}x) "
        f"| {seconds:.1f}, {baking:.1f} s | {TARGETS[name]} |"
    )


def main() -> None:
    """Print the table, and write it into docs/lobe-stacks.md where it is whole."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--materials", nargs="*", choices=MATERIALS, default=list(MATERIALS))
    parser.add_argument("--environments", nargs="*", default=list(ENVIRONMENTS))
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", RsibrWarning)
    ensure_context()
    lines = [
        "| BRDF | environment | lobes | front | four sides | size | baked, half floats | split sum "
        "| 12 radiance views | CPU: fit, bake | asked |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|",
    ]
    for line in lines:
        print(line, flush=True)
    for environment in map(load_environment, chosen.environments):
        for name in chosen.materials:
            lines.append(row(name, environment))
            print(lines[-1], flush=True)
    if len(lines) == 2 + len(MATERIALS) * len(ENVIRONMENTS):
        write_table("lobe-stacks.md", "spheres", "\n".join(lines))


if __name__ == "__main__":
    main()
