"""Shading from a mip chain [Kautz2004]: harmonics for diffuse light, a mip for glossy light, Fresnel.

Equation 8 of the paper in one pass: (1 - F) L_diffuse(normal) + F L_glossy(mirror direction).
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np

from ...antialiased.footprint import footprint_or_point, footprint_sides
from ...antialiased.sampling import sample_counts, samples
from ...brdf.fresnel import fresnel_schlick
from ...conventions import Array, ArrayLike
from ...filtering.irradiance import irradiance_from_harmonics
from ...geometry.directions import dot, reflect
from ...geometry.near_room import Room
from ...geometry.sides import seen_surface
from ...maps import cube_map
from ...maps.representation import representation
from ...options import Choice, Options, option
from ...resample import bilinear, clamp_to_edge, lookup
from ..look_options import antialiased_option, colour_option
from .chain import MipChain
from .mip_lobes import MipLobes
from .near_diffuse import EXPONENT, cosine_lobes
from .probes import Place, shares

_CUBE = representation("cube_map")


class Borders(StrEnum):
    """Texels with which a lookup near a face's border interpolates.

    SEAMLESS takes the neighbouring face's texels. CLAMPED repeats the face's own, as the hardware
    of 2004 did: with a box filter, the border problem of [Kautz2004] figure 4.
    """

    SEAMLESS = "seamless"
    CLAMPED = "clamped"


ROOMS = {
    Room.DISTANT: Choice("Distant", "far away, the same from everywhere"),
    Room.BOX: Choice("Box", "a box along the axes, so that light shifts as one moves"),
    Room.SPHERE: Choice("Sphere", "an ellipsoid, likewise"),
}
"""What stands for surroundings."""


def room_size_option(**more: Any) -> Any:
    """Widths of a room."""
    return option(
        (6.0, 6.0, 3.0),
        label="Room Size",
        help="Widths of the room along the axes",
        least=1e-3,
        most=1e6,
        metavar="X,Y,Z",
        **more,
    )


def room_middle_option(**more: Any) -> Any:
    """Middle of a room."""
    return point_option("Room Middle", "Middle of the room", **more)


def point_option(label: str, meaning: str, **more: Any) -> Any:
    """A point in world coordinates; `meaning` says which, in its help."""
    return option(
        (0.0, 0.0, 0.0),
        label=label,
        help=f"{meaning}, in world coordinates",
        least=-1e6,
        most=1e6,
        metavar="X,Y,Z",
        **more,
    )


@dataclass(frozen=True)
class MipLook(Options):
    """How a mip chain is shaded.

    Raises
    ------
    RangeError
        A value is out of range, or two of mip, roughness and exponent are given.
    """

    f0: tuple[float, float, float] = colour_option(
        0.04, "Reflectance", "Reflectance of the glossy part at normal incidence", "f_lambda"
    )
    kd: tuple[float, float, float] = colour_option(
        0.8, "Diffuse", "Albedo of the diffuse part", "k_d", "K|R,G,B"
    )
    mip: float = option(
        0.0,
        label="Mip",
        help="Mip that glossy light comes from; fractions blend two mips",
        least=0.0,
        most=1e3,
        soft_most=10.0,
        metavar="B",
        old_flag="--bias",
        stored="bias",
    )
    roughness: float | None = option(
        None,
        label="Roughness",
        help="Roughness that chooses the mip: the one as blurred as the highlight of a rough surface",
        least=0.0,
        most=1.0,
        none="that of the mip",
        switch=Choice("By Roughness", "Choose the mip of a roughness, whatever the size of the maps"),
        start=0.3,
        replaces=("mip",),
        metavar="R",
    )
    exponent: float | None = option(
        None,
        label="Exponent",
        help="Exponent of Phong's highlight that chooses the mip: the one as blurred",
        least=1.0,
        most=1e6,
        soft_most=1000.0,
        none="that of the mip",
        switch=Choice("By Exponent", "Choose the mip of a Phong exponent, whatever the size of the maps"),
        start=225.0,
        replaces=("mip", "roughness"),
        advanced=True,
        metavar="N",
    )
    borders: Borders = option(
        Borders.SEAMLESS,
        label="Borders",
        help="What lookups interpolate with near a face's border",
        choices={
            Borders.SEAMLESS: Choice("Seamless", "the neighbouring face's texels"),
            Borders.CLAMPED: Choice("Clamped", "the face's own texels, as the hardware of 2004"),
        },
    )
    antialiased: bool = antialiased_option("glossy light")
    room: Room = option(
        Room.DISTANT,
        label="Room",
        help="What the surroundings are",
        choices=ROOMS,
        advanced=True,
    )
    room_size: tuple[float, float, float] = room_size_option(advanced=True)
    room_middle: tuple[float, float, float] = room_middle_option(advanced=True)
    captured_at: tuple[float, float, float] = point_option(
        "Captured At", "Where the map was captured", advanced=True
    )

    @property
    def place(self) -> Place:
        """Where the map was captured, and its room."""
        return Place(self.captured_at, self.room, self.room_size, self.room_middle)

    def level(self, lobes: MipLobes) -> float:
        """The level of detail to look glossy light up at.

        Returns
        -------
        float
            In [0, mips - 1].

        Raises
        ------
        RangeError
            See `MipLobes.level_of_roughness`.

        Notes
        -----
        Hardware adds b to the level that a pixel's footprint asks for. Here a mip means a material at any
        distance, and lookups are averaged over the region that a pixel reflects: see `glossy_mean`.
        """
        if self.exponent is not None:
            return lobes.level_of_exponent(self.exponent)
        if self.roughness is not None:
            return lobes.level_of_roughness(self.roughness)
        return min(self.mip, lobes.count - 1.0)

    def diffuse_level(self, lobes: MipLobes) -> float:
        """The level of detail to look up the lobes of `near_diffuse` at; 0 without diffuse reflection.

        Raises
        ------
        RangeError
            See `MipLobes.level_of_exponent`.
        """
        return lobes.level_of_exponent(EXPONENT) if any(self.kd) else 0.0


def mip_chain_radiance(
    chain: MipChain,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: MipLook,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
    position: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points, not negative: [Kautz2004] Eq. 8.

    Parameters and result are those of every kind's shading, see `core.kinds`, and

    Parameters
    ----------
    position : array_like, shape (..., 3), optional
        The points, in world coordinates; a look with a room and a chain with probes need them. Without them
        there is neither.

    Raises
    ------
    RangeError
        See `MipLook.level` and `MipLook.diffuse_level`.

    Notes
    -----
    GLSL twin: gpu_shaders/mip_chain_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    seen = seen_surface(normal, view_dir, facet)
    cosine = np.clip(dot(seen.mirror_normal, view_dir), 0.0, 1.0)
    fresnel = fresnel_schlick(cosine[..., None], look.f0)
    mirror_dir = reflect(view_dir, seen.mirror_normal)
    corners = footprint_or_point(mirror_footprint if look.antialiased else None, mirror_dir)
    level, lights = look.level(chain.lobes), [(chain, look.place)]
    of_lights: tuple[Array, ...] = (np.ones(()),)
    if position is None:
        position, lights = np.zeros(3), [(chain, replace(look.place, room=Room.DISTANT))]
    else:
        lights += [(replace(chain, mips=probe.mips), probe.place) for probe in chain.probes]
        of_lights = shares([probe.place for probe in chain.probes], position)
    shaded = np.zeros(normal.shape)
    for (light, place), share in zip(lights, of_lights, strict=True):
        if place.room is Room.DISTANT:
            diffuse = diffuse_radiance(light, seen.normal, look.kd)
        else:
            diffuse = near_diffuse_radiance(light, place, position, seen.normal, look)
        towards = place.near_direction(position, mirror_dir)
        seen_there = place.near_direction(np.asarray(position)[..., None, :], corners)
        glossy = glossy_mean(light, towards, seen_there, level, look.borders)
        shaded += share[..., None] * ((1.0 - fresnel) * diffuse + fresnel * glossy)
    return shaded


def diffuse_radiance(chain: MipChain, normal: ArrayLike, kd: ArrayLike) -> Array:
    """Light that a Lambertian surface reflects: [Kautz2004] Eq. 12.

    Parameters
    ----------
    chain : MipChain
    normal : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    kd : array_like, shape (3,)
        Albedo.

    Returns
    -------
    ndarray, shape (..., 3), float64
        0 where the harmonics are negative, opposite a strong light.
    """
    irradiance = irradiance_from_harmonics(chain.harmonics, normal)
    radiance: Array = np.asarray(kd) / np.pi * np.maximum(irradiance, 0.0)
    return radiance


def near_diffuse_radiance(
    chain: MipChain, place: Place, position: ArrayLike, normal: Array, look: MipLook
) -> Array:
    """Light that a Lambertian surface reflects in a near room.

    Parameters
    ----------
    chain : MipChain
    place : Place
        Where it was captured, and the room.
    position, normal : array_like, shape (..., 3)
        Of the points, in world coordinates; unit vectors.
    look : MipLook

    Returns
    -------
    ndarray, shape (..., 3), float64

    Raises
    ------
    RangeError
        See `MipLook.diffuse_level`.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/near_diffuse_lib.glsl `near_diffuse`.
    """
    level = look.diffuse_level(chain.lobes)
    light = np.zeros(normal.shape)
    for towards, share in cosine_lobes(normal):
        direction = place.near_direction(position, towards)
        light += share * glossy_radiance(chain, direction, level, Borders.SEAMLESS)
    return np.asarray(look.kd) * light


def glossy_mean(
    chain: MipChain, mirror_dir: ArrayLike, corners: ArrayLike, level: float, borders: Borders
) -> Array:
    """Light of a level, averaged over pixels' footprints.

    Parameters
    ----------
    chain : MipChain
    mirror_dir : array_like, shape (..., 3)
        Unit directions that the pixels' middles reflect.
    corners : array_like, shape (..., 4, 3)
        The pixels' footprints.
    level : float
        In [0, mips - 1].
    borders : Borders

    Returns
    -------
    ndarray, shape (..., 3), float64

    Notes
    -----
    Up to `sampling.MOST` lookups along each side of a pixel, a texel of that level apart. Where these do not
    suffice, they use a mip whose texels are as far apart as the lookups, so that no light is missed however
    large the footprint is. GLSL twin: gpu_shaders/lib/mip_chain_lib.glsl `glossy_mean`.
    """
    mirror_dir = np.asarray(mirror_dir, dtype=np.float64)
    across, up = footprint_sides(np.asarray(corners, dtype=np.float64))
    texel = 2.0**level * cube_map.texel_angle(mirror_dir, chain.size)
    counts = sample_counts(across, up, texel)
    apart = np.linalg.norm(np.stack([across, up], axis=-2), axis=-1) / counts
    missed = np.log2(np.maximum(np.max(apart, axis=-1) / texel, 1.0))
    levels = np.minimum(level + missed, len(chain.mips) - 1.0)
    mean = np.zeros(mirror_dir.shape)
    for chosen, direction, weight in samples(mirror_dir, across, up, counts):
        mean[chosen] += weight * glossy_radiance(chain, direction, levels[chosen], borders)
    return mean


def glossy_radiance(chain: MipChain, direction: ArrayLike, level: ArrayLike, borders: Borders) -> Array:
    """Light of a mip, or of two neighbouring mips, linear between them: as `glossy_mean`, for points.

    Parameters
    ----------
    chain : MipChain
    direction : array_like, shape (..., 3)
        Unit vectors.
    level : array_like, shape (...,)
        In [0, mips - 1].
    borders : Borders

    Returns
    -------
    ndarray, shape (..., 3), float64

    Notes
    -----
    GLSL twin: gpu_shaders/lib/mip_chain_lib.glsl `glossy_radiance`; hardware may round the weights of
    texels to 1/256.
    """
    direction = np.asarray(direction, dtype=np.float64)
    level = np.broadcast_to(level, direction.shape[:-1])
    light = np.zeros(direction.shape)
    for mip, faces in enumerate(chain.mips):
        share = np.maximum(1.0 - np.abs(level - mip), 0.0)
        counts = share > 0.0
        light[counts] += share[counts][:, None] * _mip_radiance(faces, direction[counts], borders)
    return light


def _mip_radiance(faces: Array, direction: ArrayLike, borders: Borders) -> Array:
    if borders is Borders.SEAMLESS:
        return lookup(faces, direction, _CUBE)
    uv, face = cube_map.uv_from_direction(direction)
    half = 0.5 / faces.shape[1]
    # Half a texel inside, interpolation ends at the face's last texel centres and needs no neighbour.
    inside = np.clip(uv, half, 1.0 - half)
    return bilinear(faces, inside, clamp_to_edge, layer=face)
