"""A display's view transform as a table, from radiance to the colour on screen.

Only Blender can compute its view transforms. It is asked once for the colours at the table's nodes; between
nodes the table is interpolated.
"""

import numpy as np

from ..conventions import Array, ArrayLike

TABLE_SIZE = 96
"""Nodes along each axis."""

NODES_PER_STOP = 5.0
"""Nodes for each doubling of radiance."""

NODE_OF_ONE = 55.0
"""The node of radiance 1, where most view transforms begin to clip: a kink between nodes would be rounded."""

KNEE = NODES_PER_STOP / np.log(2.0)
"""Below this node radiance is proportional to its number, above exponential; smooth where they meet."""

KNEE_RADIANCE = float(2.0 ** ((KNEE - NODE_OF_ONE) / NODES_PER_STOP))


def node_radiance(node: ArrayLike) -> Array:
    """The radiance of a node.

    Parameters
    ----------
    node : array_like, any shape
        In [0, TABLE_SIZE - 1].

    Returns
    -------
    ndarray, shape of `node`, float64
        In [0, 256].
    """
    node = np.asarray(node, dtype=np.float64)
    exponential = 2.0 ** ((node - NODE_OF_ONE) / NODES_PER_STOP)
    return np.where(node < KNEE, KNEE_RADIANCE / KNEE * node, exponential)


def node_from_radiance(radiance: ArrayLike) -> Array:
    """The inverse of `node_radiance`; radiance outside the table gets its first or last node.

    Parameters
    ----------
    radiance : array_like, any shape

    Returns
    -------
    ndarray, shape of `radiance`, float64
        In [0, TABLE_SIZE - 1], between two nodes.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/display_lib.glsl `node_from_radiance`.
    """
    radiance = np.asarray(radiance, dtype=np.float64)
    exponential = NODE_OF_ONE + NODES_PER_STOP * np.log2(np.maximum(radiance, KNEE_RADIANCE))
    node = np.where(radiance < KNEE_RADIANCE, KNEE / KNEE_RADIANCE * radiance, exponential)
    clamped: Array = np.clip(node, 0.0, TABLE_SIZE - 1.0)
    return clamped


def table_radiance() -> Array:
    """The radiance of every node.

    Returns
    -------
    ndarray, shape (TABLE_SIZE, TABLE_SIZE, TABLE_SIZE, 3), float64
        Indexed [blue, green, red], in the order of a texture's texels.
    """
    nodes = node_radiance(np.arange(TABLE_SIZE))
    blue, green, red = np.meshgrid(nodes, nodes, nodes, indexing="ij")
    return np.stack([red, green, blue], axis=-1)


def displayed(table: Array, radiance: ArrayLike) -> Array:
    """Colours of radiance on a display.

    Parameters
    ----------
    table : ndarray, shape (TABLE_SIZE, TABLE_SIZE, TABLE_SIZE, 3)
        The display's colours, in [0, 1], at the nodes of `table_radiance`.
    radiance : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3), float64
        In [0, 1], as sent to the display.

    Notes
    -----
    Interpolated in the tetrahedron of nodes that holds the colour [Kasson1995]. So a grey lies between two
    greys, along which view transforms have their kinks; interpolation of eight nodes would mix in coloured
    ones. GLSL twin: gpu_shaders/lib/display_lib.glsl `displayed`.
    """
    place = node_from_radiance(radiance)
    corner = np.minimum(place.astype(np.intp), TABLE_SIZE - 2)
    part = place - corner
    axes = np.argsort(-part, axis=-1, kind="stable")
    shares = -np.diff(np.take_along_axis(part, axes, axis=-1), axis=-1, prepend=1.0, append=0.0)
    colour: Array = np.zeros(place.shape)
    for step in range(4):
        red, green, blue = np.moveaxis(corner, -1, 0)
        colour += shares[..., step, None] * table[blue, green, red]
        if step < 3:  # On to the next corner of the tetrahedron, along the axis of the next largest part.
            corner = corner + (np.arange(3) == axes[..., step, None])
    return colour
