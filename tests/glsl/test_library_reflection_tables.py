"""Looking reflection tables up, on the GPU and in numpy."""

from collections.abc import Callable

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.averaging import Averaging, footprint_mean, summed_means
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_sides
from rsibr.rsibr_addon.core.antialiased.strips import strip_means
from rsibr.rsibr_addon.core.antialiased.summed_area import summed_area_table
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, refract
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.core.resample import bilinear, bordered
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.equirect import EQUIRECT
from rsibr.rsibr_addon.device.summed_area import summed_area_texture
from rsibr.tests.glsl.evaluation import Samplers
from rsibr.tests.glsl.test_library_summed_area import CORNERS, footprints
from rsibr.tests.glsl.twins import AXES, COUNT, ULP, Twin, check, single, unit_vectors

ROWS = 8
FILTERING = 2.0 / 512.0
"""Hardware may round the weight of a texel to 8 bits along each axis; neighbours here differ by up to 1."""

RNG = np.random.default_rng(8)
IMAGE = RNG.random((ROWS, 2 * ROWS, 3), dtype=np.float32)
WEIGHTS = RNG.random((len(Role), 16, 3), dtype=np.float32)

NEAR_POLES_AND_SEAM = normalize(
    [(1e-6, 0.0, 1.0), (0.0, -1e-6, -1.0), (1e-3, 2e-3, 1.0), (-1.0, 1e-6, 0.0), (-1.0, -1e-6, 0.1)]
)
DIRECTIONS = unit_vectors(1, np.concatenate([AXES, NEAR_POLES_AND_SEAM]))

ARCTANGENT = 2e-5
"""Relative error of drivers' arctangents, in turns here: at most half of one."""


def samplers() -> Samplers:
    return {
        "image": ("FLOAT_2D", buffers.texture(buffers.with_alpha(bordered(IMAGE[None], EQUIRECT)[0]))),
        "weights": ("FLOAT_2D", buffers.texture(buffers.with_alpha(WEIGHTS))),
    }


def equirect_uv_error(direction: np.ndarray) -> np.ndarray:
    """Of u the driver's; none where it means nothing or wraps; of v likewise."""
    seam_or_pole = (np.abs(direction[:, 1]) < 1e-6) & (direction[:, 0] <= 0.0)
    u_error = np.where(seam_or_pole, 1.0, 0.5 * ARCTANGENT)
    return np.stack([u_error, np.full(COUNT, ARCTANGENT)], axis=-1)[:, None]


