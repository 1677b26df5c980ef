"""The layers of Principled materials against their numpy twins."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf import fresnel_powers, oren_nayar, principled
from rsibr.rsibr_addon.core.brdf.bumped_diffuse import bumped_cosine
from rsibr.rsibr_addon.core.brdf.principled import Layers, layers_of
from rsibr.tests.glsl.evaluation import Samplers
from rsibr.tests.glsl.principled_inputs import (
    SURFACE,
    families,
    numbers,
    samplers,
    surface_arguments,
    surface_of,
)
from rsibr.tests.glsl.twins import ULP, Twin, check, unit_vectors


def written(powers: str, first: int = 0) -> str:
    """GLSL that tells coefficients, as five results."""
    rising = "".join(f"result_{first + 1 + n}.rgb = {powers}.rising[{n}];" for n in range(4))
    return f"result_{first}.rgb = {powers}.zeroth; {rising}"


def surfaces_and_mu() -> list[np.ndarray]:
    return [*surface_arguments(), numbers(14, 0.02, 1.0)]


def albedo_arguments() -> list[np.ndarray]:
    """Widths, those of mirrors and beyond 1 among them, and cosines."""
    return [numbers(15, 0.0, 1.1) ** 2, numbers(16)]


def expected_albedo(alpha: np.ndarray, mu: np.ndarray) -> np.ndarray:
    powers = families().powers(alpha[:, 0], mu[:, 0])
    mean = families().mean(alpha[:, 0])
    return np.stack([powers[:, 1:], np.c_[powers[:, 0], mean, 0.0 * powers[:, :2]]], axis=1)


def bounced_arguments() -> list[np.ndarray]:
    """Means, a metal's F0, an albedo and the mean albedo."""
    return [
        numbers(17, columns=3),
        numbers(18, columns=3),
        numbers(19, 0.3, 1.0, 2),
        numbers(20, 0.0, 0.3, 4),
    ]


def expected_bounced(mean: np.ndarray, f0: np.ndarray, white: np.ndarray, rising: np.ndarray) -> np.ndarray:
    class Given:
        def powers(self, alpha: np.ndarray, mu: np.ndarray) -> np.ndarray:
            return np.hstack([white[:, :1], rising])

        def mean(self, alpha: np.ndarray) -> np.ndarray:
            return white[:, 1]

    single_bounce = np.moveaxis(fresnel_powers.schlick(f0), -1, -2)
    found, reflected = principled._bounced(single_bounce, mean, 0.5, white[:, 0], Given())
    return np.concatenate([found, reflected[:, None]], axis=1)


def layer_twin(code: str, expected, results: int) -> Twin:
    """Of a function of a surface, seen at a cosine."""
    return Twin(
        "principled_lib.glsl",
        f"{SURFACE} float mu = in_7.x; vec3 beside; {code}",
        surfaces_and_mu,
        lambda *arguments: expected(surface_of(*arguments[:-1]), arguments[-1][:, 0], families()),
        # Weights of texels of 8 bits are another mu, by 1e-4, of albedos that rise with slopes up to 6
        2e-3,
        results=results,
        samplers=samplers_of_layers,
    )


def samplers_of_layers() -> Samplers:
    made = samplers()
    return {name: made[name] for name in ("albedos", "rises", "sheens")}


def beside_lobes(layers: Layers) -> np.ndarray:
    return np.stack([layers.diffuse, layers.emission, layers.sheen], axis=1)


ALBEDO = "Albedo albedo = ggx_albedo(albedos, surface.roughness * surface.roughness, mu);"


def coefficients(powers: np.ndarray, *beside: np.ndarray) -> np.ndarray:
    return np.concatenate([powers, *(colors[:, None] for colors in beside)], axis=1)


