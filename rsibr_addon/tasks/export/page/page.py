"""A web page that shades a mesh from a map set: orbit, exposure, and the look's options as sliders.

It shades with the extension's own shaders (`sources.py`), from the same numbers and textures.
"""

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ....core.conventions import Array
from ....core.errors import RangeError
from ....core.options import declared_options
from ....core.progress import Progress, Steps
from ....device.drawing import Inputs, WithInputs, WithSplitSum
from ....files.atomic import check_target, written_aside
from ....files.kinds.environment import is_environment
from ....files.kinds.registry import look_types
from ....files.map_set_facts import in_words, told_errors, told_facts
from ....files.packed_arrays import packed_bytes
from ....host.meshes import TriangleMesh
from ....settings.page import PageOptions
from ...methods.kinds import KINDS, OpenedMapSet, open_map_set, opened_map_set
from .contents import packed_display, packed_texture
from .matte import packed_matte
from .meshes import in_order_of_use, packed_mesh
from .own_objects import OwnObject, packed_objects, world_positions
from .parameters import block_of, parameters
from .sources import matte_sources, own_sources, page_sources

FOLDER = Path(__file__).parent
SCRIPTS = ("unpack.js", "mesh.js", "camera.js", "picture.js", "panel.js", "main.js")
"""What a page runs, in this order."""

MATTE_SCRIPT = "matte.js"
"""What one runs before, if something lies behind its objects."""

FILL = 0.92
"""Share of the frame's width that the object has at first, as in `rsibr preview --fill`."""


def export_page(
    map_set: Path,
    output: Path,
    settings: PageOptions,
    shown: TriangleMesh | Sequence[OwnObject],
    look: Any = None,
    force: bool = False,
) -> Steps[list[Path]]:
    """Write one page that needs no other file and no network.

    Parameters
    ----------
    map_set : Path
        A map set, or a picture of an environment.
    output : Path
        NAME.html.
    shown : TriangleMesh or sequence of OwnObject
        A mesh in world coordinates, within the unit sphere; or at least one object in its own materials, of a
        kind whose look has `own`.
    look : Options, optional
        What the page shows at first: see `files.kinds.registry.look_types`; by default the kind's best.

    Returns
    -------
    list of Path
        `output`.

    Raises
    ------
    MapSetError, InputFileError, OutputFileError
    RangeError
        Nothing of this kind can be shown on a page, or the mesh is too large.
    """
    check_target(output, force, (".html",))
    yield Progress(0, 4, f"reading {map_set.name}")
    opened, look = yield from _opened(map_set, settings, look)
    drawable = opened.drawable()
    if not isinstance(drawable, WithInputs):
        raise RangeError(
            f"{map_set} is a {in_words(opened.kind).lower()}, which no page shows yet: preview it."
        )
    yield Progress(1, 4, "packing its maps")
    inputs = drawable.inputs(look)
    textures, error = _packed_textures(inputs)
    yield Progress(2, 4, "packing the mesh and the display")
    title, sentence = _told(map_set, opened, error)
    camera = settings.camera(settings.view)
    matte = packed_matte(settings, opened.environment, _positions(shown))
    programs = page_sources(inputs.program) | (matte_sources() if matte else {})
    if isinstance(shown, TriangleMesh):
        objects = _one_object(shown, block_of(inputs))
        sliders = [] if KINDS[opened.kind].live else parameters(drawable, look)
    else:
        objects, sliders = packed_objects(shown, look.antialiased), []
        programs |= own_sources(inputs.program)
    content = {
        "programs": packed_bytes(json.dumps(programs).encode()),
        "parameters": sliders,
        "textures": textures,
        "split": _packed_split_sum(drawable, inputs),
        **objects,
        "matte": matte,
        "fill": FILL,
        "displays": {name: packed_display(name) for name in _view_transforms()},
        "display": settings.view_transform,
        "exposure": settings.exposure,
        "view": camera.view_dir,
        "angle": camera.field_of_view,
    }
    yield Progress(3, 4, f"writing {output.name}")
    text = _page(title, in_words(opened.kind), sentence, content)
    with written_aside(output, force) as aside:
        aside.write_text(text, encoding="utf-8", errors="replace")  # of names that are no UTF-8
    return [output]


