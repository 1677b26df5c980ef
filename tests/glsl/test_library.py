"""Every function of gpu_shaders/lib against its numpy twin."""

from collections.abc import Callable
from functools import cache, partial

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry import directions, geodesic
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, normalize
from rsibr.rsibr_addon.core.geometry.reflection_warp import (
    Fading,
    Warp,
    confidence,
    singularity_distance,
    source_cosine,
    source_trust,
    source_uv,
)
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import views_fragment
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import LEAST_ALBEDO, Warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.resample import bilinear
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.kinds.radiance_views import _albedo_texels, _layers
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.tests.glsl.evaluation import Samplers, evaluate
from rsibr.tests.glsl.twins import (
    AXES,
    COUNT,
    ULP,
    Twin,
    check,
    disk_points,
    near_singularity,
    single,
    unit_vectors,
)
from rsibr.tests.synthetic_views import random_views, with_random_albedo


def frames_as_rows(frames: np.ndarray) -> np.ndarray:
    """Columns of (n, 3, 3) matrices as results, shape (n, 3, 3)."""
    return np.swapaxes(frames, -1, -2)


NEAR_POLES = normalize([(1e-6, 0.0, 1.0), (0.0, -1e-6, -1.0), (3e-6, 4e-6, 1.0), (-1e-3, 1e-4, -1.0)])


def opposite_error(view_dir: np.ndarray, mirror_dir: np.ndarray) -> np.ndarray:
    """As the docstring has it."""
    length = np.linalg.norm(view_dir + mirror_dir, axis=-1)
    return (1e-6 / np.maximum(length, 1e-6))[:, None, None]


DIRECTIONS = {
    "reflect_dir": Twin(
        "directions_lib.glsl",
        "result_0.xyz = reflect_dir(in_0.xyz, in_1.xyz);",
        lambda: [unit_vectors(1), unit_vectors(2, -AXES)],
        directions.reflect,
        1e-6,
    ),
    "mirror_normal": Twin(
        "directions_lib.glsl",
        "result_0.xyz = mirror_normal(in_0.xyz, in_1.xyz);",
        lambda: [unit_vectors(1), unit_vectors(2, -AXES)],
        directions.mirror_normal,
        lambda view_dir, mirror_dir: opposite_error(view_dir, mirror_dir),
    ),
    "transformed_normal": Twin(
        "directions_lib.glsl",
        "result_0.xyz = transformed_normal(mat3(in_0.xyz, in_1.xyz, in_2.xyz), in_3.xyz);",
        lambda: [unit_vectors(seed) for seed in (1, 2, 3, 4)],
        lambda x, y, z, normal: directions.transformed_normal(np.stack([x, y, z], axis=-1), normal),
        1e-6,
    ),
    "camera_frame": Twin(
        "directions_lib.glsl",
        "mat3 frame = camera_frame(in_0.xyz);"
        "result_0.xyz = frame[0]; result_1.xyz = frame[1]; result_2.xyz = frame[2];",
        lambda: [unit_vectors(1, np.concatenate([AXES, NEAR_POLES]))],
        lambda view_dir: frames_as_rows(camera_frame(view_dir)),
        1e-6,
        results=3,
    ),
}


def root_error(uv: np.ndarray) -> np.ndarray:
    """Error of z = sqrt(1 - r^2): six roundings of r^2, over 2 z, or their root where z is smaller."""
    z = sphere_map.normal_from_uv(uv)[:, 2]
    return 6.0 * ULP / np.maximum(z, np.sqrt(6.0 * ULP))


