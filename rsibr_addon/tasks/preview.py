"""Pictures of a mesh shaded from a map set: one, or a turn around it."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.brdf.lobe_width import is_resolved, narrowest_alpha
from ..core.conventions import Array
from ..core.errors import MapSetError, RangeError
from ..core.geometry.camera import Camera
from ..core.geometry.directions import turn_about_z
from ..core.geometry.lit_sphere import lit_spheres
from ..core.progress import Progress, Steps
from ..core.warned import warn
from ..device.drawing import GpuMapSet
from ..device.lit_sphere import GpuLitSphere
from ..device.preview import STILL, PreviewRenderer
from ..files.apart import check_apart
from ..files.atomic import check_target, written_aside
from ..files.kinds.registry import look_types
from ..files.outputs import together
from ..files.pictures import write_exr
from ..files.temporary import temporary_folder
from ..host.meshes import TriangleMesh, load_mesh
from ..host.movies import save_movie
from ..host.pictures import save_png
from ..settings.drawing import PreviewOptions, Turned
from ..settings.matte import LIGHT
from .compare.contact_sheet import contact_sheet
from .compare.exact import rings_of
from .matte import Matte
from .methods.kinds import OpenedMapSet, open_map_set
from .reflectance.brdfs import load_brdf

SHEET_COLUMNS, SHEET_ROWS = 4, 3
"""A contact sheet shows at most so many frames, evenly spaced in time."""


def preview(
    map_set: Path, settings: PreviewOptions, output: Path, force: bool = False, look: Any = None
) -> Steps[Path]:
    """Draw one picture.

    Parameters
    ----------
    map_set : Path
        A map set of any kind.
    output : Path
        NAME.exr for linear radiance, premultiplied, with coverage in alpha; NAME.png for a picture
        through the settings' exposure and view transform.
    look : object, optional
        Look of the map set's kind, see `files.kinds.registry.look_types`; by default the kind's best.

    Raises
    ------
    RangeError
        A model itself is shown, and a look is given.
    MapSetError, InputFileError, DeviceError
        Or see `tasks.reflectance.brdfs.load_brdf`, where a model itself is shown.
    """
    _check_picture_target(output, force, _sources(map_set, settings))
    yield Progress(0, 2, f"reading {map_set.name}")
    opened = open_map_set(map_set, clamp=settings.clamp)
    if settings.exact is not None and look not in (None, look_types()[opened.kind]()):
        raise RangeError("A model itself is shown without maps: leave the options of their look out.")
    exact = None if settings.exact is None else (yield from _exact(opened, settings, settings.exact))
    draw = _Studio(opened, settings, look, exact)
    yield Progress(1, 2, f"drawing {output.name}")
    _write_picture(output, draw(settings.camera(settings.view)), settings, force)
    return output


def turntable(
    map_set: Path, settings: PreviewOptions, output: Path, force: bool = False, look: Any = None
) -> Steps[tuple[Path, Path]]:
    """Draw a turn of the eye, the object or the light about Z, as a movie and a contact sheet.

    Parameters
    ----------
    map_set : Path
        A map set of any kind.
    settings : PreviewOptions
        Has the number of frames, of which the movie shows 24 a second, and loops; its view is the first
        frame's, its size even, as H.264 demands.
    output : Path
        The contact sheet, NAME.png or NAME.exr. The movie is NAME.mp4 beside it; there, what the
        mesh does not cover is black.
    force : bool
        Whether existing files are replaced.
    look : object, optional
        See `preview`.

    Returns
    -------
    sheet, movie : Path

    Raises
    ------
    RangeError
        The size is odd, or the eye turns about the axis that it looks along.
    MapSetError, InputFileError, OutputFileError, DeviceError, RenderError
    """
    movie = output.with_suffix(".mp4")
    _check_picture_target(output, force, _sources(map_set, settings))
    check_target(movie, force)
    if settings.size % 2:
        raise RangeError(f"A movie cannot be {settings.size} pixels wide: choose an even size.")
    frame_count = settings.turntable or 2
    poses = list(_turn(settings, frame_count))
    yield Progress(0, frame_count + 1, f"reading {map_set.name}")
    draw = _Studio(open_map_set(map_set, clamp=settings.clamp), settings, look)
    shown = _spaced(frame_count)
    sheet = []
    with temporary_folder() as folder:
        frames = [folder / f"{number:06d}.png" for number in range(frame_count)]
        for number, (pose, frame) in enumerate(zip(poses, frames, strict=True)):
            yield Progress(number, frame_count + 1, f"drawing frame {number + 1} of {frame_count}")
            picture = draw(*pose)
            save_png(frame, picture, settings.exposure, settings.view_transform)
            if number in shown:
                sheet.append(picture)
        yield Progress(frame_count, frame_count + 1, f"writing {movie.name}")
        with together():
            with written_aside(movie, force) as aside:
                save_movie(aside, frames)
            _write_picture(output, contact_sheet(sheet, SHEET_COLUMNS), settings, force)
    return output, movie


class _Studio:
    """A map set, or what is exact in its light, and a mesh, uploaded, to be drawn from any camera."""

    def __init__(
        self, opened: OpenedMapSet, settings: PreviewOptions, look: Any, exact: GpuMapSet | None = None
    ) -> None:
        self._settings = settings
        self._mesh: TriangleMesh = load_mesh(settings.mesh)
        self._look = None if exact else look or look_types()[opened.kind]()
        self._renderer = PreviewRenderer(exact or opened.drawable())
        self._positions = settings.fill * self._mesh.positions
        self._matte = Matte(settings, opened.environment, self._positions, self._mesh.triangles)

    def __call__(self, camera: Camera, object_turn: Array = STILL, light_turn: Array = STILL) -> Array:
        mesh, turns = (self._positions, self._mesh.normals, self._mesh.triangles), (object_turn, light_turn)
        picture = self._renderer.draw(*mesh, camera, self._settings.size, self._look, *turns)
        return self._matte.under(picture, camera, *turns)


def _exact(opened: OpenedMapSet, settings: PreviewOptions, spec: str) -> Steps[GpuMapSet]:
    """The model itself in the map set's light, from the settings' view."""
    if opened.environment is None:
        raise MapSetError("The map set does not hold the light that it was made in: give that as a picture.")
    model = yield from load_brdf(spec)
    radiance, alpha = opened.environment.radiance, narrowest_alpha(model)
    height, width = radiance.shape[:2]
    if not is_resolved(alpha, height):
        warn(
            f"{opened.environment.name} is too coarse, at {width}x{height}, for alpha {alpha:.2g}: take a "
            f"larger environment."
        )
    view_dir = settings.camera(settings.view).view_dir
    (sphere,) = yield from lit_spheres(model, radiance, [view_dir], rings_of(alpha))
    return GpuLitSphere(sphere)


def _turn(settings: PreviewOptions, frame_count: int) -> Iterator[tuple[Camera, Array, Array]]:
    """The camera and the turns of object and light in each frame: counter-clockwise seen from above."""
    camera = settings.camera(settings.view)
    if settings.turned is Turned.EYE and np.hypot(*camera.view_dir[:2]) < 1e-6:
        raise RangeError("A turntable turns about Z, so its view cannot be along Z: look from aside.")
    for angle in 2.0 * np.pi * np.arange(frame_count) / frame_count:
        turn = turn_about_z(angle)
        match settings.turned:
            case Turned.EYE:
                yield replace(camera, view_dir=tuple(turn @ camera.view_dir)), STILL, STILL
            case Turned.OBJECT:
                yield camera, turn, STILL
            case Turned.LIGHT:
                yield camera, STILL, turn


def _spaced(frame_count: int) -> set[int]:
    """Numbers of the frames that a contact sheet shows."""
    shown = min(frame_count, SHEET_COLUMNS * SHEET_ROWS)
    return {number * frame_count // shown for number in range(shown)}


def _check_picture_target(path: Path, force: bool, sources: Iterable[Path]) -> None:
    check_target(path, force, (".exr", ".png"))
    check_apart(path, sources)


def _sources(map_set: Path, settings: PreviewOptions) -> list[Path]:
    picture = [] if settings.background in (None, LIGHT) else [Path(settings.background)]
    return [map_set, *picture]


def _write_picture(path: Path, rgba: Array, settings: PreviewOptions, force: bool) -> None:
    if path.suffix.lower() == ".exr":
        write_exr(path, rgba, force)
        return
    with written_aside(path, force) as aside:
        save_png(aside, rgba, settings.exposure, settings.view_transform)
