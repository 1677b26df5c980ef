"""Fits and lobe stacks that are known in closed form, or have no pattern at all."""

import numpy as np
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack, stack_representation
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit


def random_stack(layout: str, size: int = 16, shared: bool = False, seed: int = 5) -> LobeStack:
    """Three lobes of two taps at five elevations, signed, without any pattern."""
    rng = np.random.default_rng(seed)
    sheets = stack_representation(layout, size).shape(size)
    return LobeStack(
        layout=layout,
        mu=np.array([0.1, 0.25, 0.5, 0.6, 0.95]),
        maps=rng.uniform(-0.2, 1.0, (3, 1 if shared else 5, *sheets, 3)).astype(np.float32),
        scale=rng.uniform(0.5, 1.0, (3, 5, 3)),
        offsets=rng.uniform(-0.4, 0.4, (3, 5, 2, 2)),
        taps=rng.uniform(0.1, 0.5, (3, 5, 2)),
        albedo=rng.uniform(0.0, 1.0, (3, 5, 3)),
    )


def random_fit(bank: KernelBank, lobes: int = 2, taps: int = 2, shared: bool = False, seed: int = 6) -> Fit:
    """Signed profiles of any kernels at four elevations."""
    rng = np.random.default_rng(seed)
    mu = np.array([0.125, 0.375, 0.625, 0.875])
    return Fit(
        brdf="none",
        method="joint",
        mu=mu,
        bank=bank,
        weights=rng.uniform(-0.2, 0.5, (lobes, 1 if shared else len(mu), len(bank), 3)),
        scale=rng.uniform(0.5, 1.0, (lobes, len(mu), 3)),
        offsets=rng.uniform(-0.3, 0.3, (lobes, len(mu), taps, 2)),
        taps=rng.uniform(0.2, 0.6, (lobes, len(mu), taps)),
    )
