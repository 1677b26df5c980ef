"""A small lamp on a wrinkled mirror ball, as each kind of map set shows it while the lamp moves."""

from collections.abc import Callable
from functools import partial

import numpy as np
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_or_point
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, mirror_normal, normalize, reflect
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook, stack_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack, stack_representation
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, glossy_mean
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import filtered_mips, tent_halved
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import (
    destination_by_texel,
    destination_lookup,
    views_fragment,
)
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.tests.bumpy_sphere import EYE, footprints, supersampled

TEXELS = 64
"""Of a cube's face; other maps have as many over the sphere, or some more."""

WRINKLES = 0.1
LAMP = 0.03
"""Radius of the lamp: about a texel."""

Shade = Callable[[np.ndarray, np.ndarray | None], np.ndarray]
"""Mirror directions, and footprints or None, to radiance."""


def lamp(direction: np.ndarray, frame: int) -> np.ndarray:
    """Radiance of the lamp, with a soft edge, a quarter of a texel farther in each frame; shape (..., 3)."""
    place = normalize((0.9 + 0.25 * 2.0 / TEXELS * frame, -1.0, -0.4))
    away = np.linalg.norm(direction - place, axis=-1)
    return np.repeat(1e4 * np.clip(2.0 - 2.0 * away / LAMP, 0.0, 1.0)[..., None], 3, axis=-1).astype(
        np.float32
    )


def mip_chain(frame: int) -> Shade:
    faces = lamp(representation("cube_map").texel_directions(TEXELS), frame)
    mips = tuple(mip.astype(np.float32) for mip in filtered_mips(faces, tent_halved))
    chain = MipChain(mips, np.zeros((9, 3)))

    def shade(direction: np.ndarray, corners: np.ndarray | None) -> np.ndarray:
        return glossy_mean(chain, direction, footprint_or_point(corners, direction), 0.0, Borders.SEAMLESS)

    return shade


def lobe_stack(frame: int) -> Shade:
    maps = lamp(stack_representation("octahedral", 2 * TEXELS).texel_directions(2 * TEXELS), frame)
    ones = np.ones((1, 2, 3))
    stack = LobeStack(
        layout="octahedral",
        mu=np.array([0.5, 1.0]),
        maps=maps[None, None],
        scale=ones,
        offsets=np.zeros((1, 2, 1, 2)),
        taps=ones[..., :1],
        albedo=ones,
    )

    def shade(direction: np.ndarray, corners: np.ndarray | None) -> np.ndarray:
        return stack_radiance(stack, mirror_normal(EYE, direction), EYE, StackLook(), corners)

    return shade


def captured(frame: int) -> RadianceViews:
    """A mirror's views."""
    normals = sphere_map.normal_from_uv(texel_centres(2 * TEXELS, 2 * TEXELS))
    seen = np.stack(
        [
            lamp(reflect(np.broadcast_to(eye, normals.shape), normals @ camera_frame(eye).T), frame)
            for eye in geodesic_sphere(12).vertices
        ]
    )
    return RadianceViews(np.zeros_like(seen), seen)


def views_by_fragment(frame: int) -> Shade:
    views = captured(frame)

    def shade(direction: np.ndarray, corners: np.ndarray | None) -> np.ndarray:
        return views_fragment(views, mirror_normal(EYE, direction), EYE, Warping.SPLIT, corners)

    return shade


def views_by_texel(frame: int) -> Shade:
    destination = destination_by_texel(captured(frame), EYE, 2 * TEXELS, Warping.SPLIT)

    def shade(direction: np.ndarray, corners: np.ndarray | None) -> np.ndarray:
        return destination_lookup(
            destination, mirror_normal(EYE, direction), np.broadcast_to(EYE, direction.shape), corners
        )

    return shade


KINDS: dict[str, Callable[[int], Shade]] = {
    "mip chain": mip_chain,
    "lobe stack": lobe_stack,
    "radiance views, `fragment`": views_by_fragment,
    "radiance views, `texel`": views_by_texel,
}
"""What a kind is called -> its shading in a frame."""


def frames_of(kind: Callable[[int], Shade], size: int, count: int) -> list[dict[str, np.ndarray]]:
    """Pictures of each frame: by a lookup a pixel ("point"), "antialiased", and by 16 x 16 ("reference").

    Parameters
    ----------
    kind : callable
        Of `KINDS`.
    size : int
        Pixels along a side.
    count : int
        Of frames.

    Returns
    -------
    list of dict of str to ndarray, shape (size, size, 3)
    """
    middle, corners = footprints(size, WRINKLES, 0.0)
    pictures = []
    for frame in range(count):
        shade = kind(frame)
        pictures.append(
            {
                "reference": supersampled(partial(shade, corners=None), size, WRINKLES, 0.0),
                "point": shade(middle, None),
                "antialiased": shade(middle, corners),
            }
        )
    return pictures
