"""The light that is baked."""

from dataclasses import dataclass

from ..core.options import Options, option


@dataclass(frozen=True, kw_only=True)
class Clamp(Options):
    """How bright light may be."""

    clamp: float | None = option(
        None,
        label="Clamp",
        help="Greatest radiance: brighter and infinite values become this, and a warning counts them",
        least=1e-30,
        most=1e30,
        soft_most=1e5,
        none="infinite values become the greatest finite one",
        none_as=0.0,
        metavar="VALUE",
    )


@dataclass(frozen=True, kw_only=True)
class Light(Clamp):
    """Which light is baked, and how bright it may be."""

    environment: str | None = option(
        None,
        label="Environment",
        help="Latitude-longitude picture (EXR or HDR), or the name of one of Blender's own, such as forest",
        none="the world of the open file",
        none_as="",
        metavar="FILE",
    )
    bare_world: bool = option(
        False,
        label="Bare World",
        help="Bake the Environment Texture of the open file's world without rotation and strength, which "
        "previews add that follow the world",
        advanced=True,
    )
