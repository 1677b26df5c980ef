"""Reflectance models that are chosen in the preview, and shaded from a kernel bank without a bake."""

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...core.brdf.model import Brdf
from ...core.brdf.spec import brdf_from_spec
from ...core.kinds.kernel_bank.filtered_bank import FilteredBank, stack_from_bank
from ...core.kinds.kernel_bank.shading import DRAFT, BankLook
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.lobes.fit import Fit
from ...core.lobes.layers import layered_fit
from ...core.lobes.target import elevation_slices, target_slices
from ...core.progress import Steps
from ...core.warned import recorded_warnings, warn
from ...device.drawing import Draw, GpuMesh, Inputs
from ...device.kinds.lobe_stack import GpuLobeStack
from ...files.brdfs import read_measured
from .latest_request_worker import LatestRequestWorker

Result = TypeVar("Result")

SLICES = 16
"""View elevations of a fit."""

RESOLVED = 50.0
"""Concentration of the sharpest kernel times a lobe's radius squared. Below, E of a fit grows by more
than a sixth."""

FITS_KEPT = 256
"""How many fits are kept; each takes some 15 kB."""

KEPT = 8
"""What is drawn stays until so many others have been uploaded since."""

_Quality = tuple[int, int, int | None]


class LiveFits:
    """Fits, which are the same in every light, and where stacks are made of them.

    Parameters
    ----------
    worker : LatestRequestWorker or None
        Makes stacks, drafts first; without one, whoever needs a stack waits for it.
    """

    def __init__(self, worker: LatestRequestWorker | None = None) -> None:
        self.worker = worker
        self._kept: dict[tuple[str, _Quality, float], Fit] = {}

    def fit(self, brdf: Brdf, spec: str, quality: _Quality, sharpest: float) -> Steps[Fit]:
        """Fit a model, unless that fit is kept.

        Parameters
        ----------
        brdf : Brdf
        spec : str
            What `brdf` was made of.
        quality : (int, int, int or None)
            Lobes, elevations and taps.
        sharpest : float
            Concentration of the sharpest kernel.

        Returns
        -------
        Fit
        """
        key = (spec, quality, sharpest)
        if key not in self._kept:
            lobes, slices, taps = quality
            mu = elevation_slices(slices)
            self._kept[key] = yield from layered_fit(brdf, mu, lobes, taps=taps, sharpest=sharpest)
            for forgotten in list(self._kept)[:-FITS_KEPT]:
                del self._kept[forgotten]
        return self._kept[key]


@dataclass(frozen=True)
class _Made:
    """What the thread hands over: a stack to be drawn with, which may be a draft, or why there is none."""

    gpu_map_set: GpuLobeStack | None
    error: Exception | None
    is_final: bool
    warning: str = ""


@dataclass
class _Shown:
    """What a look is drawn with.

    Attributes
    ----------
    gpu_map_set : GpuLobeStack or None
    error : Exception or None
        Why there is none.
    is_final : bool
        False for a draft.
    warning : str
        What there is to be said of it; empty for nothing.
    used_at : int
        How many uploads there had been when it was needed last.
    """

    gpu_map_set: GpuLobeStack | None
    error: Exception | None
    is_final: bool
    warning: str
    used_at: int


