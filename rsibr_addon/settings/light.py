"""The light that is baked."""

from dataclasses import dataclass

from ..core.options import Options, option


@dataclass(frozen=True, kw_only=True)
class Clamp(Options):
    """How bright light may be."""

    clamp: float | None = option(
        None,
        label="Clamp",
        help="Take brighter radiance, also where it is infinite, as this, and say how many values that are",
        least=1e-30,
        most=1e30,
        soft_most=1e5,
        none="what is infinite is taken as the greatest value that is not",
        none_as=0.0,
        metavar="VALUE",
    )


@dataclass(frozen=True, kw_only=True)
class Light(Clamp):
    """Which light is baked, and how bright it may be."""

    environment: str | None = option(
        None,
        label="Environment",
        help="Latitude-longitude picture (EXR or HDR), or the bare name of one of Blender's own, as forest",
        none="the world of the open file",
        none_as="",
        metavar="FILE",
    )