SPHERE_MAP = {
    "normal_from_uv": Twin(
        "sphere_map_lib.glsl",
        "result_0.xyz = normal_from_uv(in_0.xy);",
        lambda: [disk_points()],
        sphere_map.normal_from_uv,
        lambda uv: np.stack([np.full(COUNT, 1e-6), np.full(COUNT, 1e-6), root_error(uv)], axis=-1)[:, None],
    ),
    "sphere_map_texel_angle": Twin(
        "sphere_map_lib.glsl",
        "result_0.x = sphere_map_texel_angle(in_0.x);",
        lambda: [single(np.linspace(1.0, 4096.0, COUNT)[:, None])],
        lambda size: sphere_map.texel_angle(size),
        lambda size: (4.0 * ULP / size)[:, None],
    ),
    "uv_from_normal": Twin(
        "sphere_map_lib.glsl",
        "result_0.xy = uv_from_normal(in_0.xyz);",
        lambda: [unit_vectors(1, np.concatenate([AXES, near_singularity()]))],
        sphere_map.uv_from_normal,
        1e-6,
    ),
    "direction_from_uv": Twin(
        "sphere_map_lib.glsl",
        "result_0.xyz = direction_from_uv(in_0.xy);",
        lambda: [disk_points()],
        sphere_map.direction_from_uv,
        lambda uv: np.stack([2.0 * root_error(uv)] * 2 + [np.full(COUNT, 2e-6)], axis=-1)[:, None],
    ),
    "uv_from_direction": Twin(
        "sphere_map_lib.glsl",
        "result_0.xy = uv_from_direction(in_0.xyz);",
        lambda: [unit_vectors(1, np.concatenate([AXES, near_singularity()]))],
        sphere_map.uv_from_direction,
        1e-6,
    ),
}


@cache
def points_and_sources() -> list[np.ndarray]:
    """Normals towards the eye, view directions, and a source's axes: x, y and z, its view direction."""
    view_dir, normal = unit_vectors(1), unit_vectors(2, -AXES)
    normal = np.where(dot(normal, view_dir)[:, None] < 0.0, -normal, normal)
    frame = single(camera_frame(unit_vectors(3, np.roll(AXES, 1, axis=0))))
    return [normal, view_dir, frame[:, :, 0], frame[:, :, 1], frame[:, :, 2]]


def place_or_anywhere(warp: Warp) -> Callable[..., np.ndarray]:
    """1e-5 where the source is trusted, beyond which no place is promised."""
    return lambda normal, view_dir, x, y, z: np.where(
        source_trust(Fading.COSINE, warp, normal, view_dir, z) > 0.1, 1e-5, 1.0
    )[:, None, None]


def warp_twins(warp: Warp) -> dict[str, Twin]:
    number = f"WARP_{warp.name}"

    def uv_and_cosine(normal: np.ndarray, view_dir: np.ndarray, *axes: np.ndarray) -> np.ndarray:
        uv = source_uv(warp, normal, view_dir, np.stack(axes, axis=-1))
        return np.c_[uv, source_cosine(warp, normal, view_dir, axes[2])]

    return {
        f"source_uv {warp}": Twin(
            "reflection_warp_lib.glsl",
            f"result_0.xy = source_uv({number}, in_0.xyz, in_1.xyz, mat3(in_2.xyz, in_3.xyz, in_4.xyz));",
            points_and_sources,
            lambda *arguments: uv_and_cosine(*arguments)[:, :2],
            place_or_anywhere(warp),
        ),
        f"source_cosine {warp}": Twin(
            "reflection_warp_lib.glsl",
            f"result_0.x = source_cosine({number}, in_0.xyz, in_1.xyz, in_2.xyz);",
            lambda: [points_and_sources()[i] for i in (0, 1, 4)],
            lambda *vectors: source_cosine(warp, *vectors)[:, None],
            1e-6,
        ),
        f"seen_by {warp}": Twin(
            "radiance_views_lib.glsl",
            f"result_0.xyz = seen_by(FADING_COSINE, {number}, in_0.xyz, in_1.xyz, in_4.xyz).xyz;",
            points_and_sources,
            uv_and_cosine,
            place_or_anywhere(warp),
        ),
        **{
            f"source_trust {fading} {warp}": Twin(
                "reflection_warp_lib.glsl",
                f"result_0.x = source_trust(FADING_{fading.name}, {number}, in_0.xyz, in_1.xyz, in_2.xyz);",
                lambda: [points_and_sources()[i] for i in (0, 1, 4)],
                partial(trust_of, fading, warp),
                1e-5,
            )
            for fading in Fading
        },
    }


