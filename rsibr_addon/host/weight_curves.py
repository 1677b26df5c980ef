"""Curves of weights over the cosine between normal and view, as Blender's widget edits them.

No property of an extension can be a curve; nodes have them. So a hidden node group holds one node for each.
"""

from collections.abc import Iterable

import bpy
import numpy as np

from ..core.brdf.spec import key_values
from ..core.curves import curve_points
from ..core.errors import RangeError

SAMPLES = 65
"""Cosines at which a curve is read; between them it is straight."""

_STRAIGHT = 5e-5
"""Bend of a curve at a sample, below which the text leaves it out."""


def new_tree(names: Iterable[str], text: str) -> bpy.types.NodeTree:
    """A hidden node group with curves of these names, as a text says them: see `draw`."""
    tree: bpy.types.NodeTree = bpy.data.node_groups.new(".RSIBR Weights", "ShaderNodeTree")
    for name in names:
        tree.nodes.new("ShaderNodeFloatCurve").name = name
    draw(tree, text)
    return tree


def draw(tree: bpy.types.NodeTree, text: str) -> None:
    """Draw the curves that a text says.

    Parameters
    ----------
    tree : bpy.types.NodeTree
        Of `new_tree`.
    text : str
        ``NAME=COSINE:VALUE/...,NAME=...``; curves that it does not say are 1.
    """
    try:
        said = key_values(text)
    except RangeError:  # of another model
        said = {}
    for node in tree.nodes:
        _draw(node.mapping, said.get(node.name, "0:1"))


def text(tree: bpy.types.NodeTree) -> str:
    """The text of curves, which `new_tree` takes back."""
    return ",".join(f"{node.name}={_said(node.mapping)}" for node in tree.nodes)


def _draw(mapping: bpy.types.CurveMapping, points: str) -> None:
    try:
        cosines, values = curve_points(points).T
    except RangeError:
        cosines, values = np.array([0.0]), np.array([1.0])
    if len(cosines) == 1:
        cosines, values = np.array([0.0, 1.0]), np.repeat(values, 2)
    mapping.extend = "HORIZONTAL"
    mapping.clip_max_y = max(1.0, float(values.max()))
    curve = mapping.curves[0]
    while len(curve.points) > len(cosines):
        curve.points.remove(curve.points[1])
    while len(curve.points) < len(cosines):
        curve.points.new(0.5, 0.5)
    for point, cosine, value in zip(curve.points, cosines, values, strict=True):
        point.location = (cosine, value)
        point.handle_type = "VECTOR"
    mapping.update()


def _said(mapping: bpy.types.CurveMapping) -> str:
    mapping.initialize()
    cosines = np.linspace(0.0, 1.0, SAMPLES)
    values = [max(mapping.evaluate(mapping.curves[0], cosine), 0.0) for cosine in cosines]
    bends = np.abs(np.diff(values, 2))
    kept = [True, *(bends > _STRAIGHT), True]
    points = zip(cosines, values, kept, strict=True)
    return "/".join(f"{cosine:.5g}:{value:.5g}" for cosine, value, keep in points if keep)
