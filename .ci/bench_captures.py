"""Measure lobes that are fitted to captured views, for docs/captured-lobes.md.

Captures are exact: 42 views of a sphere, of 128 texels, each the mean over its area. Lobes are fitted to the
first 12, or to one, and predict the 30 others; so do the three warps of [Cabral1999].
"""

import argparse
import time
from pathlib import Path

import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.geometry.lit_sphere import lit_spheres
from rsibr.rsibr_addon.core.geometry.reflection_warp import Fading
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import views_fragment
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.lobes.captured_light import CapturedLight
from rsibr.rsibr_addon.core.lobes.captured_texels import captured_texels
from rsibr.rsibr_addon.core.lobes.captures import fit_captures
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.fit_in_views import fit_radiance
from rsibr.rsibr_addon.core.lobes.next_views import compare_with_new
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.rsibr_addon.tasks.compare.contact_sheet import contact_sheet
from rsibr.rsibr_addon.tasks.compare.pictures import difference_picture
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.methods.fit_captures import filtered_light, shipped_families

CAR = (
    "principled:base_color=0.03/0.12/0.45,metallic=0.5,roughness=0.5,"
    "coat_weight=1,coat_roughness=0.114,coat_ior=1.5"
)
MATERIALS = {
    "copper, alpha .3": (None, "ggx:alpha=0.3,metal=copper"),
    "coat, alpha .1, over Lambert": ("lambert:kd=0.5/0.05/0.03", "ggx:alpha=0.1,f0=0.04"),
    "Ward, alpha .1": (None, "ward:alpha=0.1,ks=0.8"),
    "car paint": (None, CAR),
}
"""Name -> models of the diffuse and of the glossy part."""

VIEWS, CAPTURED, SIZE, FINER, RINGS = 42, 12, 128, 8, 256
DIRECTIONS = geodesic_sphere(VIEWS).vertices
ALBEDO_ROWS = 64
TEXELS, STRIDE = 20000, 5
ENVIRONMENTS = ("forest", "city")
PICTURE = Path(__file__).parents[1] / "docs" / "images" / "captured-lobes.png"


def model(spec: str) -> Brdf:
    """A model that is in no file."""
    return brdf_from_spec(spec, lambda name, path: (_ for _ in ()).throw(ValueError(path)))


def exact_views(environment: Environment, spec: str | None, kept: Path, view_dirs: Array) -> Array:
    """What views capture of a model, shape (V, size, size, 3); kept in a file."""
    if spec is None:
        return np.zeros((len(view_dirs), SIZE, SIZE, 3), np.float32)
    if kept.exists():
        return np.load(kept)
    spheres = drain(lit_spheres(model(spec), environment.radiance, list(view_dirs), RINGS))
    points = texel_centres(SIZE * FINER, SIZE * FINER)
    on_sphere = np.linalg.norm(2.0 * points - 1.0, axis=-1) < 1.0
    normal = sphere_map.normal_from_uv(points)

    def means(values: Array) -> Array:
        return values.reshape(SIZE, FINER, SIZE, FINER, *values.shape[2:]).mean(axis=(1, 3))

    maps = []
    for sphere in spheres:
        rows = [sphere.at(row @ sphere.frame.T) for row in np.split(normal, SIZE)]
        seen = means(np.concatenate(rows) * on_sphere[..., None])
        maps.append(sphere_map.fill_rim(seen, means(on_sphere)))
    np.save(kept, np.stack(maps))
    return np.stack(maps)


def captured(environment: Environment, name: str, folder: Path, view_dirs: Array) -> RadianceViews:
    """All views, with the albedo of both parts."""
    mu = (np.arange(ALBEDO_ROWS) + 0.5) / ALBEDO_ROWS
    maps, albedo = [], []
    for part, spec in zip(("diffuse", "glossy"), MATERIALS[name], strict=True):
        kept = folder / f"{Path(environment.name).stem}-{name.partition(' ')[0].rstrip(',')}-{part}.npy"
        maps.append(exact_views(environment, spec, kept, view_dirs))
        albedo.append(directional_albedo(model(spec), mu) if spec else np.zeros((ALBEDO_ROWS, 3)))
    return RadianceViews(*maps, np.stack(albedo).astype(np.float32), view_dirs=view_dirs)


def errors_and_powers(fit: Fit, light: CapturedLight, views: RadianceViews) -> tuple[Array, Array]:
    """Squared error of each view by the lobes, and its squared radiance, shapes (V,)."""
    seen = captured_texels(views, len(views.diffuse), TEXELS, light.suns.direction)
    root = np.sqrt(seen.stands_for)[:, None]
    true = root * (seen.diffuse + seen.glossy)
    rest = root * fit_radiance(fit, light, seen) - true
    squares, powers = (np.bincount(seen.view, np.sum(values**2, axis=1)) for values in (rest, true))
    return squares, powers


def pooled(of_views: tuple[Array, Array], numbers: Array) -> float:
    """Relative root-mean-square error of some views."""
    squares, powers = of_views
    return float(np.sqrt(squares[numbers].sum() / powers[numbers].sum()))


