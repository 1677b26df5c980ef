"""What a picture shows, from where, and how large."""

import math
from dataclasses import dataclass
from enum import StrEnum

from ..core.errors import RangeError
from ..core.geometry.camera import Camera
from ..core.options import Choice, Options, option
from .light import Clamp, exposure_option
from .matte import MatteOptions


@dataclass(frozen=True, kw_only=True)
class MeshOptions(Options):
    """What is drawn."""

    mesh: str = option(
        "sphere",
        label="Mesh",
        help="sphere, monkey or a file, OBJ, PLY or STL; fitted into the unit sphere, which fills the frame",
        metavar="MESH",
    )


@dataclass(frozen=True, kw_only=True)
class CameraOptions(Options):
    """How it is projected."""

    perspective: float | None = option(
        None,
        label="Perspective",
        help="Angle of view",
        unit="degrees",
        least=0.1,
        most=179.0,
        none="orthographic",
        none_as=0.0,
        metavar="DEG",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self.camera((0.0, -1.0, 0.0))

    def camera(self, view_dir: tuple[float, float, float]) -> Camera:
        """The camera that sees the object from a direction of any positive length, in world coordinates."""
        return Camera(view_dir, None if self.perspective is None else math.radians(self.perspective))


@dataclass(frozen=True, kw_only=True)
class SceneOptions(MeshOptions, CameraOptions):
    """What is drawn, and how large."""

    size: int = option(
        512, label="Size", help="Width and height of a picture", unit="pixels", least=1, most=2048
    )


@dataclass(frozen=True, kw_only=True)
class ShownOptions(CameraOptions):
    """From where it is seen, and how its radiance is shown."""

    view: tuple[float, float, float] = option(
        (0.0, -1.0, 0.0), label="View", help="Direction from the object to the eye", metavar="X,Y,Z"
    )
    exposure: float = exposure_option(
        0.0, "How much brighter PNG, movie or page are; EXR holds radiance as it is"
    )
    view_transform: str = option(
        "Standard",
        label="View Transform",
        help="How PNG, movie or page show radiance",
        choices={
            "Standard": Choice("Standard", "as it is, up to white"),
            "AgX": Choice("AgX", "as film, which keeps detail in lamps"),
            "Filmic": Choice("Filmic", "as AgX's predecessor"),
            "Khronos PBR Neutral": Choice("Khronos PBR Neutral", "keeps the colours of materials"),
            "False Color": Choice("False Color", "colours for brightness"),
        },
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self.camera(self.view)


class Turned(StrEnum):
    """What a turntable turns about Z."""

    EYE = "eye"
    OBJECT = "object"
    LIGHT = "light"


@dataclass(frozen=True, kw_only=True)
class PreviewOptions(SceneOptions, ShownOptions, MatteOptions, Clamp):
    """What a preview shows."""

    fill: float = option(
        1.0,
        label="Fill",
        help="Share of the frame's width that the object has: less shows more of what is around it",
        least=0.05,
        most=1.0,
        metavar="F",
    )
    turntable: int | None = option(
        None,
        label="Turntable",
        help="Frames of a whole turn about Z: a contact sheet in OUT and a movie beside it, OUT.mp4",
        least=2,
        none="a single picture",
    )
    turned: Turned = option(
        Turned.EYE,
        label="Turned",
        help="What a turntable turns",
        choices={
            Turned.EYE: Choice("Eye", "who looks goes around the object, in light that stays"),
            Turned.OBJECT: Choice("Object", "the object turns in front of the eye, in light that stays"),
            Turned.LIGHT: Choice("Light", "light turns around the object"),
        },
        flag="--turn",
    )
    exact: str | None = option(
        None,
        label="Exact",
        help="Show this reflectance model itself, integrated over the map set's light for each pixel, "
        "instead of what its maps hold: ggx:alpha=0.3,metal=copper, merl:path=FILE or blend:FILE.blend:NAME",
        none="the maps",
        metavar="SPEC",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.exact is not None and (self.perspective is not None or self.turntable is not None):
            raise RangeError(
                "A model itself is shown in one orthographic picture: leave the perspective and the "
                "turntable out."
            )
