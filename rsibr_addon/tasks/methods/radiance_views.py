"""Radiance views of a material, rendered or integrated, into a map set."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.brdf.gallery import gallery_name
from ...core.brdf.lambert import Lambert
from ...core.brdf.lobe_width import narrowest_alpha
from ...core.brdf.spec import brdf_from_spec, is_model
from ...core.conventions import Array
from ...core.counted import counted
from ...core.environment import Environment
from ...core.errors import InputFileError
from ...core.geometry.geodesic import GeodesicSphere, geodesic_sphere
from ...core.geometry.view_sphere import view_sphere
from ...core.kinds.radiance_views.exact import bytes_needed, ring_count
from ...core.kinds.radiance_views.left_out import LeftOut
from ...core.options import to_plain
from ...core.progress import Progress, Steps, drain
from ...core.warned import warn
from ...files.ball_list import BallPhotograph, read_ball_list
from ...files.fits import fields_of
from ...files.kinds.radiance_views import LEFT_OUT, LOBES, LOBES_LEFT_OUT, left_out
from ...files.map_set_data import ENVIRONMENT, MapsInTurn
from ...files.map_set_header import Origin, Recipe, make_header
from ...files.view_directions import read_view_dirs
from ...files.work_folder import kept_parts, work_folder_beside
from ...job import BakeJob
from ...settings.radiance_views import RENDERING, RadianceViewsSettings
from .kept_views import KeptViews
from .method import (
    ENVIRONMENT_MEMORY,
    ENVIRONMENT_ROWS,
    RGB,
    STORED,
    Baked,
    Cost,
    Method,
    Sources,
    cost_in_blender,
    measured_files,
    read_light,
    software_of,
    written,
)
from .more_views import CapturedViews, capture_views, fitting_cost, most_views
from .views_by_model import TOGETHER, ViewsByModel
from .views_by_photographs import ViewsByPhotographs

if TYPE_CHECKING:
    from .views_by_cycles import ViewsByCycles

ALBEDO = "albedo"
"""Name and role of the part that holds the material's directional albedo."""


def material(settings: RadianceViewsSettings) -> str:
    """See `Method`."""
    return gallery_name(settings.material).removeprefix(":")


def sources(settings: RadianceViewsSettings) -> Sources:
    """See `Method`."""
    if settings.photographs is not None:
        listed = _photographs_if_there(settings.photographs)
        files = (settings.photographs, *(str(each.path) for each in listed))
        return Sources(files, listed=tuple(each.name for each in listed))
    files = () if settings.view_file is None else (settings.view_file,)
    if is_model(settings.material):
        return Sources((*measured_files(partial(brdf_from_spec, settings.material)), *files))
    return Sources(files, settings.material)


def cost(settings: RadianceViewsSettings) -> Cost:
    """See `Method`; measured on a sphere in Blender's `forest`."""
    try:
        asked = len(_sphere(settings).vertices)
    except InputFileError:  # which the bake tells
        asked = settings.views
    views = most_views(settings, asked)
    capturing = _capturing_cost(settings, views)
    if not settings.fits_lobes:
        return capturing
    seconds, memory = fitting_cost(asked, views)
    every = _map_bytes(settings, views)
    return replace(
        capturing,
        processor_seconds=capturing.processor_seconds + seconds,
        memory=capturing.memory + every + memory,
    )


def _map_bytes(settings: RadianceViewsSettings, views: int) -> float:
    return 2.0 * views * settings.size**2 * RGB


def _capturing_cost(settings: RadianceViewsSettings, views: int) -> Cost:
    texels, maps = views * settings.size**2, _map_bytes(settings, views)
    if settings.photographs is not None:
        return Cost(4e-6 * texels, maps, STORED * maps)
    if is_model(settings.material):
        alpha = narrowest_alpha(brdf_from_spec(settings.material, lambda name, path: Lambert(kd=0.5)))
        rings = ring_count(settings.size, ENVIRONMENT_ROWS, alpha)
        integrating = 0.2 * rings * views / TOGETHER + 4e-5 * texels
        memory = bytes_needed(ENVIRONMENT_ROWS, TOGETHER, settings.size, alpha)
        return Cost(integrating, memory, STORED * maps)
    rendering = views * (0.5 + 1.5 * settings.denoise) + 2.5e-6 * texels * settings.samples
    albedo = 4.0
    return cost_in_blender(albedo + rendering, 2 * maps + 8 * ENVIRONMENT_MEMORY, STORED * maps)