def pictured(fit: Fit, light: CapturedLight, views: RadianceViews, number: int) -> list[Array]:
    """A view as it is, by the lobes, and what is between; bright in print."""
    maps = views.diffuse[[number]], views.glossy[[number]]
    one = RadianceViews(*maps, views.albedo, view_dirs=views.sphere.vertices[[number]])
    inside = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1) < 1.0
    ours, true = np.zeros((2, SIZE, SIZE, 4))
    seen = captured_texels(one, 1, SIZE**2, light.suns.direction)
    centre = np.add.reduceat(
        sphere_map.uv_from_normal(seen.normal @ one.frames[0]) * seen.share[:, None], seen.first
    )
    x, y = np.minimum((SIZE * centre).astype(np.intp), SIZE - 1).T
    ours[y, x, :3], true[..., :3] = fit_radiance(fit, light, seen), one.combined[0] * inside[..., None]
    ours[..., 3] = true[..., 3] = inside
    scale = 0.35 / np.sqrt(np.mean(true[inside, :3] ** 2))
    bright = [each * np.array([scale, scale, scale, 1.0]) for each in (true, ours)]
    return [*bright, difference_picture(bright[1], bright[0], 0.1)]


def blended(views: RadianceViews, warping: Warping, fading: Fading = Fading.COSINE) -> tuple[Array, Array]:
    """The same by the blend of the captured views."""
    uv = texel_centres(SIZE, SIZE)
    inside = np.linalg.norm(2.0 * uv - 1.0, axis=-1) < 1.0
    inside &= np.arange(inside.size).reshape(inside.shape) % STRIDE == 0
    sources = RadianceViews(views.diffuse[:CAPTURED], views.glossy[:CAPTURED], views.albedo)
    ours, true = [], []
    for view in range(CAPTURED, len(views.diffuse)):
        normal = sphere_map.normal_from_uv(uv[inside]) @ views.frames[view].T
        view_dir = views.sphere.vertices[view]
        ours.append(views_fragment(sources, normal, view_dir, warping, fading=fading))
        true.append(views.combined[view][inside])
    return np.concatenate(ours), np.concatenate(true)


def error(ours: Array, true: Array) -> float:
    """Relative root-mean-square error."""
    return float(np.sqrt(np.sum((ours - true) ** 2) / np.sum(true.astype(np.float64) ** 2)))


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="where exact views are kept, 80 megabytes")
    folder = parser.parse_args().folder
    folder.mkdir(exist_ok=True)
    lights = {name: load_environment(name) for name in ENVIRONMENTS}
    filtered = {name: filtered_light(light.radiance) for name, light in lights.items()}
    warps = (Warping.SINGLE, Warping.SPLIT, Warping.ALBEDO)
    heads = (
        *("material", "environment", "single, by distance", *warps),
        *("lobes", "left out", "untested", "lobes, tested views"),
        *("lobes from 1", "relit in the other", "CPU"),
    )
    lines = [f"| {' | '.join(heads)} |", f"|---|---|{'---:|' * (len(heads) - 2)}"]
    sheet: list[Array] = []
    new = np.arange(CAPTURED, VIEWS)
    for material in MATERIALS:
        views = {name: captured(light, material, folder, DIRECTIONS) for name, light in lights.items()}
        for name, other in zip(ENVIRONMENTS, reversed(ENVIRONMENTS), strict=True):
            light, own = filtered[name], views[name]
            started = time.process_time()
            found = drain(fit_captures(own, light, shipped_families(), material, CAPTURED))
            seconds = time.process_time() - started
            one = drain(fit_captures(own, light, shipped_families(), material, 1)).fit
            untested = compare_with_new(DIRECTIONS[:CAPTURED], SIZE, light, found.weighed).untested
            tested = new[~np.any(DIRECTIONS[new] @ untested.T > 1.0 - 1e-9, axis=1)]
            of_views = errors_and_powers(found.fit, light, own)
            blends = [error(*blended(own, Warping.SINGLE, Fading.DISTANCE))]
            blends += [error(*blended(own, warp)) for warp in warps]
            figures = [
                *(f"{figure:.1%}" for figure in (*blends, pooled(of_views, new), found.fit.left_out)),
                str(len(new) - len(tested)),
                f"{pooled(of_views, tested):.1%}",
                f"{pooled(errors_and_powers(one, light, own), new):.1%}",
                f"{pooled(errors_and_powers(found.fit, filtered[other], views[other]), new):.1%}",
            ]
            worst = int(new[np.argmax(of_views[0][new])])
            sheet += pictured(found.fit, light, own, worst)
            lines.append(f"| {material} | {name} | {' | '.join(figures)} | {seconds:.0f} s |")
            print(lines[-1], "worst", worst, "tested", len(tested), flush=True)
    save_png(PICTURE, contact_sheet(sheet, 6))
    write_table("captured-lobes.md", "captures", "\n".join(lines))


if __name__ == "__main__":
    main()
