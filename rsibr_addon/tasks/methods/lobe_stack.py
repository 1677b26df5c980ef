"""An environment and a reflectance model, or its fit, to a lobe stack, in a map set."""

import json
from dataclasses import dataclass
from functools import cache, partial
from itertools import count
from math import ceil, log2
from pathlib import Path

from ...core.brdf.gallery import gallery_name
from ...core.brdf.lambert import Lambert
from ...core.brdf.lobe_width import narrowest_alpha
from ...core.brdf.spec import MATERIAL, MEASURED, brdf_from_spec
from ...core.environment import Environment
from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.lobes.accuracy import fit_errors
from ...core.lobes.bake import SIZES, bake_stack, sharpest_resolved
from ...core.lobes.fit import Fit
from ...core.lobes.kept_fits import kept_fit
from ...core.options import declared_options
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...files.kinds.lobe_stack import in_turn
from ...files.map_set_header import Origin, Recipe
from ...files.output_paths import bare_name
from ...files.stated_lobes import stated_lobes
from ...job import BakeJob
from ...settings.fit import Fitting
from ...settings.lobe_stack import LobeStackSettings
from ..reflectance.brdfs import is_material, load_brdf, material_of
from ..reflectance.model_fits import fitted
from . import method
from .method import RGB, STORED, Baked, Cost, Method, Sources, cost_in_blender

TOLD_INTERPOLATION = 0.01
"""Relative error that lookups may be expected to cost before somebody is told."""

TEXELS_BY_ALPHA = 38.0
"""Width of a map times its lobe's width alpha, as bakes choose it in Blender's `forest`."""

KERNELS = 12
"""Kernels that the lobes of a usual fit are sums of."""

LOBE_SIZE = 128
"""Width of a map where nothing is known of the lobes."""


def material(settings: LobeStackSettings) -> str:
    """See `Method`."""
    if settings.brdf is None:
        return bare_name(Path((settings.fit or "").removesuffix(".json")))
    named = gallery_name(settings.brdf)
    return named if "path=" not in named else Path(named).stem


def cost(settings: LobeStackSettings) -> Cost:
    """See `Method`; two paraboloids.

    Raises
    ------
    RangeError
        The text describes no model.
    """
    layers, size = _layers_and_size(settings.brdf or MATERIAL)
    maps = layers * settings.lobes * settings.slices * 2 * (settings.size or size) ** 2 * RGB
    measuring = 12.0 * (settings.brdf or "").startswith(MATERIAL)
    fitting = 0.01 * layers * settings.lobes * settings.slices
    filtering = 1.0 + 4e-8 * maps
    memory = BYTES_BESIDES + bytes_needed(KERNELS, 2 * (settings.size or size) ** 2)
    stored = 0.2 if settings.half else STORED
    return cost_in_blender(measuring + fitting + filtering, memory, stored * maps)


def sources(settings: LobeStackSettings) -> Sources:
    """See `Method`."""
    if settings.brdf is None:
        return Sources((settings.fit or "",))
    if is_material(settings.brdf):
        return Sources(material=material_of(settings.brdf))
    return Sources(method.measured_files(partial(brdf_from_spec, settings.brdf)))


@cache
def _layers_and_size(spec: str) -> tuple[int, int]:
    """How many layers a model has, and how large its maps will be: roughly, by its sharpest lobe."""
    if spec.startswith((MATERIAL, *MEASURED)):
        return 1, LOBE_SIZE
    model = brdf_from_spec(spec, lambda name, path: Lambert(kd=0.5))
    return len(model.layers), min(2 ** ceil(log2(TEXELS_BY_ALPHA / narrowest_alpha(model))), SIZES[-1])


def bake(job: BakeJob[LobeStackSettings], recipe: Recipe) -> Steps[Baked]:
    """Filter an environment with the lobes of a model, or of a fit that was made before.

    Raises
    ------
    RangeError
        The text describes no model; the environment resolves no kernel at all, or a fit's lobe is narrower
        than it resolves; light is too bright for half floats, or the maps are too large for this machine's
        memory.
    InputFileError
        See `stated_lobes`.

    Warns
    -----
    RsibrWarning
        See `load_brdf` and `load_environment`; the maps are small for their lobes; or the environment is too
        coarse for the sharpest kernels, which are left out.
    """
    settings = job.settings
    light = yield from method.read_light(job)
    if settings.brdf is None:
        fit = stated_lobes(settings.fit or "")
    else:
        fit = yield from _resolved_fit(settings, light, recipe)
    afford = method.afforded_by(job, BYTES_BESIDES)
    baked = yield from bake_stack(light.radiance, fit, settings.layout, settings.size, afford)
    size, shown = baked.filtered.size, baked.interpolation_suns_apart
    if shown > TOLD_INTERPOLATION:
        warn(f"Lookups in maps of {size} texels cost about {100.0 * shown:.2g} %: choose a larger size.")
    stated = {"layout": settings.layout, "size": size, "half": settings.half}
    origin = Origin(light, stated, method.software_of(job, is_material(settings.brdf or "")))
    path = yield from method.written(job, recipe, in_turn(baked, origin), settings.half)
    lobes, maps = baked.fit.weights.shape[:2]
    return Baked(
        path,
        f"lobes: {lobes}, maps of each: {maps}, {size}x{size} texels",
        {
            "lobes": lobes,
            "elevations": len(baked.fit.mu),
            "maps": maps,
            "size": size,
            "interpolation": baked.interpolation,
            "interpolation_suns_apart": shown,
        },
    )


def _resolved_fit(settings: LobeStackSettings, light: Environment, recipe: Recipe) -> Steps[Fit]:
    """A fit with the kernels that the environment resolves, and a warning where sharper ones would serve."""
    height, width = light.radiance.shape[:2]
    resolved = sharpest_resolved(height)
    asked = {each.name: recipe["settings"][each.name] for each in declared_options(Fitting)}
    key = [recipe["settings"]["brdf"], asked, recipe["files"], recipe["material"], resolved]
    made = yield from kept_fit(json.dumps(key), partial(_fit_within, settings, resolved))
    if made.sharper is not None:
        without, with_sharper = made.errors
        enough = next(2**n for n in count(1) if sharpest_resolved(height * 2**n) >= made.sharper)
        warn(
            f"{light.name} is too coarse, at {width}x{height}, for the sharpest kernels of these lobes: "
            f"without them E is {without:.3g}, with them {with_sharper:.3g}; one of "
            f"{enough * width}x{enough * height} takes them."
        )
    return made.fit


@dataclass(frozen=True)
class _FitWithin:
    """A fit without kernels above a concentration.

    Attributes
    ----------
    fit : Fit
    sharper : float or None
        The sharpest kernel of a fit that may have any; None where none of them is left out.
    errors : (float, float)
        E of the fit, and of that with sharper kernels.
    """

    fit: Fit
    sharper: float | None = None
    errors: tuple[float, float] = (0.0, 0.0)


def _fit_within(settings: LobeStackSettings, resolved: float) -> Steps[_FitWithin]:
    brdf = yield from load_brdf(settings.brdf or "")
    fit = yield from fitted(brdf, settings)
    sharpest = float(fit.bank.kappa[fit.used].max(initial=0.0))
    if sharpest <= resolved:
        return _FitWithin(fit)
    coarser = yield from fitted(brdf, settings, resolved)
    yield Progress(0, 1, "measuring the fits")
    return _FitWithin(coarser, sharpest, (fit_errors(coarser, brdf).error, fit_errors(fit, brdf).error))


METHOD = Method(bake, cost, material, sources)
