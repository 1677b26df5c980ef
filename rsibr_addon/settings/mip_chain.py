"""How an environment is filtered into mips: [Kautz2004], and as engines do."""

import math
from dataclasses import dataclass
from typing import ClassVar

from ..core.errors import RangeError
from ..core.kinds.mip_chain.chain import LARGEST, MOST_DEGREES, check_roughness, check_size
from ..core.kinds.mip_chain.ggx import ROUGHNESS_RULES
from ..core.kinds.mip_chain.phong import box_exponents, check_exponents
from ..core.kinds.mip_chain.shading import MipLook
from ..core.options import Choice, option
from .comparison import ExactComparison, cycles_material_option, option_of_look, samples_option
from .method import MethodSettings
from .probes import ADD_PROBE, ProbeOptions, probes_from_text

HIGHEST = 16384
"""Rows of texels that a texture of all chains may take, as graphics cards have them."""

MOST_PROBES = 255
"""Most that a map set numbers."""


@dataclass(frozen=True, kw_only=True)
class MipChainSettings(MethodSettings):
    """Settings of mip chains."""

    KIND: ClassVar = "mip_chain"
    LABEL: ClassVar = "Mip Chain"
    SUMMARY: ClassVar = "Light alone, for any roughness: as game engines use it"
    REMARK: ClassVar = (
        "A mip chain holds light alone: choose colours in Look. A rough rim before a sun is too "
        "bright: choose Own Materials or a Lobe Stack for those."
    )

    filter: str = option(
        "ggx",
        label="Filter",
        help="How each mip is made",
        choices={
            "ggx": Choice("GGX", "the highlight of a rough surface, as engines use it"),
            "phong": Choice("Phong", "the highlight that box filters stand for in the paper of 2004"),
            "bordered": Choice("Bordered", "means of neighbouring texels, across the cube's edges"),
            "box": Choice("Box", "means within each face of the cube, as in the paper of 2004"),
        },
    )
    size: int = option(
        256,
        label="Size",
        help="Width of the sharpest mip's faces, a power of 2",
        unit="texels",
        least=1,
        most=LARGEST,
        offered=(64, 128, 256, 512, 1024),
        draft=64,
        final=512,
    )
    roughness: str | tuple[float, ...] = option(
        "linear",
        label="Roughness",
        help="How roughness grows from mip to mip of the filter ggx; or the roughness of each mip, "
        "ascending from 0 to 1",
        choices={
            "linear": Choice("Linear", "mip / last, the same step from each mip to the next"),
            "quadratic": Choice("Quadratic", "1 - sqrt(1 - mip / last), finer where highlights are sharp"),
        },
        metavar="RULE|R0,R1,...",
    )
    exponents: tuple[float, ...] | None = option(
        None,
        label="Exponents",
        help="Exponent of each mip of the filter phong, descending to 1; a 0 leaves a mip unfiltered",
        least=0.0,
        none="as blurred as the same mip of the filter box",
        none_as="",
        metavar="N0,N1,...",
        advanced=True,
    )
    probes: str | None = option(
        None,
        label="Probes",
        help="Light of rooms, by files or names, for the points in them; between rooms it is blended, and "
        "beyond them it is the light of the bake: box:light=hall.exr,size=6/5/3,middle=0/0/1.5,at=1/0/1.5,"
        "blend=0.5;sphere:... in world coordinates",
        none="none",
        none_as="",
        metavar="ROOM:KEY=VALUE,...;...",
        adds=ADD_PROBE,
        advanced=True,
    )
    degree: int = option(
        2,
        label="Degree",
        help="Degree of the harmonics of diffuse light: 2 is the paper's nine numbers; more follow small "
        "lamps",
        least=0,
        most=MOST_DEGREES,
        final=8,
        metavar="L",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        check_size(self.size, 1)
        probes = len(self.rooms)
        if probes > MOST_PROBES:
            raise RangeError(f"A mip chain holds at most {MOST_PROBES} probes, not {probes}: give fewer.")
        if probes and (1 + probes) * _rows(self.size) > HIGHEST:
            fits = [size for size in (2**n for n in range(14)) if (1 + probes) * _rows(size) <= HIGHEST]
            raise RangeError(
                f"{probes} probes of {self.size} texels do not fit into a texture: choose a size of "
                f"at most {max(fits)}."
            )
        if self.exponents is not None:
            if self.filter != "phong":
                raise RangeError(
                    f"The filter {self.filter} knows no exponents: leave them out, or choose phong."
                )
            check_size(self.size, len(self.exponents))
            check_exponents(self.phong_exponents)
        if isinstance(self.roughness, str):
            return
        if self.filter != "ggx":
            raise RangeError(f"The filter {self.filter} knows no roughness: leave it out, or choose ggx.")
        check_size(self.size, len(self.roughness))
        check_roughness(self.roughness)

    @property
    def expected(self) -> str:
        """See `MethodSettings`; measured in docs/mip-chains.md."""
        is_usual = self.filter == "ggx" and self.size >= 128
        return "Plastic of roughness .3 is 2 % off, rough metal 26 %" if is_usual else ""

    @property
    def rooms(self) -> tuple[ProbeOptions, ...]:
        """The probes."""
        return probes_from_text(self.probes or "")

    @property
    def roughnesses(self) -> tuple[float, ...]:
        """Roughness of every mip of the filter ggx."""
        if isinstance(self.roughness, str):
            return ROUGHNESS_RULES[self.roughness](self.size.bit_length())
        return self.roughness

    @property
    def phong_exponents(self) -> tuple[float, ...]:
        """Exponent of every mip of the filter phong."""
        if self.exponents is None:
            return box_exponents(self.size)
        return tuple(exponent or math.inf for exponent in self.exponents)


@dataclass(frozen=True, kw_only=True)
class MipComparison(ExactComparison):
    """How mip chains are compared with the reflectance that they approximate, or with a material of Cycles'.

    Raises
    ------
    RangeError
        Neither a roughness nor an exponent is given, or both are.
    """

    f0: tuple[float, float, float] = option_of_look(MipLook, "f0")
    kd: tuple[float, float, float] = option_of_look(MipLook, "kd")
    roughness: float | None = option_of_look(MipLook, "roughness", replaces=(), none="that of an exponent")
    exponent: float | None = option_of_look(MipLook, "exponent", replaces=("roughness",))
    material: str | None = cycles_material_option()
    samples: int = samples_option()

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.roughness is None and self.exponent is None:
            raise RangeError("Mips are compared as a material has them: give a roughness or an exponent.")


def _rows(size: int) -> int:
    """Rows of texels that a chain takes at most, each mip with a border of one texel."""
    return 2 * size + 2 * size.bit_length()