def trust_of(fading: Fading, warp: Warp, *vectors: np.ndarray) -> np.ndarray:
    return source_trust(fading, warp, *vectors)[:, None]


REFLECTION_WARP = (
    warp_twins(Warp.NORMAL)
    | warp_twins(Warp.MIRROR)
    | {
        "confidence": Twin(
            "reflection_warp_lib.glsl",
            "result_0.x = confidence(in_0.x);",
            lambda: [single(np.random.default_rng(9).uniform(-1.0, 1.0, (COUNT, 1)))],
            confidence,
            1e-6,
        ),
        "singularity_distance": Twin(
            "reflection_warp_lib.glsl",
            "result_0.x = singularity_distance(in_0.xyz, in_1.xyz, in_2.xyz);",
            lambda: [points_and_sources()[i] for i in (0, 1, 4)],
            lambda *vectors: singularity_distance(*vectors)[:, None],
            1e-5,
        ),
    }
)

VIEWS = with_random_albedo(random_views(12, 8))
FILTERING = 2.0 / 512.0
"""Hardware may round the weight of a texel to 8 bits along each axis; neighbours here differ by up to 1."""

WARPS = (Warp.NORMAL, Warp.MIRROR)
CARRIED = {
    (Warping.SINGLE, Warp.NORMAL): np.zeros_like(VIEWS.diffuse),
    (Warping.SINGLE, Warp.MIRROR): VIEWS.combined,
    (Warping.SPLIT, Warp.NORMAL): VIEWS.diffuse,
    (Warping.SPLIT, Warp.MIRROR): VIEWS.glossy,
    (Warping.ALBEDO, Warp.NORMAL): VIEWS.diffuse,
    (Warping.ALBEDO, Warp.MIRROR): VIEWS.glossy,
}
"""The radiance that each warp carries to where it is shown."""


def views_samplers() -> Samplers:
    return {
        "views": ("FLOAT_2D_ARRAY", GpuTexture("views", _layers(VIEWS)).whole()),
        "albedo": ("FLOAT_2D", buffers.texture(_albedo_texels(VIEWS))),
    }


@cache
def blend_arguments() -> list[np.ndarray]:
    """Normals, view directions, and the indices and weights of the three views around each."""
    view_dir, normal = unit_vectors(1), unit_vectors(2, -AXES)
    # Grazing normals are looked up where a mirror's map is pinched, and places are not known well.
    normal = single(
        normalize(np.where(dot(normal, view_dir)[:, None] < 0.0, -normal, normal) + 0.2 * view_dir)
    )
    sources = geodesic.find_triangle(VIEWS.sphere, view_dir)
    weights = geodesic.barycentric_weights(view_dir, VIEWS.sphere.vertices[sources])
    return [normal, view_dir, sources.astype(np.float64), single(weights)]


def table_at(warping: Warping, warp: Warp, cosine: np.ndarray) -> np.ndarray:
    """What radiance is divided by, by hand: linear between the table's columns."""
    if warping is not Warping.ALBEDO:
        return np.ones((*np.shape(cosine), 3))
    row = VIEWS.albedo[WARPS.index(warp)]
    columns = (np.arange(len(row)) + 0.5) / len(row)
    return np.stack([np.interp(cosine, columns, row[:, i]) for i in range(3)], axis=-1) + LEAST_ALBEDO


@cache
def blended(warping: Warping, warp: Warp, fading: Fading) -> np.ndarray:
    """What fragments at `blend_arguments` show of one part, less the albedo at their own cosine."""
    normal, view_dir = blend_arguments()[:2]
    parts = {carried: np.zeros_like(VIEWS.diffuse) for carried in ("diffuse", "glossy")}
    parts["diffuse" if warp is Warp.NORMAL else "glossy"] = CARRIED[warping, warp]
    alone = RadianceViews(parts["diffuse"], parts["glossy"], VIEWS.albedo)
    shown_as = warping if warping is Warping.ALBEDO else Warping.SPLIT
    shown = views_fragment(alone, normal, view_dir, shown_as, fading=fading)
    return shown / table_at(warping, warp, dot(normal, view_dir))


