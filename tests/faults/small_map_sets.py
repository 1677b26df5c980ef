"""A small map set of each kind, and the other files of ours that hold JSON."""

import numpy as np
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.kinds.kernel_bank.filtered_bank import FilteredBank
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import BakedPyramid, FilterErrors
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack, stack_representation
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.lobes.bake import BakedBank
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.files.kinds import (
    kernel_bank,
    kernel_pyramid,
    lobe_stack,
    mip_chain,
    reflection_tables,
)
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.tests.lobe_stacks import random_fit, random_stack
from rsibr.tests.mirror_capture import mirror_map_set

LIGHT = Environment(np.random.default_rng(12).random((4, 8, 3), dtype=np.float32), "light")
BRDF = "layered:coat=(ggx:alpha=0.1,eta=1.5),base=(lambert:kd=0.3/0.05/0.02)"


def map_sets() -> list[MapSet]:
    """One of each kind, with all that a kind can say."""
    return [
        _kernel_pyramid(),
        mirror_map_set(size=4),
        _lobe_stack(),
        _kernel_bank(),
        _reflection_tables(),
        _mip_chain(),
    ]


def _kernel_pyramid() -> MapSet:
    rng = np.random.default_rng(13)
    maps = tuple(rng.random((1, n, n, 3), dtype=np.float32) for n in (2, 4, 6))
    diffuse, rings = (rng.random((count, 2, 2, 3), dtype=np.float32) for count in (2, 3))
    errors = [FilterErrors(rng.random(3), 1e-3 * number) for number in range(7)]
    pyramid = Pyramid(KernelBank((0.5, 1.0)), maps[2], maps[:2], diffuse, rings)
    baked = BakedPyramid(pyramid, tuple(errors[:2]), tuple(errors[2:4]), tuple(errors[4:]))
    return kernel_pyramid.to_map_set(baked, Origin(LIGHT, {}, "test"))


def _lobe_stack() -> MapSet:
    fit = random_fit(KernelBank((0.5, 4.0)))
    maps = random_stack("octahedral", size=4).maps[:2, :4]
    stack = LobeStack("octahedral", fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    material = {"brdf": BRDF, "method": "joint", lobe_stack.PROFILES: lobe_stack.profiles(fit)}
    bound = {"filter": [1e-5] * 3, "interpolation": 1e-3}
    return lobe_stack.to_map_set(stack, Origin(LIGHT, {"half": False}, "test", material, bound))


def _kernel_bank() -> MapSet:
    rng = np.random.default_rng(14)
    maps = rng.random((2, *stack_representation("dual_paraboloid", 4).shape(4), 3), dtype=np.float32)
    filtered = FilteredBank("dual_paraboloid", KernelBank((0.5, 1.0)), maps, rng.random((2, 3)))
    return kernel_bank.to_map_set(BakedBank(filtered, (0.001, 0.002)), Origin(LIGHT, {"size": 4}, "test"))


def _reflection_tables() -> MapSet:
    rng = np.random.default_rng(15)
    maps = {role: rng.random((2 + i, 4 + 2 * i, 3), dtype=np.float32) for i, role in enumerate(Role)}
    tables = ReflectionTables(maps, rng.random((len(Role), 4, 3), dtype=np.float32), 1.5)
    material, bound = {"diffuse": "lambert:kd=1"}, {"specular": [1e-5] * 3}
    return reflection_tables.to_map_set(tables, Origin(LIGHT, {"exact": False}, "test", material, bound))


def _mip_chain() -> MapSet:
    rng = np.random.default_rng(16)
    mips = tuple(rng.random((6, n, n, 3), dtype=np.float32) for n in (4, 2, 1))
    chain = MipChain(mips, rng.normal(size=(9, 3)), (0.0, 0.5, 1.0))
    settings = {"filter": "ggx", "size": 4, "roughness": "linear"}
    origin = Origin(LIGHT, settings, "test", {"filter": "ggx"}, {"relative_to_peak": 1e-3})
    return mip_chain.to_map_set(chain, origin)
