"""How a material is captured from all around: [Cabral1999]."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.brdf.cycles_presets import PRESETS, preset_title
from ..core.brdf.gallery import GALLERY
from ..core.errors import RangeError
from ..core.kinds.radiance_views.shading import Mode
from ..core.kinds.radiance_views.warping import Warping
from ..core.options import Choice, Materials, option
from .comparison import ComparisonOptions, samples_option
from .method import MethodSettings

EXPECTED = {
    12: "1 % off for clay, 13 to 22 % for copper and plastic, 16 to 65 % for car paint and mirrors",
    42: "6 to 12 % off for copper and plastic, 18 to 45 % for car paint and mirrors",
}
"""Number of views -> what was measured with them: docs/accuracy.md."""


@dataclass(frozen=True, kw_only=True)
class RadianceViewsSettings(MethodSettings):
    """Settings of radiance views."""

    KIND: ClassVar = "radiance_views"
    LABEL: ClassVar = "Radiance Views"
    SUMMARY: ClassVar = "Any material, rendered by Cycles or integrated from all around"

    material: str = option(
        label="Material",
        help=(
            f"a preset ({', '.join(PRESETS)}), FILE.blend:NAME, or :NAME of the open file, which Cycles "
            "renders; or a reflectance model or measurement, as ward:alpha=0.1,ks=0.8 or merl:path=FILE, "
            "which is integrated exactly, without samples and noise"
        ),
        metavar="MATERIAL",
        materials=Materials(
            own=":{}",
            presets={name: Choice(preset_title(name), preset.summary) for name, preset in PRESETS.items()},
            preset="copper",
            model=GALLERY["Plastics"]["Red plastic"],
        ),
    )
    views: int = option(
        12,
        label="Views",
        help="Directions from which the material is captured; more follow its changing look better",
        choices={
            count: Choice(str(count), f"{degrees} degrees apart")
            for count, degrees in ((12, 63), (42, 36), (162, 18))
        },
        final=42,
    )
    view_file: str | None = option(
        None,
        label="View File",
        help="Directions from which the material is captured, whatever the number of views says, each from "
        "it to the camera: three numbers a line, or a JSON list of such",
        none="evenly spread",
        none_as="",
        subtype="FILE_PATH",
        advanced=True,
        metavar="FILE",
    )
    fit_lobes: bool = option(
        False,
        label="Fit Lobes",
        help="Fit lobes to the views, and keep them in the map set: rsibr bake lobe-stack --fit shows them "
        "in any light",
        final=True,
        flag="--fit",
    )
    more_views: int | None = option(
        None,
        label="More Views",
        help="Capture so many more views at most, each where it tells most of lobes, which are fitted too",
        least=1,
        most=150,
        none="none",
        none_as=0,
        advanced=True,
        metavar="N",
    )
    goal: float | None = option(
        None,
        label="Goal",
        help="Capture no more views once the lobes predict views that are left out with this relative error; "
        "where they do not reach it, measure the material itself, and keep lobes fitted to that if these "
        "are closer",
        least=0.001,
        most=1.0,
        none="none",
        none_as=0.0,
        advanced=True,
        metavar="ERROR",
    )
    photographs: str | None = option(
        None,
        label="Photographs",
        help="List of photographs of a ball of the material, taken in the environment, as JSON; the material "
        "then is what they are called, and compared with",
        none="capture the material",
        none_as="",
        subtype="FILE_PATH",
        advanced=True,
        metavar="LIST.json",
    )
    size: int = option(
        256,
        label="Size",
        help="Width and height of a view; sharp materials need more",
        unit="texels",
        least=4,
        most=8192,
        draft=64,
        final=512,
    )
    samples: int = option(
        32,
        label="Samples",
        help="Samples of Cycles for each texel; more samples make less noise",
        least=2,
        most=1 << 24,
        draft=16,
        final=128,
    )
    denoise: bool = option(
        True,
        label="Denoise",
        help="Denoise each view: good for rough materials, bad for mirrors",
        final=False,
    )
    seed: int = option(
        0, label="Seed", help="Seed of Cycles' noise", least=0, most=(1 << 31) - 1, advanced=True
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.goal is not None and not self.fits_lobes:
            raise RangeError("A goal is for lobes fitted to the views: ask for them (Fit Lobes, More Views).")
        if self.photographs is not None and (self.more_views or self.goal) is not None:
            raise RangeError("Photographs are what they are: leave More Views and Goal out.")

    @property
    def expected(self) -> str:
        """See `MethodSettings`."""
        given = self.view_file or self.photographs
        return "" if given or self.views not in EXPECTED else f"{self.views} views are {EXPECTED[self.views]}"

    @property
    def fits_lobes(self) -> bool:
        """Whether lobes are fitted to the views."""
        return self.fit_lobes or self.more_views is not None

    @property
    def only_names_material(self) -> bool:
        """See `MethodSettings`."""
        return self.photographs is not None


RENDERING = ("samples", "denoise", "seed")
"""Settings that count for a material that is rendered, not for a model."""


@dataclass(frozen=True, kw_only=True)
class ViewsComparison(ComparisonOptions):
    """How radiance views are compared with what Cycles renders."""

    samples: int = samples_option()
    modes: tuple[Mode, ...] = option(
        tuple(Mode),
        label="Modes",
        help="Modes of drawing to compare",
        choices={mode: Choice(mode.title()) for mode in Mode},
        flag="--mode",
    )
    warpings: tuple[Warping, ...] = option(
        tuple(Warping),
        label="Warps",
        help="Warps to compare",
        choices={warping: Choice(warping.title()) for warping in Warping},
        flag="--warp",
    )
    captured_views: tuple[int, ...] = option(
        (),
        label="Captured Views",
        help="Draw from so many of the captured views only",
        choices={count: Choice(str(count)) for count in (12, 42, 162)},
    )
    material: str | None = option(
        None,
        label="Material",
        help="The material that was captured, where it is in a file",
        none="what the map set names",
        metavar="PRESET|FILE.blend:NAME|MODEL",
    )
