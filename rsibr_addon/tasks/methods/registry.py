"""The methods that make map sets."""

from typing import Any

from ...core.progress import Steps
from ...job import BakeJob
from . import kernel_bank, lobe_stack, mip_chain, radiance_views, reflection_tables
from .method import Baked, Method

METHODS: dict[str, Method] = {
    "radiance_views": Method(radiance_views.bake, radiance_views.cost, radiance_views.material),
    "lobe_stack": Method(lobe_stack.bake, lobe_stack.cost, lobe_stack.material),
    "reflection_tables": Method(reflection_tables.bake, reflection_tables.cost, reflection_tables.material),
    "mip_chain": Method(mip_chain.bake, mip_chain.cost, lambda settings: ""),
    "kernel_bank": Method(kernel_bank.bake, kernel_bank.cost, lambda settings: ""),
}
"""Kind of map sets -> what makes them."""


def bake(job: BakeJob[Any]) -> Steps[Baked]:
    """Make a map set.

    Parameters
    ----------
    job : BakeJob

    Yields
    ------
    Progress

    Returns
    -------
    Baked

    Raises
    ------
    OutputFileError
        The output exists, or cannot be written.
    RsibrError
        See `bake` of the job's method.

    Warns
    -----
    RsibrWarning
        Likewise.
    """
    return METHODS[job.settings.KIND].bake(job)