def _opened(map_set: Path, settings: PageOptions, look: Any) -> Steps[tuple[OpenedMapSet, Any]]:
    """What a page's sliders need of a map set, and the look that it shows at first."""
    opened = open_map_set(map_set, clamp=settings.clamp)
    look = look or look_types()[opened.kind]()
    by_sliders = KINDS[opened.kind].by_sliders
    if by_sliders is not None and opened.environment is not None:
        found = yield from by_sliders(opened.environment, look)
        if found is not None:
            in_memory, look = found
            opened = opened_map_set(map_set, in_memory)
    return opened, look


def _page(title: str, kind: str, told: str, content: dict[str, Any]) -> str:
    """The page's HTML, with all that it runs and shows."""
    scripts = (MATTE_SCRIPT, *SCRIPTS) if content["matte"] else SCRIPTS
    return Template((FOLDER / "page.html").read_text(encoding="utf-8")).substitute(
        title=escape(title),
        kind=escape(kind),
        told=escape(told),
        style=(FOLDER / "page.css").read_text(encoding="utf-8"),
        content=json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        script="".join(map(_script, scripts)),
    )


def _positions(shown: TriangleMesh | Sequence[OwnObject]) -> Array:
    """All vertices in the world, shape (V, 3)."""
    if isinstance(shown, TriangleMesh):
        return shown.positions
    return world_positions(shown)


def _script(name: str) -> str:
    """A script without comments and the spaces before lines, which a page has no room for."""
    return re.sub(r"^ *(//.*)?\n?", "", (FOLDER / name).read_text(encoding="utf-8"), flags=re.MULTILINE)


def _one_object(mesh: TriangleMesh, block: Array) -> dict[str, Any]:
    """A mesh within the unit sphere, of one material all over: see `packed_objects`."""
    order, triangles = in_order_of_use(mesh.triangles)
    used = replace(mesh, positions=mesh.positions[order], normals=mesh.normals[order], triangles=triangles)
    shown = {
        "mesh": packed_mesh(used),
        "model": np.eye(4).ravel().tolist(),
        "slots": [[0, mesh.triangles.size, 0]],
    }
    material = {"block": block.tolist(), "images": [], "opaque": True}
    fit = [0.0, 0.0, 0.0, 1.0]
    return {"objects": [shown], "materials": [material], "images": [], "most_images": 0, "fit": fit}


def _packed_textures(inputs: Inputs) -> tuple[dict[str, Any], float]:
    """Each sampler's texture, and the largest error of those that are rounded."""
    packed, errors = {}, [0.0]
    for name, texture in inputs.textures.items():
        kind = inputs.program.samplers[name]
        if name in inputs.sums:
            summed, unit = inputs.sums[name]
            packed[name] = {"type": kind, "summed": summed, "unit": unit.tolist(), "half": False}
            continue
        said, error = packed_texture(texture, inputs.exact_from.get(name))
        packed[name] = {"type": kind, **said}
        errors.append(error)
    return packed, max(errors)


def _packed_split_sum(drawable: WithInputs, inputs: Inputs) -> dict[str, Any]:
    """What takes the place of textures for the split sum; nothing where the kind has none."""
    if not isinstance(drawable, WithSplitSum):
        return {}
    packed = {}
    for name, texture in drawable.split_sum().items():
        said, _ = packed_texture(texture, inputs.exact_from.get(name))
        packed[name] = {"type": inputs.program.samplers[name], **said}
    return packed


def _told(map_set: Path, opened: OpenedMapSet, error: float) -> tuple[str, str]:
    """What the page shows, and what is said of its errors."""
    rounding = "This page has its maps as they are."
    if error:
        rounding = f"This page rounds its maps by {error:.1g} of themselves (root mean square)."
    if is_environment(map_set):
        return in_words(map_set.stem), rounding
    header = opened.header
    facts = told_facts(header)
    title = " in ".join(facts[what] for what in ("Material", "Light") if what in facts)
    bounds = [f"{name.removeprefix('Error, ')} {bound}" for name, bound in told_errors(header).items()]
    some = f"The map set states errors: {', '.join(bounds)}. "
    stated = some if header["error_bound"] else "The map set states no error. "
    return title, stated + rounding


def _view_transforms() -> list[str]:
    option = next(each for each in declared_options(PageOptions) if each.name == "view_transform").option
    return list(option.choices)
