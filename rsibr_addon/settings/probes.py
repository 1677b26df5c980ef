"""Light of rooms, as a text.

``box:light=hall.exr,size=6/5/3,middle=0/0/1.5,at=1/0/1.5,blend=0.5;sphere:light=...``. Each probe is a
picture of an environment that was captured at a point of a room, and the room. Members of
a place are separated by slashes, as those of colours are.
"""

from dataclasses import dataclass

from ..core.errors import RangeError
from ..core.geometry.near_room import Room
from ..core.kinds.mip_chain.probes import Place
from ..core.kinds.mip_chain.shading import ROOMS, point_option, room_middle_option, room_size_option
from ..core.options import Options, declared_options, option, value_from_text, value_text

ADD_PROBE = "rsibr.add_probe"
"""The operator of Blender's that adds one to a text."""

BETWEEN = ";"
"""Between the texts of two probes."""


@dataclass(frozen=True, kw_only=True)
class ProbeOptions(Options):
    """A probe.

    Raises
    ------
    RangeError
        A value is out of range, or the picture's path has what separates texts.
    """

    light: str = option(
        label="Picture",
        help="Latitude-longitude picture that was captured in the room, or a built-in one by name",
        subtype="FILE_PATH",
    )
    room: Room = option(
        Room.BOX,
        label="Room",
        help="What stands for its walls",
        choices={room: choice for room, choice in ROOMS.items() if room is not Room.DISTANT},
    )
    size: tuple[float, float, float] = room_size_option()
    middle: tuple[float, float, float] = room_middle_option()
    at: tuple[float, float, float] = point_option("Captured At", "Where the picture was captured")
    blend: float = option(
        0.5,
        label="Blend",
        help="Distance beyond the room's border at which its light has passed into that of the next room",
        least=1e-3,
        most=1e6,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if any(mark in self.light for mark in (BETWEEN, ",")):
            raise RangeError(f"{self.light} has a comma or a semicolon in its path: rename it.")

    @property
    def place(self) -> Place:
        """Where the light was captured, and its room."""
        return Place(self.at, self.room, self.size, self.middle, self.blend)

    @property
    def text(self) -> str:
        """The text that `probes_from_text` takes back."""
        values = {each.name: getattr(self, each.name) for each in _KEYS}
        told = ",".join(f"{name}={value_text(value).replace(',', '/')}" for name, value in values.items())
        return f"{self.room}:{told}"


_KEYS = [each for each in declared_options(ProbeOptions) if each.name != "room"]


def probes_from_text(text: str) -> tuple[ProbeOptions, ...]:
    """The probes that a text describes.

    Raises
    ------
    RangeError
        It describes none; one sentence says what is wrong.
    """
    return tuple(_probe(each.strip()) for each in text.split(BETWEEN) if each.strip())


def _probe(text: str) -> ProbeOptions:
    room, _, rest = text.partition(":")
    known = {each.name: each for each in _KEYS}
    values = {}
    for part in rest.split(","):
        name, _, value = (piece.strip() for piece in part.partition("="))
        if name not in known or not value or name in values:
            raise RangeError(
                f'A probe cannot have "{part}": give each of {", ".join(known)} once, as KEY=VALUE.'
            )
        is_number = known[name].wanted is not str
        try:
            values[name] = value_from_text(known[name], value.replace("/", ",") if is_number else value)
        except ValueError as error:
            raise RangeError(f"{known[name].option.label} of a probe: {error}.") from error
    if "light" not in values:
        raise RangeError(f'The probe "{text}" has no picture: write light=FILE.')
    return ProbeOptions(room=room.strip(), **values)  # type: ignore[arg-type]  # checked, and made a Room
