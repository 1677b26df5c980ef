"""What mypy is told of Blender's types is so."""

import ast
from pathlib import Path

import bpy

TOLD = Path(__file__).parents[2] / ".ci" / "types" / "bpy" / "types.pyi"

CLASSES = [
    node
    for node in ast.parse(TOLD.read_text()).body
    if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
]


def test_blender_has_these_types_in_this_order_of_rank() -> None:
    assert {"Object", "PropertyGroup"} <= {told.name for told in CLASSES}
    for told in CLASSES:
        blenders = getattr(bpy.types, told.name)
        for base in map(ast.unparse, told.bases):
            assert base.startswith("_") or issubclass(blenders, getattr(bpy.types, base)), told.name