def refraction_error(view_dir: np.ndarray, normal: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Six roundings of the squared sine, over twice the cosine, or their root where that is smaller."""
    sine2 = (1.0 - dot(view_dir, normal) ** 2) / eta[:, 0] ** 2
    inwards = np.sqrt(np.maximum(1.0 - sine2, 0.0))
    squared = 12.0 * ULP / np.minimum(eta[:, 0], 1.0) ** 2
    error = 1e-6 + squared / np.maximum(inwards, np.sqrt(squared))
    return error[:, None, None]


def refract_each(view_dir: np.ndarray, normal: np.ndarray, eta: np.ndarray) -> np.ndarray:
    refracted = np.empty_like(view_dir)
    for index in np.unique(eta):
        chosen = eta[:, 0] == index
        refracted[chosen] = refract(view_dir[chosen], normal[chosen], float(index))
    return refracted


def weighted(role: Role, direction: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Weight times table through the reference: of the diffuse table, which goes by the normal.

    Cosines are not negative, as the reference turns the normal to the eye.
    """
    weights = np.zeros_like(WEIGHTS)
    weights[0] = WEIGHTS[list(Role).index(role)]
    tables = ReflectionTables({Role.DIFFUSE: IMAGE}, weights)
    across = normalize(np.cross(direction, direction[:, [1, 2, 0]] + (0.3, 0.5, 0.7)))
    view_dir = cosine * direction + np.sqrt(1.0 - cosine**2) * across
    return reflect_tables(tables, direction, view_dir, TablesLook())


SUMMED = summed_area_table(IMAGE)
UNIT = "vec3({!r}, {!r}, {!r})".format(*SUMMED.unit.tolist())


def weighted_mean(*arguments: np.ndarray) -> np.ndarray:
    """Weight times the table's mean over a footprint, through the reference."""
    *corners, more = arguments
    tables = ReflectionTables({Role.SPECULAR: IMAGE}, WEIGHTS)
    normal = np.array([0.0, 0.0, 1.0])
    view_dir = np.stack([np.sqrt(1.0 - more[:, 0] ** 2), np.zeros(COUNT), more[:, 0]], axis=-1)
    averaged = TablesLook(averaging=Averaging.SUMMED)
    return more[:, 1:] * reflect_tables(tables, normal, view_dir, averaged, np.stack(corners, axis=1))


TWINS = {
    "refract_dir": Twin(
        "directions_lib.glsl",
        "result_0.xyz = refract_dir(in_0.xyz, in_1.xyz, in_2.x);",
        lambda: [
            unit_vectors(1),
            unit_vectors(2, -AXES),
            single(np.random.default_rng(3).choice([0.6, 0.75, 1.0, 1.5, 2.4], (COUNT, 1))),
        ],
        refract_each,
        refraction_error,
    ),
    "equirect_uv": Twin(
        "equirect_lib.glsl",
        "result_0.xy = equirect_uv(in_0.xyz);",
        lambda: [DIRECTIONS],
        equirect.uv_from_direction,
        equirect_uv_error,
    ),
    "equirect_radiance": Twin(
        "equirect_lib.glsl",
        "result_0.xyz = equirect_radiance(image, in_0.xyz);",
        lambda: [DIRECTIONS],
        lambda direction: bilinear(IMAGE, equirect.uv_from_direction(direction), equirect.wrap),
        # A place off by the arctangent's error, in texels, twice
        2.0 * (FILTERING + 2 * ROWS * ARCTANGENT),
        samplers=samplers,
    ),
    "table_weight": Twin(
        "reflection_tables_lib.glsl",
        "result_0.xyz = table_weight(weights, int(in_0.y + 0.5), in_0.x);",
        lambda: [single(np.c_[RNG.uniform(-0.2, 1.0, COUNT), RNG.integers(0, len(Role), COUNT)])],
        lambda place: bilinear(
            WEIGHTS, np.stack([place[:, 0], (place[:, 1] + 0.5) / len(Role)], axis=-1), sphere_map.wrap
        ),
        FILTERING,
        samplers=samplers,
    ),
    "weighted_mean": Twin(
        "reflection_tables_lib.glsl",
        f"{CORNERS} result_0.xyz = weighted_mean("
        f"vec3(in_4.y), image, sums, {UNIT}, weights, TABLE_SPECULAR, in_4.x, "
        "vec3(-sqrt(1.0 - in_4.x * in_4.x), 0.0, in_4.x), corners, 2.0);",
        lambda: [
            *footprints(),
            single(np.c_[RNG.uniform(0.0, 1.0, COUNT), RNG.integers(0, 2, COUNT).astype(np.float64)]),
        ],
        weighted_mean,
        # Boxes off by 3e-6, at worst over one texel, of which neighbours differ by up to 1
        2.0 * FILTERING + 6e-6 * 2 * ROWS,
        samplers=lambda: all_samplers(),
    ),
} | {
    f"weighted_table {role}": Twin(
        "reflection_tables_lib.glsl",
        f"result_0.xyz = weighted_table(vec3(in_1.y), image, weights, TABLE_{role.name}, in_1.x, in_0.xyz);",
        lambda: [
            DIRECTIONS,
            single(np.c_[RNG.uniform(0.0, 1.0, COUNT), RNG.integers(0, 2, COUNT).astype(np.float64)]),
        ],
        lambda direction, more, role=role: more[:, 1:] * weighted(role, direction, more[:, :1]),
        3.0 * (FILTERING + 2 * ROWS * ARCTANGENT),
        samplers=samplers,
    )
    for role in Role
}


def all_samplers() -> Samplers:
    return samplers() | {"sums": ("FLOAT_2D_ARRAY", summed_area_texture(SUMMED).whole())}


def averaged(averaging: Averaging) -> Callable[..., np.ndarray]:
    """The reference's mean over footprints."""
    return lambda *corners: footprint_mean(
        IMAGE, normalize(np.sum(corners, axis=0)), np.stack(corners, axis=1), averaging
    )


MEANS: dict[str, tuple[str, Callable[..., np.ndarray]]] = {
    "summed_mean": (
        f"summed_mean(sums, {UNIT}, corners)",
        lambda *corners: summed_means(SUMMED, np.stack(corners, axis=1)),
    ),
    "strip_mean": (
        f"strip_mean(sums, {UNIT}, corners, footprint_box(corners, vec2({2 * ROWS}, {ROWS})))",
        lambda *corners: strip_means(SUMMED, np.stack(corners, axis=1)),
    ),
    "subdivided_mean": (
        f"subdivided_mean(image, sums, {UNIT}, middle, corners)",
        averaged(Averaging.SUBDIVIDE),
    ),
} | {
    f"footprint_mean {averaging}": (
        f"footprint_mean(image, sums, {UNIT}, middle, corners, {float(number)!r})",
        averaged(averaging),
    )
    for number, averaging in enumerate(Averaging)
}
"""Means over footprints -> their code, and the reference."""

TWINS |= {
    name: Twin(
        "averaging_lib.glsl",
        f"{CORNERS} vec3 middle = normalize(in_0.xyz + in_1.xyz + in_2.xyz + in_3.xyz);"
        f"result_0.xyz = {code};",
        footprints,
        expected,
        # As of interpolation, and of boxes, above
        2.0 * (FILTERING + 2 * ROWS * ARCTANGENT) + 6e-6 * 2 * ROWS,
        samplers=all_samplers,
    )
    for name, (code, expected) in MEANS.items()
}
TWINS["footprint_sides"] = Twin(
    "footprint_lib.glsl",
    f"{CORNERS} vec3 across, up; footprint_sides(corners, across, up);"
    "result_0.xyz = across; result_1.xyz = up;",
    footprints,
    lambda *corners: np.stack(footprint_sides(np.stack(corners, axis=1)), axis=1),
    4.0 * ULP * 3.0,  # four roundings of directions that are 3 long at most
    results=2,
)


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])