TWINS = {
    "bumped_cosine": Twin(
        "bumped_diffuse_lib.glsl",
        "result_0 = bumped_cosine(in_0.xyz, in_1.xyz);",
        lambda: [unit_vectors(41), unit_vectors(42)],
        lambda normal, smooth: np.concatenate(
            [(found := bumped_cosine(normal, smooth))[0], found[1][:, None]], axis=1
        ),
        # Axes of normals that are opposite to each other have lengths from .07
        20 * ULP,
    ),
    "fujii_coefficients": Twin(
        "oren_nayar_lib.glsl",
        "result_0.xy = fujii_coefficients(in_0.x);",
        lambda: [numbers(21)],
        lambda roughness: np.stack(oren_nayar.fujii_coefficients(roughness[:, 0]), axis=-1),
        # A product, a sum and a quotient of numbers below 1
        4 * ULP,
    ),
    "leaning_albedo": Twin(
        "oren_nayar_lib.glsl",
        "result_0.x = leaning_albedo(in_0.x);",
        lambda: [numbers(22, 1e-4, 1.0)],
        lambda cosine: oren_nayar.leaning_albedo(cosine[:, 0]),
        # Mesa's arctangent is good to 2e-6
        5e-6,
    ),
    "bounces": Twin(
        "oren_nayar_lib.glsl",
        "result_0.rgb = bounces(in_0.rgb, in_1.x, in_2.x);",
        lambda: [numbers(23, columns=3), numbers(24, 0.01, 1.0), numbers(25, 1e-3, 1.0)],
        lambda color, roughness, mu: oren_nayar.bounces(color, roughness[:, 0], mu[:, 0]),
        # Of `leaning_albedo`, times 1 / (.68 pi)
        5e-6,
    ),
    "powers_of": Twin(
        "fresnel_powers_lib.glsl",
        "result_0 = powers_of(in_0.x);",
        lambda: [numbers(26)],
        lambda cosine: fresnel_powers.powers_of(cosine[:, 0])[:, 1:],
        8 * ULP,
    ),
    "schlick": Twin(
        "fresnel_powers_lib.glsl",
        f"Powers found = schlick(in_0.rgb, in_1.rgb); {written('found')}",
        lambda: [numbers(27, columns=3), numbers(28, columns=3)],
        lambda f0, edge: np.moveaxis(fresnel_powers.schlick(f0, edge), -1, -2),
        ULP,
        results=5,
    ),
    "edge_of": Twin(
        "fresnel_powers_lib.glsl",
        "result_0.rgb = edge_of(in_0.rgb, in_1.rgb);",
        lambda: [numbers(29, columns=3), numbers(30, columns=3)],
        fresnel_powers.edge_of,
        # Products of values up to 18
        18 * 8 * ULP,
    ),
    "rise": Twin(
        "fresnel_powers_lib.glsl",
        "result_0 = rise(rises, in_0.x);",
        lambda: [numbers(31)],
        lambda amplitude: fresnel_powers.rise(amplitude[:, 0])[:, 1:],
        # Weights of 8 bits: a 512th of what neighbours differ by, half at most
        1e-3,
        samplers=lambda: {"rises": samplers()["rises"]},
    ),
    "dielectric": Twin(
        "fresnel_powers_lib.glsl",
        f"Powers found = dielectric(rises, in_0.x); {written('found')}",
        lambda: [numbers(32, 1.0, 4.0)],
        lambda index: fresnel_powers.dielectric(index[:, 0])[..., None] * np.ones(3),
        1e-3,
        results=5,
        samplers=lambda: {"rises": samplers()["rises"]},
    ),
    "coloured": Twin(
        "fresnel_powers_lib.glsl",
        f"Powers found = coloured(in_0.rgb, schlick(in_1.rgb, in_2.rgb)); {written('found')}",
        lambda: [numbers(33, columns=3), numbers(34, columns=3), numbers(35, columns=3)],
        lambda color, f0, edge: color[:, None] * np.moveaxis(fresnel_powers.schlick(f0, edge), -1, -2),
        2 * ULP,
        results=5,
    ),
    "mirror_share": Twin(
        "family_lib.glsl",
        "result_0.x = mirror_share(ggx, in_0.x);",
        lambda: [numbers(36, 0.0, 0.03)],
        lambda alpha: families().share(alpha[:, 0]),
        4 * ULP,
        samplers=lambda: {"ggx": samplers()["ggx"]},
    ),
    "ggx_albedo": Twin(
        "principled_lib.glsl",
        "Albedo found = ggx_albedo(albedos, in_0.x, in_1.x);"
        "result_0 = found.rising; result_1 = vec4(found.white, found.mean, 0.0, 0.0);",
        albedo_arguments,
        expected_albedo,
        # As of the layers below
        1e-3,
        results=2,
        samplers=lambda: {"albedos": samplers()["albedos"]},
    ),
    "dielectric_mean": Twin(
        "principled_lib.glsl",
        "result_0.x = dielectric_mean(in_0.x);",
        lambda: [numbers(37, 1.0, 200.0)],
        lambda index: principled.dielectric_mean(index[:, 0]),
        4 * ULP,
    ),
    "bounced": Twin(
        "principled_lib.glsl",
        "vec3 reflected; Powers found = bounced(schlick(in_1.rgb, vec3(0.0)), in_0.rgb, "
        f"Albedo(in_2.x, in_3, in_2.y), reflected); {written('found')} result_5.rgb = reflected;",
        bounced_arguments,
        expected_bounced,
        # A gain up to 1 / .3 of sums and quotients
        32 * ULP,
        results=6,
    ),
    "left_of": Twin(
        "principled_lib.glsl",
        "result_0.x = left_of(in_0.rgb);",
        lambda: [numbers(38, 0.0, 1.1, 3)],
        principled._left,
        ULP,
    ),
    "sheen_weights": Twin(
        "principled_lib.glsl",
        "result_0 = sheen_weights(sheens, in_0.x, in_1.x);",
        lambda: [numbers(42), numbers(43)],
        lambda roughness, mu: families().sheen_table.at(roughness[:, 0], mu[:, 0]),
        # As of layers
        2e-3,
        samplers=samplers_of_layers,
    ),
    "sheen_of": layer_twin(
        "float left; result_0.rgb = sheen_of(surface, mu, sheens, left); result_0.a = left;",
        lambda surface, mu, albedos: np.concatenate(principled._sheen(surface, mu, albedos), axis=1),
        1,
    ),
    "coat_of": layer_twin(
        "Powers found = coat_of(surface, mu, albedos, rises, beside);"
        f"{written('found')} result_5.rgb = beside;",
        lambda surface, mu, albedos: coefficients(*principled._coat(surface, mu, albedos)),
        6,
    ),
    "metal_of": layer_twin(
        f"{ALBEDO} Powers found = metal_of(surface, albedo); {written('found')}", principled._metal, 5
    ),
    "plastic_of": layer_twin(
        f"{ALBEDO} Powers found = plastic_of(surface, albedo, rises, beside);"
        f"{written('found')} result_5.rgb = beside;",
        lambda surface, mu, albedos: coefficients(*principled._plastic(surface, mu, albedos)),
        6,
    ),
    "layers_of base": layer_twin(
        f"Layers found = layers_of(surface, mu, mu, mu, albedos, rises, sheens); {written('found.base')}",
        lambda surface, mu, albedos: layers_of(surface, mu, albedos).base,
        5,
    ),
    "layers_of diffuse and emission": layer_twin(
        "Layers found = layers_of(surface, mu, mu, mu, albedos, rises, sheens);"
        "result_0.rgb = found.diffuse; result_1.rgb = found.emission;"
        "result_2.rgb = found.sheen;",
        lambda surface, mu, albedos: beside_lobes(layers_of(surface, mu, albedos)),
        3,
    ),
    "layers_of coat": layer_twin(
        f"Layers found = layers_of(surface, mu, mu, mu, albedos, rises, sheens); {written('found.coat')}",
        lambda surface, mu, albedos: layers_of(surface, mu, albedos).coat,
        5,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_twin(name: str) -> None:
    check(TWINS[name])
