"""How lobes are fitted to a reflectance model: [Kautz2000], and beyond."""

from dataclasses import dataclass, replace

from ..core.brdf.gallery import GALLERY
from ..core.errors import RangeError
from ..core.options import Choice, Materials, Options, declared_options, option

MODEL_HELP = (
    "Reflectance model, as ggx:alpha=0.3,metal=copper, ward:alpha=0.04,ks=0.8 or merl:path=FILE; "
    "or a material, blend:FILE.blend:NAME"
)
MODELS = Materials(own="blend::{}", model=GALLERY["Metals"]["Brushed copper"])


@dataclass(frozen=True, kw_only=True)
class Fitting(Options):
    """Settings of every fit of lobes."""

    lobes: int = option(
        3,
        label="Lobes",
        help="Greatest number of lobes for each layer of the material; more lobes fit its reflectance better",
        least=1,
        most=12,
        draft=2,
        final=5,
        metavar="J",
    )
    slices: int = option(
        16,
        label="Elevations",
        help="View elevations at which the lobes are fitted",
        least=1,
        most=256,
        draft=8,
        final=32,
        metavar="K",
    )
    method: str = option(
        "joint",
        label="Fit",
        help="How the lobes are fitted",
        choices={
            "joint": Choice("Joint", "all profiles, colours and axes at once"),
            "greedy": Choice("Greedy", "lobe after lobe, each a minimum profile, as Kautz & McCool"),
            "single": Choice("Single", "one lobe, a mean profile"),
            "single-2d": Choice("Single 2D", "one lobe that all elevations share"),
        },
        advanced=True,
    )
    taps: int | None = option(
        None,
        label="Taps",
        help="Lookups into each lobe's map",
        least=1,
        most=9,
        none="as many as lower the error",
        none_as=0,
        advanced=True,
        metavar="T",
    )
    error: float | None = option(
        None,
        label="Error",
        help="Add lobes until the error is at most this",
        least=1e-6,
        most=1.0,
        none="all lobes",
        none_as=0.0,
        advanced=True,
        metavar="E",
    )
    non_negative: bool = option(
        False, label="Non-Negative", help="Give no kernel a negative weight", advanced=True
    )
    seek: str = option(
        "peaks",
        label="Seek",
        help="Where greedy fits place lobes",
        choices={
            "peaks": Choice("Peaks", "at the highest peak"),
            "places": Choice("Places", "at the best of peak, mirror direction, normal and view"),
            "search": Choice("Search", "anywhere, searched from coarse to fine"),
        },
        advanced=True,
    )

    cosine: str = option(
        "inside",
        label="Cosine",
        help="Where the cosine to the light is, in fits as Kautz & McCool's",
        choices={
            "inside": Choice("Inside", "in the lobes, which fit the reflectance times it"),
            "outside": Choice(
                "Outside", "outside the integral, as the cosine to the mirror direction (Eq. 2)"
            ),
        },
        advanced=True,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        joint = (self.taps or 1) > 1 or self.error is not None or self.non_negative
        if joint and self.method != "joint":
            raise RangeError(f"Taps, an error and signs are for the method joint, not {self.method}.")
        if self.seek != "peaks" and self.method != "greedy":
            raise RangeError(f"Where to seek lobes is for the method greedy, not {self.method}.")
        if self.cosine != "inside" and self.method == "joint":
            raise RangeError("A cosine outside is for the methods single, single-2d and greedy, not joint.")


FITTING = tuple(each.name for each in declared_options(Fitting))
"""Options of fits to a model alone."""


@dataclass(frozen=True, kw_only=True)
class FitSettings(Fitting):
    """Settings of a fit: the model and how it is fitted, or captured views, or both where a goal decides."""

    brdf: str | None = option(
        None,
        label="Model",
        help=MODEL_HELP,
        none="what was captured",
        metavar="SPEC",
        materials=replace(MODELS, instead="captures", spared=FITTING),
    )
    captures: str | None = option(
        None,
        label="Captures",
        help="Radiance views to fit lobes to, in the light that their file holds",
        none="fit the model",
        none_as="",
        subtype="FILE_PATH",
        metavar="NAME.rsibr.exr",
    )
    captured_views: int | None = option(
        None,
        label="Captured Views",
        help="Fit to the first of the captured views only",
        least=1,
        most=162,
        none="all of them",
        none_as=0,
        metavar="N",
    )
    goal: float | None = option(
        None,
        label="Goal",
        help="Where lobes fitted to captures predict views that are left out with a greater relative error, "
        "measure the captured material itself, and take lobes fitted to that if these are closer; a model "
        "beside the captures says where it is, if it is in a file",
        least=0.001,
        most=1.0,
        none="fit to captures alone",
        none_as=0.0,
        metavar="ERROR",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        neither, both = self.brdf is self.captures is None, None not in (self.brdf, self.captures)
        if neither or (both and self.goal is None):
            raise RangeError("Lobes are fitted to a reflectance model or to captures: give one of them.")
        if self.captures is None and self.goal is not None:
            raise RangeError("A goal is for fits to captures: give --captures, or leave the goal out.")
        if self.captures is None and self.captured_views is not None:
            raise RangeError("A model has no captured views: give --captures, or leave their number out.")
        given = [name for name in FITTING if getattr(self, name) != getattr(Fitting, name)]
        if self.captures is not None and given:
            raise RangeError(f"A fit to captures finds its own {', '.join(given)}: leave the options out.")
