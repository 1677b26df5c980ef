"""How environments are made of scenes, six photographs and paintings."""

from dataclasses import dataclass

from ..core.maps.representation import representation
from ..core.options import Choice, Options, option
from .light import Clamp, KnownScale, UnknownScale

LAYOUTS = {
    name: Choice(name.replace("_", " ").title())
    for name in (
        "equirect",
        "sphere_map",
        "mirror_ball",
        "angular_map",
        "dual_paraboloid",
        "orthographic",
        "octahedral",
        "cube_faces",
        "cube_cross",
        "cube_strip",
    )
}
"""Layouts of pictures that are taken and written: see `files.map_pictures.layout`."""

LARGEST = 16384
"""Width of the largest map in texels."""


@dataclass(frozen=True, kw_only=True)
class EnvironmentSize(Options):
    """How large an environment is made."""

    size: int = option(
        1024,
        label="Size",
        help="Width of the environment, even; it is half as high",
        unit="texels",
        least=8,
        most=LARGEST,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        representation("equirect").shape(self.size)


@dataclass(frozen=True, kw_only=True)
class Scene(EnvironmentSize):
    """Which scene."""

    scene: str | None = option(
        None,
        label="Scene",
        help="Name of the scene",
        none="the one the file was saved with",
        none_as="",
        metavar="NAME",
    )


@dataclass(frozen=True, kw_only=True)
class WorldLight(Scene, Clamp, KnownScale):
    """Which world is sampled."""


@dataclass(frozen=True, kw_only=True)
class Capture(EnvironmentSize):
    """How well Cycles renders the light around a point."""

    samples: int = option(
        128,
        label="Samples",
        help="Samples of Cycles for each texel; with six faces for each pixel, about three to a texel",
        least=1,
        most=1 << 24,
    )
    faces: bool = option(
        False, label="Six Faces", help="Render the six faces of a cube instead of a panorama"
    )
    denoise: bool = option(False, label="Denoise", help="Denoise what is rendered")
    seed: int = option(0, label="Seed", help="Seed of Cycles' noise", least=0, most=(1 << 31) - 1)


@dataclass(frozen=True, kw_only=True)
class SceneLight(Capture, Scene, KnownScale):
    """What light is captured, and how well."""

    subject: str | None = option(
        None,
        label="Object",
        help="The object that will be lit: it is left out, with its children (lamps excepted) and instances, "
        "and the map is made around its middle",
        none="nothing is left out",
        flag="--object",
        metavar="NAME",
    )
    point: tuple[float, float, float] | None = option(
        None,
        label="Point",
        help="Where the map is made, in world coordinates",
        none="the middle of the object, or else the 3D cursor",
        metavar="X,Y,Z",
    )
    frame: int | None = option(
        None,
        label="Frame",
        help="Frame of the animation",
        least=-1048574,
        most=1048574,
        none="the frame the file was saved at",
    )


@dataclass(frozen=True, kw_only=True)
class FacesSettings(EnvironmentSize, Clamp, UnknownScale):
    """How six photographs are put together."""

    balance: bool = option(
        False,
        label="Balance",
        help="Scale each photograph so that they agree along the edges: for a camera that chose its "
        "exposures itself",
    )


@dataclass(frozen=True, kw_only=True)
class PaintedSettings(EnvironmentSize, KnownScale):
    """How a painting is laid out, and what its white means."""

    source_layout: str = option(
        "equirect",
        label="Layout",
        help="How the picture is laid out",
        choices=LAYOUTS,
        flag="--from",
        metavar="LAYOUT",
    )
    white: tuple[float, float, float] = option(
        label="White",
        help="Radiance of white in red, green and blue; darker colours are lifted less",
        least=1.0,
        start=(10.0, 10.0, 10.0),
        metavar="RADIANCE|R,G,B",
    )
    knee: float = option(
        0.7, label="Knee", help="Linear luminance below which nothing is lifted", least=0.0, most=0.99
    )
