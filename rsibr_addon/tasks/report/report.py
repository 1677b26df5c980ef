"""A map set as one HTML file that needs nothing beside it."""

import base64
from collections.abc import Mapping
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ...core.brdf.model import Brdf
from ...core.conventions import Array
from ...core.errors import DeviceError, RsibrError
from ...core.geometry.camera import Camera
from ...core.pictures.thumbnail import thumbnail
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...device.preview import PreviewRenderer
from ...files.apart import check_apart
from ...files.atomic import check_target, written_aside
from ...files.folders import check_folder_target, folder_written_aside
from ...files.kinds.registry import STORED, look_types
from ...files.map_set import read_map_set
from ...files.map_set_data import MapSet
from ...files.map_set_facts import in_words, told_errors, told_facts, told_making
from ...files.output_paths import portable_name
from ...files.outputs import together
from ...files.pictures import put_exr
from ...files.temporary import temporary_folder
from ...host.meshes import load_mesh
from ...host.pictures import save_png
from ..compare.measured_error import measured_facts
from ..methods.kinds import KINDS, OpenedMapSet, open_map_set
from ..reflectance.brdfs import load_brdf, told_brdf
from ..reflectance.fit_plots import ELEVATIONS, lobe_plot
from .facts import map_set_fit, map_set_header

TEMPLATE = Path(__file__).with_suffix(".html")

MESH_SIZE = 288
"""Width and height of the pictures of a sphere and of Suzanne, in pixels."""

MAP_SIZE = 160
"""Largest width and height of a map's picture, in pixels."""

LOBES = (
    '<h2>Lobes</h2><p class="faint">BRDF times cosine in the plane of incidence, in the green channel; the '
    "eye is to the left. The dashed line is the sum of the lobes.</p>"
)

MESHES = {"sphere": Camera((0.3, -1.0, 0.3)), "monkey": Camera((0.3, -1.0, 0.3))}
"""Mesh -> from where it is shown."""


def map_set_report(
    map_set: Path, output: Path, force: bool = False, brdf: str | None = None, maps: Path | None = None
) -> Steps[Path]:
    """Show all that a map set holds, in NAME.html, without scripts and links.

    Parameters
    ----------
    brdf : str, optional
        The model to plot beside a lobe stack's lobes, as `tasks.reflectance.brdfs.load_brdf` takes it; by
        default the map set's own, unless that is in another file or takes to be measured.
    maps : Path, optional
        A folder in which each map is written too, at its full size: PART.exr, by the names of the file's
        parts. A new one, or one with this map set's earlier maps.

    Raises
    ------
    MapSetError, OutputFileError
    RsibrError
        See `load_brdf`, of `brdf` alone: where the map set's own model is none, the report says so.

    Warns
    -----
    RsibrWarning
        Nothing can draw, so the pictures of meshes are left out.
    """
    check_target(output, force, (".html",))
    yield Progress(0, 3, f"reading {map_set.name}")
    held = read_map_set(map_set)
    if maps is not None:
        check_folder_target(maps, _map_file(held.header["parts"][0]), force)
        check_apart(maps, [map_set])
    yield Progress(1, 3, "drawing with it")
    opened = open_map_set(map_set)
    meshes = _drawn_meshes(opened)
    truth = None if brdf is None else (yield from load_brdf(brdf))
    yield Progress(2, 3, "drawing its maps")
    header = map_set_header(map_set)
    facts = told_facts(header)
    text = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(" in ".join(facts[what] for what in ("Material", "Light") if what in facts)),
        kind=escape(facts["Kind"]),
        file=escape(map_set.name),
        meshes="\n".join(_image(picture, f"a {mesh}") for mesh, picture in meshes.items()),
        bound=_definitions(told_errors(header)),
        measured=_definitions(measured_facts(map_set) or {"Nothing": "it has not been compared yet"}),
        lobes="\n".join(_lobes(map_set, truth)),
        figure="\n".join(_figure(opened)),
        facts=_definitions(facts | told_making(header)),
        roles="\n".join(_roles(held)),
    )
    with together():
        if maps is not None:
            _write_maps(maps, held, force)
        with written_aside(output, force) as aside:
            aside.write_text(text, encoding="utf-8", errors="replace")  # of names that are no UTF-8
    return output


