"""A small map set of each kind, and the other files of ours that hold JSON."""

import json
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.kinds.kernel_bank.filtered_bank import FilteredBank
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack, stack_representation
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, Warping
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.lobes.bake import BakedBank
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.files.fits import write_fit
from rsibr.rsibr_addon.files.kinds import kernel_bank, lobe_stack, mip_chain, reflection_tables
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.job import CommandJob
from rsibr.rsibr_addon.settings.comparison import ComparisonOptions
from rsibr.rsibr_addon.settings.lobe_stack import StackComparison
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison, WayError
from rsibr.rsibr_addon.tasks.compare.lobe_stack import StackWay
from rsibr.rsibr_addon.tasks.compare.radiance_views import ViewsWay
from rsibr.tests.lobe_stacks import random_fit, random_stack
from rsibr.tests.mirror_capture import mirror_map_set

RNG = np.random.default_rng(12)
LIGHT = Environment(RNG.random((4, 8, 3), dtype=np.float32), "light")
BRDF = "layered:coat=(ggx:alpha=0.1,eta=1.5),base=(lambert:kd=0.3/0.05/0.02)"


def map_sets() -> list[MapSet]:
    """One of each kind, with all that a kind can say."""
    return [mirror_map_set(size=4), _lobe_stack(), _kernel_bank(), _reflection_tables(), _mip_chain()]


def json_files(folder: Path) -> dict[str, str]:
    """Name -> text, of fits, jobs and comparisons."""
    write_fit(folder / "fit.json", random_fit(KernelBank((0.5, 4.0))), {"E": 0.1}, force=True)
    fit = (folder / "fit.json").read_text()
    job = CommandJob(("bake", "--brdf", BRDF, "--size", "16", "--output", "out.rsibr.exr")).to_json()
    views = _comparison(
        ViewsComparison(views=2), WayError(ViewsWay(12, Mode.PAPER, Warping.SPLIT), (0.1, 0.2), 0.15)
    )
    stack = _comparison(StackComparison(views=2), WayError(StackWay(2, 4, 2), (0.1, 0.2), 0.15))
    return {"fit.json": fit, "job.json": job, "views.json": views, "stack.json": stack}


def _comparison(settings: ComparisonOptions, error: WayError) -> str:
    view_dirs = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    found = Comparison("a.rsibr.exr", "0" * 64, "forest", "copper", 8, settings, view_dirs, 0.001, (error,))
    return json.dumps(found.to_json())


def _lobe_stack() -> MapSet:
    fit = random_fit(KernelBank((0.5, 4.0)))
    maps = random_stack("octahedral", size=4).maps[:2, :4]
    stack = LobeStack("octahedral", fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    material = {"brdf": BRDF, "method": "joint", lobe_stack.PROFILES: lobe_stack.profiles(fit)}
    bound = {"filter": [1e-5] * 3, "interpolation": 1e-3}
    return lobe_stack.to_map_set(stack, Origin(LIGHT, {"half": False}, "test", material, bound))


def _kernel_bank() -> MapSet:
    maps = RNG.random((2, *stack_representation("dual_paraboloid", 4).shape(4), 3), dtype=np.float32)
    filtered = FilteredBank("dual_paraboloid", KernelBank((0.5, 1.0)), maps, RNG.random((2, 3)))
    return kernel_bank.to_map_set(BakedBank(filtered, (0.001, 0.002)), Origin(LIGHT, {"size": 4}, "test"))


def _reflection_tables() -> MapSet:
    maps = {role: RNG.random((2 + i, 4 + 2 * i, 3), dtype=np.float32) for i, role in enumerate(Role)}
    tables = ReflectionTables(maps, RNG.random((len(Role), 4, 3), dtype=np.float32), 1.5)
    material, bound = {"diffuse": "lambert:kd=1"}, {"specular": [1e-5] * 3}
    return reflection_tables.to_map_set(tables, Origin(LIGHT, {"exact": False}, "test", material, bound))


def _mip_chain() -> MapSet:
    mips = tuple(RNG.random((6, n, n, 3), dtype=np.float32) for n in (4, 2, 1))
    chain = MipChain(mips, RNG.normal(size=(9, 3)), (0.0, 0.5, 1.0))
    settings = {"filter": "ggx", "size": 4, "roughness": "linear"}
    origin = Origin(LIGHT, settings, "test", {"filter": "ggx"}, {"relative_to_peak": 1e-3})
    return mip_chain.to_map_set(chain, origin)