class LiveMaterials:
    """A kernel bank, and the stacks of the looks that are drawn from it: a `LiveGpuMapSet`.

    Parameters
    ----------
    filtered : FilteredBank
    fits : LiveFits, optional
        Without them, looks are made at once, and their warnings are Python's.
    """

    def __init__(self, filtered: FilteredBank, fits: LiveFits | None = None) -> None:
        self._filtered = filtered
        self._fits = fits or LiveFits()
        self.textures = ()
        self._made: dict[BankLook, _Made] = {}
        self._shown: dict[BankLook, _Shown] = {}
        self._uploads = 0

    def is_ready(self, look: BankLook) -> bool:
        """Whether a look can be drawn, perhaps from a draft; what is missing is made.

        Returns
        -------
        bool
            False only where a worker makes it.

        Raises
        ------
        RsibrError, OSError
            The look's model is none, or cannot be fitted.
        DeviceError
            It does not fit into a texture.
        """
        shown = self._shown.get(look)
        if shown is None or not shown.is_final:
            if look not in self._made:
                self._have_made(look, is_urgent=shown is None)
            shown = self._taken(look) or shown
        if shown is None:
            return False
        shown.used_at = self._uploads
        if shown.error is not None:
            raise shown.error
        return True

    def newest(self, looks: list[BankLook]) -> BankLook | None:
        """See `LiveGpuMapSet.newest`; raises as `is_ready` does, of the last look."""
        if self.is_ready(looks[-1]):
            return looks[-1]
        return next(filter(self._can_be_drawn, reversed(looks)), None)

    def warning(self, look: BankLook) -> str:
        """See `LiveGpuMapSet.warning`."""
        made = self._made.get(look) or self._shown.get(look)
        return made.warning if made else ""

    def draw(self, mesh: GpuMesh, draw: Draw, look: BankLook) -> None:
        """See `GpuMapSet.draw`; a look that is not ready is not drawn."""
        if self._can_be_drawn(look) or self.is_ready(look):
            gpu_map_set = self._shown[look].gpu_map_set
            if gpu_map_set is not None:
                gpu_map_set.draw(mesh, draw, StackLook())

    def inputs(self, look: BankLook) -> Inputs:
        """See `ProgramMapSet.inputs`; without a worker. Raises as `is_ready` does."""
        self.is_ready(look)
        gpu_map_set = self._shown[look].gpu_map_set
        assert gpu_map_set is not None
        return gpu_map_set.inputs(StackLook())

    def _can_be_drawn(self, look: BankLook) -> bool:
        """The same as `is_ready`, but nothing is made, and nothing raised."""
        shown = self._taken(look) or self._shown.get(look)
        if shown is None or shown.error is not None:
            return False
        shown.used_at = self._uploads
        return True

    def _have_made(self, look: BankLook, is_urgent: bool) -> None:
        steps = self._making(look)
        if self._fits.worker:
            self._fits.worker.request((id(self), look), steps, is_urgent)
            return
        for _ in steps:
            pass
        if warning := self.warning(look):
            warn(warning)

    def _taken(self, look: BankLook) -> _Shown | None:
        """Take what has been made, if it has."""
        made = self._made.pop(look, None)
        if made is None:
            return None
        self._uploads += 1
        self._shown[look] = _Shown(made.gpu_map_set, made.error, made.is_final, made.warning, self._uploads)
        oldest = self._uploads - KEPT
        self._shown = {each: shown for each, shown in self._shown.items() if shown.used_at >= oldest}
        return self._shown[look]

    def _making(self, look: BankLook) -> Iterator[bool]:
        """Make a look's stacks, the draft first; in the thread, where there is one. True with each stack."""
        try:
            with recorded_warnings() as warned:
                brdf = brdf_from_spec(look.spec, read_measured)
            warned += _blunt(self._filtered, brdf, look.spec)
            final = (look.lobe_count, SLICES, None)
            for quality in (DRAFT, final) if self._fits.worker else (final,):
                fit = yield from _unshown(self._fits.fit(brdf, look.spec, quality, self._filtered.sharpest))
                stack, _ = stack_from_bank(self._filtered, fit)
                self._hand_over(look, _Made(GpuLobeStack(stack), None, quality == final, " ".join(warned)))
                yield True
        except Exception as error:  # Told by whoever asks for the look
            self._hand_over(look, _Made(None, error, is_final=True))
            yield True

    def _hand_over(self, look: BankLook, made: _Made) -> None:
        self._made[look] = made
        for forgotten in list(self._made)[:-KEPT]:
            self._made.pop(forgotten, None)


def _unshown(steps: Steps[Result]) -> Generator[bool, None, Result]:
    """Steps after which nothing new can be shown."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: Result = end.value
            return result
        yield False


def _blunt(filtered: FilteredBank, brdf: Brdf, spec: str) -> list[str]:
    """A warning where maps are too small for a model."""
    radius = min(target_slices(layer, [1.0])[0].radius for layer in brdf.layers)
    if filtered.sharpest * radius**2 >= RESOLVED:
        return []
    return [
        f"Maps of {filtered.size} texels blur {spec}, whose lobe is {np.degrees(2.0 * radius):.2g} "
        f"degrees wide: bake a larger kernel bank."
    ]
