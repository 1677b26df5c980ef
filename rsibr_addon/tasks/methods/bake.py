"""Making map sets, by any method."""

from typing import Any

from ...core.progress import Steps
from ...job import BakeJob
from .kinds import KINDS
from .method import Baked


def bake(job: BakeJob[Any]) -> Steps[Baked]:
    """Make a map set.

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
    baked: Steps[Baked] = KINDS[job.settings.KIND].method.bake(job)
    return baked
