"""Meshes of fewer triangles: near the whole, closed as it is, and no hair is lost."""

import numpy as np
from rsibr.rsibr_addon.core.conventions import Array, Indices
from rsibr.rsibr_addon.core.geometry.coarser_mesh import coarser_mesh

CELL = 1.0 / 10.0


def torus(radius: float, steps: int = 60) -> tuple[Array, Indices]:
    """A closed surface: a ring of radius 0.6 about Z, as thick as is said."""
    around, across = np.mgrid[:steps, :steps]
    phi, theta = 2.0 * np.pi * around / steps, 2.0 * np.pi * across / steps
    out = 0.6 + radius * np.cos(theta)
    positions = np.stack([out * np.cos(phi), out * np.sin(phi), radius * np.sin(theta)], axis=-1)
    next_around, next_across = steps * ((around + 1) % steps), (across + 1) % steps
    here, ahead = steps * around + across, next_around + across
    beside, opposite = steps * around + next_across, next_around + next_across
    halves = ([here, ahead, opposite], [here, opposite, beside])
    triangles = np.concatenate([np.stack(half, axis=-1).reshape(-1, 3) for half in halves])
    return positions.reshape(-1, 3).astype(np.float32), triangles.astype(np.int32)


def test_a_fine_mesh_becomes_coarse_and_stays_where_it_is() -> None:
    positions, triangles = torus(0.3)
    coarse, few = coarser_mesh(positions, triangles, CELL)
    assert len(few) < len(triangles) / 3
    distance = np.linalg.norm(positions[:, None] - coarse[None], axis=-1).min(axis=1)
    assert distance.max() < np.sqrt(3.0) * CELL
    # No edge is open, so that light finds no hole
    edges = np.sort(np.concatenate([few[:, [0, 1]], few[:, [1, 2]], few[:, [0, 2]]]), axis=1)
    assert np.unique(edges, axis=0, return_counts=True)[1].min() == 2


def test_what_is_thinner_than_a_cell_stays_whole() -> None:
    positions, triangles = torus(0.1 * CELL)
    same, all_of_them = coarser_mesh(positions, triangles, CELL)
    assert same is positions
    assert all_of_them is triangles


def test_a_coarse_mesh_stays_as_it_is() -> None:
    positions, triangles = torus(0.3, steps=8)
    assert coarser_mesh(positions, triangles, CELL)[1] is triangles


def test_a_mesh_without_triangles_stays_as_it_is() -> None:
    positions, none = np.zeros((3, 3), np.float32), np.empty((0, 3), np.int32)
    assert coarser_mesh(positions, none, CELL)[1] is none