def bake(job: BakeJob[RadianceViewsSettings], recipe: Recipe) -> Steps[Baked]:
    """Render the views of a material. Between two steps, the open file holds nothing that this adds.

    Raises
    ------
    RangeError, InputFileError, SceneError, OutputFileError
        The job cannot be done, or takes more memory than there is; found before the first view is rendered.
    RenderError, SceneError, OutputFileError
        Cycles did not deliver; the material was changed meanwhile; the disk is full.

    Warns
    -----
    RsibrWarning
        The material depends on more than normal and view; the environment was clamped; views of
        another job were removed; or see `capture_views`.

    Notes
    -----
    Each finished view is kept in OUTPUT.partial until the map set is whole. A job that was
    interrupted, even killed, goes on with them, and the result is the same, bit by bit. Never more than
    one view is in memory, but where lobes are fitted.
    """
    asked = job.settings
    sphere = _sphere(asked)
    most = most_views(asked, len(sphere.vertices))
    # Its own steps would be of another total than the views
    yield Progress(0, most, "reading the environment")
    light = drain(read_light(job))
    if not sphere.surrounds and asked.more_views is None:
        warn(
            f"The views of {asked.photographs or asked.view_file} do not surround the object, so none are "
            "blended and the nearest is shown: give views from all sides."
        )
    lit = _lit_material(asked, light, most)
    lit.check_memory(job.output)
    folder = work_folder_beside(Path(job.output))
    kept = KeptViews(folder)
    with kept_parts(folder, {**recipe}):
        capture = partial(lit.capture, kept.keep)
        captured = yield from capture_views(asked, light, sphere.vertices, kept, capture)
        software = software_of(job, measured=_is_rendered(asked))
        map_set = _map_set(lit, asked, light, captured, kept, software)
        path = drain(written(job, recipe, map_set))
    told, figures = captured.report()
    stated = left_out(map_set.header)
    error = f", error in views left out {min(stated.values()):.2g}" if stated else ""
    views = f"{counted(len(captured.view_dirs), 'view')} of {asked.size}x{asked.size}"
    return Baked(path, f"{views}{error}{told}", {"size": asked.size, **figures})


def _is_rendered(settings: RadianceViewsSettings) -> bool:
    return settings.photographs is None and not is_model(settings.material)


def _sphere(settings: RadianceViewsSettings) -> GeodesicSphere:
    """The directions of the views."""
    if settings.photographs is not None:
        if settings.view_file is not None:
            raise InputFileError("The list of photographs says their directions: leave the view file out.")
        return view_sphere([each.view_dir for each in read_ball_list(settings.photographs)])
    if settings.view_file is None:
        return geodesic_sphere(settings.views)
    return view_sphere(read_view_dirs(settings.view_file))


def _photographs_if_there(path: str) -> list[BallPhotograph]:
    """What a list names; a bake tells what is wrong with the list."""
    try:
        return read_ball_list(path)
    except InputFileError:
        return []


def _lit_material(
    settings: RadianceViewsSettings, light: Environment, most: int
) -> "ViewsByModel | ViewsByCycles | ViewsByPhotographs":
    if settings.photographs is not None:
        return ViewsByPhotographs(settings, read_ball_list(settings.photographs))
    if is_model(settings.material):
        return ViewsByModel(settings, light)
    from .views_by_cycles import ViewsByCycles

    return ViewsByCycles(settings, light, most)


def _map_set(
    lit: "ViewsByModel | ViewsByCycles | ViewsByPhotographs",
    settings: RadianceViewsSettings,
    light: Environment,
    captured: CapturedViews,
    kept: KeptViews,
    software: str,
) -> MapsInTurn:
    sphere = view_sphere(captured.view_dirs)
    albedo, count = lit.albedo(), len(sphere.vertices)
    shapes = {ENVIRONMENT: light.radiance.shape[:2], ALBEDO: albedo.shape[:2]}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in shapes]
    predicted = LeftOut(sphere, settings.size, albedo)
    for view in range(count):
        view_dir = sphere.vertices[view].tolist()
        finished = kept.parts(view)
        for part in finished:
            name = f"view{view:03d}.{part.name}"
            shapes[name] = (settings.size,) * 2
            parts.append({"name": name, "role": part.name, "view": view, "view_dir": view_dir})
        predicted.add(view, *(part.side_by_side("RGB") for part in finished))
    errors = {"relative_noise": kept.noise(count)}
    errors |= {f"{LEFT_OUT}{warping}": error for warping, error in predicted.errors().items()}

    def maps() -> Iterator[Array]:
        yield from (light.radiance, albedo)
        for view in range(count):
            yield from (part.side_by_side("RGB") for part in kept.parts(view))

    by_file = settings.view_file is not None or settings.photographs is not None
    untold = {"material", "fit_lobes"} | ({"views"} if by_file else set())
    untold |= set() if _is_rendered(settings) else {*RENDERING}
    given = {name: value for name, value in to_plain(settings).items() if value is not None}
    stated = {name: value for name, value in given.items() if name not in untold}
    lobes = {} if captured.fit is None else {LOBES: fields_of(captured.fit)}
    if captured.fit is not None and captured.fit.left_out is not None:
        errors[LOBES_LEFT_OUT] = captured.fit.left_out
    origin = Origin(light, stated, software, lit.material | lobes, errors)
    header = make_header("sphere_map", (settings.size, settings.size), parts, origin)
    return MapsInTurn("radiance_views", shapes, maps(), header)


METHOD = Method(bake, cost, material, sources)
