"""How photographs at several exposures are merged, and those of mirrored balls unwrapped."""

from dataclasses import dataclass

from ..core.errors import RangeError
from ..core.options import Choice, Options, option
from .environment import EnvironmentSize
from .light import Clamp, KnownScale, UnknownScale, card_option


def _times(label: str, help: str) -> tuple[float, ...] | None:
    times: tuple[float, ...] | None = option(
        None,
        label=label,
        help=f"{help}, 1/125 or 0.5, one for each in the order in which they are listed",
        unit="s",
        least=1e-6,
        most=1e6,
        none="what the files tell",
        none_as="",
        once=True,
        metavar="T,T,...",
    )
    return times


def _circle(label: str, help: str) -> tuple[float, float, float] | None:
    circle: tuple[float, float, float] | None = option(
        None,
        label=label,
        help=f"{help}: its middle and radius, from the top left corner of the photograph as it is stored, "
        "not turned by its Exif",
        unit="pixels",
        none="found",
        none_as=(0.0, 0.0, 0.0),
        once=True,
        metavar="X,Y,R",
    )
    return circle


def _angle(default: float, label: str, help: str, least: float, most: float) -> float:
    angle: float = option(
        default,
        label=label,
        help=help,
        unit="degrees",
        least=least,
        most=most,
        subtype="ANGLE",
        metavar="DEG",
    )
    return angle


@dataclass(frozen=True, kw_only=True)
class BracketKnowledge(Options):
    """What is known of the photographs of a bracket."""

    times: tuple[float, ...] | None = _times("Exposure Times", "Exposure times")
    times_file: str | None = option(
        None,
        label="Times File",
        help="Text file with the exposure times",
        none="none",
        none_as="",
        subtype="FILE_PATH",
        once=True,
        metavar="FILE",
    )
    curve: str = option(
        "recovered",
        label="Curve",
        help="How the camera encodes light; OpenEXR and Radiance HDR are linear",
        choices={
            "recovered": Choice("Recovered", "found from the photographs"),
            "srgb": Choice("sRGB", "known to be that of sRGB"),
            "linear": Choice("Linear", "known to be none"),
        },
    )
    align: bool = option(True, label="Align", help="Undo the camera's movements between the photographs")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.times is not None and self.times_file is not None:
            raise RangeError("Exposure times and a file of them are both given: leave one of the two out.")


@dataclass(frozen=True, kw_only=True)
class BracketSettings(BracketKnowledge, KnownScale):
    """How photographs of a bracket are merged."""


@dataclass(frozen=True, kw_only=True)
class BallBrackets(BracketKnowledge):
    """What is known of the exposures of a ball, from one side and from another."""

    second_times: tuple[float, ...] | None = _times("Second Times", "Exposure times of the second side")


@dataclass(frozen=True, kw_only=True)
class BallDistance(Options):
    """Where the camera of a mirrored ball was."""

    distance: float | None = option(
        None,
        label="Distance",
        help="Distance of the camera from the middle of a mirrored ball, in radii of the ball",
        least=1.001,
        most=1e6,
        none="far away",
        none_as=0.0,
    )


@dataclass(frozen=True, kw_only=True)
class BallSettings(EnvironmentSize, BallDistance, Clamp, UnknownScale):
    """How photographs of a mirrored ball were taken. Two sides together show all directions."""

    circle: tuple[float, float, float] | None = _circle("Circle", "The ball's outline")
    field_of_view: float | None = option(
        None,
        label="Field of View",
        help="Angle of view of the uncropped photographs' longer side; it gives the distance",
        unit="degrees",
        least=1.0,
        most=179.0,
        none="not known",
        none_as=0.0,
        subtype="ANGLE",
        flag="--fov",
        metavar="DEG",
    )
    elevation: float = _angle(0.0, "Elevation", "How far the camera looked down on the ball", -89.0, 89.0)
    camera: float = _angle(
        15.0,
        "Camera",
        "How far from its middle the camera and who held it show in the ball, as an angle of direction; "
        "there the other side counts",
        0.0,
        179.0,
    )
    turn: float = _angle(
        90.0,
        "Turn",
        "How far the camera went around the ball for the second side, counterclockwise as seen from above",
        -360.0,
        360.0,
    )
    second_circle: tuple[float, float, float] | None = _circle(
        "Second Circle", "The ball's outline in the second side's photographs"
    )
    reflectance: tuple[float, float, float] = option(
        (1.0, 1.0, 1.0),
        label="Reflectance",
        help="Reflectance of the ball at normal incidence, which its light is divided by: some 0.9 of "
        "silvered glass, 0.5 to 0.6 of steel",
        least=0.01,
        most=1.0,
        subtype="COLOR",
        metavar="F|R,G,B",
    )
    card: tuple[float, float, float] | None = card_option("the first photograph as it is stored")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.distance is not None and self.field_of_view is not None:
            raise RangeError("Distance and field of view both tell where the camera was: give one of them.")
