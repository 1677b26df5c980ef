"""A map set as one HTML page that needs nothing beside it."""

import base64
import tempfile
from collections.abc import Mapping
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ..core.camera import Camera
from ..core.conventions import Array
from ..core.errors import OutputFileError
from ..core.progress import Progress, Steps
from ..device.preview import PreviewRenderer
from ..files.atomic import check_target, written_aside
from ..files.map_set import read_map_set
from ..host.meshes import load_mesh
from ..host.pictures import save_png
from .kinds import KINDS, open_map_set

TEMPLATE = Path(__file__).with_suffix(".html")

LOOK_SIZE = 288
"""Of the pictures of a sphere and of Suzanne, in pixels."""

MAP_SIZE = 160
"""Largest width and height of a map's picture, in pixels."""

LOOKS = {"sphere": Camera((0.3, -1.0, 0.3)), "monkey": Camera((0.3, -1.0, 0.3))}
"""Mesh -> from where it is shown."""


def page_beside(map_set: Path) -> Path:
    """Where the page of a map set goes unless one says otherwise: NAME.html beside NAME.rsibr.exr."""
    return map_set.with_name(f"{map_set.name.removesuffix('.exr').removesuffix('.rsibr')}.html")


def map_set_page(map_set: Path, output: Path, force: bool = False) -> Steps[Path]:
    """Show all that a map set holds.

    Parameters
    ----------
    map_set : Path
    output : Path
        NAME.html, without scripts and links.
    force : bool
        Whether an existing file is replaced.

    Yields
    ------
    Progress

    Returns
    -------
    Path
        `output`.

    Raises
    ------
    MapSetError, OutputFileError, DeviceError
    """
    if output.suffix.lower() != ".html":
        raise OutputFileError(f"{output} would not open in a browser: give a name that ends in .html.")
    check_target(output, force)
    yield Progress(0, 3, f"reading {map_set.name}")
    held = read_map_set(map_set)
    yield Progress(1, 3, "drawing with it")
    looks = _looks(map_set)
    yield Progress(2, 3, "drawing its maps")
    header = held.header
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(_title(header)),
        kind=escape(held.kind.replace("_", " ").capitalize()),
        file=escape(map_set.name),
        looks="\n".join(_image(picture, f"a {mesh}") for mesh, picture in looks.items()),
        bound=_definitions(header["error_bound"] or {"nothing": "its maker stated no error"}),
        facts=_definitions(_facts(header)),
        roles="\n".join(_roles(header["parts"], held.maps)),
    )
    with written_aside(output, force) as aside:
        aside.write_text(page, encoding="utf-8")
    return output


def _looks(map_set: Path) -> dict[str, Array]:
    opened = open_map_set(map_set)
    renderer, look = PreviewRenderer(opened.upload()), KINDS[opened.kind].look()
    pictures = {}
    for name, camera in LOOKS.items():
        mesh = load_mesh(name)
        pictures[name] = renderer.draw(mesh.positions, mesh.normals, mesh.triangles, camera, LOOK_SIZE, look)
    return pictures


def _title(header: Mapping[str, Any]) -> str:
    material = header["material"]
    name = material.get("name") or material.get("brdf")
    environment = Path(header["environment"]["name"]).stem
    return f"{name} in {environment}" if name else environment


def _facts(header: Mapping[str, Any]) -> dict[str, Any]:
    width, height = header["environment"]["size"]
    return {
        **{f"material: {name}": value for name, value in header["material"].items()},
        "environment": f"{header['environment']['name']}, {width}x{height}",
        "layout": header["layout"],
        "size of a map": "{}x{}".format(*header["size"]),
        "axes": header["axes"],
        **header["settings"],
        "software": header["software"],
    }


def _definitions(facts: Mapping[str, Any]) -> str:
    return "\n".join(
        f"<dt>{escape(name)}</dt><dd>{escape(_words(value))}</dd>" for name, value in facts.items()
    )


def _words(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3g}"
    if isinstance(value, list):
        return ", ".join(map(_words, value))
    return str(value)


def _roles(parts: list[dict[str, Any]], maps: Mapping[str, Array]) -> list[str]:
    """A block of pictures for each role, in the file's order."""
    blocks = []
    for role in dict.fromkeys(part["role"] for part in parts):
        figures = "".join(
            f"<figure>{_image(_opaque(maps[part['name']]), part['name'])}"
            f"<figcaption>{escape(_caption(part))}</figcaption></figure>"
            for part in parts
            if part["role"] == role
        )
        blocks.append(f'<h3>{escape(role)}</h3><div class="maps">{figures}</div>')
    return blocks


def _caption(part: Mapping[str, Any]) -> str:
    known = ("role", "sha256")
    return "; ".join(
        _words(value) if name == "name" else f"{name} {_words(value)}"
        for name, value in part.items()
        if name not in known
    )


def _opaque(radiance: Array) -> Array:
    """A map as a picture, made smaller by means of whole blocks of texels."""
    height, width = radiance.shape[:2]
    step = -(-max(height, width) // MAP_SIZE)
    rows, columns = max(height // step, 1), max(width // step, 1)
    down, across = min(step, height), min(step, width)
    blocks = radiance[: rows * down, : columns * across].reshape(rows, down, columns, across, 3)
    small = blocks.mean(axis=(1, 3), dtype=np.float64)
    return np.concatenate([small, np.ones((rows, columns, 1))], axis=-1)


def _image(rgba: Array, description: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        save_png(path, rgba)
        data = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<img alt="{escape(description)}" src="data:image/png;base64,{data}">'