def _write_maps(folder: Path, held: MapSet, force: bool) -> None:
    parts = held.header["parts"]
    with folder_written_aside(folder, _map_file(parts[0]), force) as aside:
        for part in parts:
            put_exr(aside / _map_file(part), _opaque(held.maps[part["name"]]))


def _map_file(part: dict[str, Any]) -> str:
    return f"{portable_name(part['name'])}.exr"


def _drawn_meshes(opened: OpenedMapSet) -> dict[str, Array]:
    """Meshes shaded from the map set; none where nothing can draw them, which a warning tells."""
    try:
        renderer, look = PreviewRenderer(opened.drawable()), look_types()[opened.kind]()
    except DeviceError as error:
        warn(f"The report shows no mesh: {error}")
        return {}
    pictures = {}
    for name, camera in MESHES.items():
        mesh = load_mesh(name)
        pictures[name] = renderer.draw(mesh.positions, mesh.normals, mesh.triangles, camera, MESH_SIZE, look)
    return pictures


def _lobes(map_set: Path, truth: Brdf | None) -> list[str]:
    """Plots of the lobes, where the map set tells them."""
    fit = map_set_fit(map_set)
    if fit is None:
        return []
    missing = ""
    if truth is None:
        try:
            truth = told_brdf(fit.brdf)
        except RsibrError as error:
            missing = f'<p class="faint">The BRDF is not shown. {escape(str(error))}</p>'
    plots = [lobe_plot(fit, truth, mu) for mu in ELEVATIONS]
    images = (_embedded("image/svg+xml", plot.encode("utf-8", "replace"), "lobes") for plot in plots)
    return [LOBES, missing, '<div class="plots">', *images, "</div>"]


def _figure(opened: OpenedMapSet) -> list[str]:
    """How the map set is shaded, where its kind has pictures of that."""
    make = KINDS[opened.kind].figure
    if make is None:
        return []
    figure = make(opened.content)
    pictures = [
        f"<figure>{_image(picture, caption)}<figcaption>{escape(caption)}</figcaption></figure>"
        for caption, picture in figure.pictures.items()
    ]
    text = f'<h2>{escape(figure.title)}</h2><p class="faint">{escape(figure.text)}</p>'
    return [text, '<div class="maps">', *pictures, "</div>"]


def _definitions(facts: Mapping[str, str]) -> str:
    return "\n".join(f"<dt>{escape(what)}</dt><dd>{escape(which)}</dd>" for what, which in facts.items())


def _roles(held: MapSet) -> list[str]:
    """A block of pictures for each role, in the file's order."""
    blocks, title = [], STORED[held.kind].part_title
    for role in dict.fromkeys(part["role"] for part in held.header["parts"]):
        figures = "".join(
            f"<figure>{_image(_opaque(thumbnail(held.maps[part['name']], MAP_SIZE)), part['name'])}"
            f"<figcaption>{escape(title(part))}</figcaption></figure>"
            for part in held.header["parts"]
            if part["role"] == role
        )
        blocks.append(f'<h3>{escape(in_words(role))}</h3><div class="maps">{figures}</div>')
    return blocks


def _opaque(radiance: Array) -> Array:
    return np.concatenate([radiance, np.ones((*radiance.shape[:2], 1))], axis=-1)


def _image(rgba: Array, description: str) -> str:
    with temporary_folder() as folder:
        path = folder / "picture.png"
        save_png(path, rgba)
        return _embedded("image/png", path.read_bytes(), description)


def _embedded(kind: str, data: bytes, description: str) -> str:
    source = f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"
    return f'<img alt="{escape(description)}" src="{source}">'
