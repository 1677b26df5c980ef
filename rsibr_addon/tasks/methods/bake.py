"""Making map sets, by any method."""

from typing import Any

from ...core.lazy_table import LazyTable
from ...core.progress import Steps
from ...files.kinds.registry import STORED
from ...job import BakeJob
from .method import Baked, Method

METHODS = LazyTable[Method](__package__, "METHOD", STORED)
"""Kind of map sets -> how it is made."""


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
    baked: Steps[Baked] = METHODS[job.settings.KIND].bake(job)
    return baked