def blending_tolerance(warping: Warping) -> float:
    """Filtering, and places off by 1e-5 of the map, 8e-5 of a texel; over the least albedo, 0.2."""
    return 2.0 * (FILTERING + 2.0 * 8e-5) / (0.2 if warping is Warping.ALBEDO else 1.0)


VERTICES = ", ".join(f"vec3({x!r}, {y!r}, {z!r})" for x, y, z in VIEWS.sphere.vertices.tolist())
SOURCES = (
    f"vec3 vertices[12] = vec3[12]({VERTICES});"
    "ivec3 sources = ivec3(in_2.xyz + 0.5);"
    "mat3 source_dirs = mat3(vertices[sources.x], vertices[sources.y], vertices[sources.z]);"
)


def blending_twins(warping: Warping, warp: Warp) -> dict[str, Twin]:
    numbers = f"WARPING_{warping.name}, WARP_{warp.name}"
    places = f"WARP_{warp.name}, in_0.xyz, in_1.xyz, source_dirs"
    seen = ", ".join(f"seen_by(FADING_COSINE, {places}[{i}])" for i in range(3))
    of_places = f"views, albedo, {numbers}, sources, vec4[3]({seen}), in_3.xyz"
    return {
        f"albedo_at {warping} {warp}": Twin(
            "radiance_views_lib.glsl",
            f"result_0.xyz = albedo_at(albedo, {numbers}, in_0.x);",
            lambda: [single(np.random.default_rng(10).uniform(-0.2, 1.0, (COUNT, 1)))],
            lambda cosine: table_at(warping, warp, cosine[:, 0]),
            FILTERING,
            samplers=views_samplers,
        ),
        f"source_radiance {warping} {warp}": Twin(
            "radiance_views_lib.glsl",
            f"result_0.xyz = source_radiance(views, {numbers}, int(in_1.x), in_0.xy);",
            lambda: [disk_points(), np.random.default_rng(7).integers(0, 12, (COUNT, 1)).astype(np.float64)],
            lambda uv, view: bilinear(
                CARRIED[warping, warp], uv, sphere_map.wrap, layer=view[:, 0].astype(int)
            ),
            2.0 * FILTERING,
            samplers=views_samplers,
        ),
        f"blend_sources {warping} {warp}": Twin(
            "radiance_views_lib.glsl",
            f"{SOURCES} result_0.xyz = blend_sources({of_places});",
            blend_arguments,
            lambda *_: blended(warping, warp, Fading.COSINE),
            blending_tolerance(warping),
            samplers=views_samplers,
        ),
        **{
            f"warp_and_blend {warping} {fading} {warp}": Twin(
                "radiance_views_lib.glsl",
                f"{SOURCES} result_0.xyz = warp_and_blend({of_point(warping, fading, warp)});",
                blend_arguments,
                partial(lambda fading, *_: blended(warping, warp, fading), fading),
                blending_tolerance(warping),
                samplers=views_samplers,
            )
            for fading in Fading
        },
    }


def of_point(warping: Warping, fading: Fading, warp: Warp) -> str:
    """Arguments of `warp_and_blend`."""
    numbers = f"WARPING_{warping.name}, FADING_{fading.name}, WARP_{warp.name}"
    return f"views, albedo, {numbers}, in_0.xyz, in_1.xyz, sources, source_dirs, in_3.xyz"


RADIANCE_VIEWS = {
    name: twin
    for warping in Warping
    for warp in WARPS
    if (warping, warp) != (Warping.SINGLE, Warp.NORMAL)
    for name, twin in blending_twins(warping, warp).items()
}

TWINS = DIRECTIONS | SPHERE_MAP | REFLECTION_WARP | RADIANCE_VIEWS


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])


def test_the_singularity_has_one_answer_here_too() -> None:
    nowhere = np.array([(0.0, 0.0, -1.0)])
    for function in ("uv_from_direction", "uv_from_normal"):
        found = evaluate("sphere_map_lib.glsl", f"result_0.xy = {function}(in_0.xyz);", [nowhere])
        np.testing.assert_array_equal(found[0, 0, :2], (1.0, 0.5))
