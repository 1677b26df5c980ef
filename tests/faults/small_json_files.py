"""The JSON files that we read, small: fits, jobs and comparisons."""

import json
from pathlib import Path

from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.files.fits import write_fit
from rsibr.rsibr_addon.job import CommandJob
from rsibr.rsibr_addon.settings.comparison import ComparisonOptions
from rsibr.rsibr_addon.settings.lobe_stack import StackComparison
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison, WayError
from rsibr.rsibr_addon.tasks.compare.lobe_stack import StackWay
from rsibr.rsibr_addon.tasks.compare.radiance_views import ViewsWay
from rsibr.tests.faults.small_map_sets import BRDF
from rsibr.tests.lobe_stacks import random_fit


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
