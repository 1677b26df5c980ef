"""How `rsibr preview` shades each kind of map set, as options."""

import argparse
from typing import Any

from .options import colour, positive, whole_numbers

WEIGHTS = ("w_diffuse", "w_specular", "w_coat", "w_retro", "w_refraction")

KIND_OF: dict[str, tuple[str, ...]] = {
    "mode": ("radiance_views",),
    "warping": ("radiance_views",),
    "lobes": ("lobe_stack",),
    "shown": ("reflection_tables",),
    **dict.fromkeys(WEIGHTS, ("reflection_tables",)),
    "antialiased": ("radiance_views", "lobe_stack", "reflection_tables", "mip_chain", "environment"),
    "f_lambda": ("mip_chain", "environment"),
    "k_d": ("mip_chain",),
    "bias": ("mip_chain",),
    "roughness": ("mip_chain", "kernel_bank"),
    "borders": ("mip_chain",),
    "brdf": ("kernel_bank",),
    "lobe_count": ("kernel_bank",),
}
"""Name of an option's value, and of the look's field -> the kinds of map sets that have it."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare every kind's options; those that are not given are not in the namespace."""
    views = parser.add_argument_group("radiance views", argument_default=argparse.SUPPRESS)
    views.add_argument(
        "--mode",
        choices=["paper", "texel", "fragment"],
        help="warp once a frame on a tessellated disk, once a frame for each texel, or for each fragment "
        "with its own view (default: fragment)",
    )
    views.add_argument(
        "--warp",
        dest="warping",
        choices=["single", "split", "albedo"],
        help="mirror warp for the whole radiance; normal warp for diffuse and mirror warp for glossy; "
        "or these with the material's directional albedo taken out and put back (default: albedo)",
    )
    stacks = parser.add_argument_group("lobe stacks", argument_default=argparse.SUPPRESS)
    stacks.add_argument(
        "--lobes",
        metavar="NUMBERS",
        type=whole_numbers,
        help="those that count, from 0, as 0,2 (default: all)",
    )
    tables = parser.add_argument_group("reflection tables", argument_default=argparse.SUPPRESS)
    tables.add_argument(
        "--tables",
        dest="shown",
        metavar="NAMES",
        type=lambda text: tuple(text.split(",")),
        help="those that count, of diffuse,specular,coat,retro,refraction (default: all)",
    )
    for name in WEIGHTS:
        table = name.removeprefix("w_")
        tables.add_argument(
            f"--w-{table}",
            dest=name,
            metavar="W",
            type=float,
            help=f"multiplies the weight of {table} (default: 1)",
        )
    mips = parser.add_argument_group("mip chains and environments", argument_default=argparse.SUPPRESS)
    mips.add_argument(
        "--f-lambda",
        metavar="F|R,G,B",
        type=colour,
        help="reflectance of the glossy part at normal incidence, 0 to 1 (default: 0.04; of an environment's "
        "mirror 1)",
    )
    mips.add_argument(
        "--k-d",
        metavar="K|R,G,B",
        type=colour,
        help="albedo of the diffuse part, 0 to 1 (default: 0.8)",
    )
    mips.add_argument(
        "--bias", metavar="B", type=float, help="mip that glossy light comes from, 2.3 say (default: 0)"
    )
    mips.add_argument(
        "--roughness",
        metavar="R",
        type=float,
        help="instead of the bias, of a chain of the filter ggx; or of a kernel bank's model, whose alpha is "
        "its square",
    )
    mips.add_argument(
        "--borders",
        choices=["seamless", "clamped"],
        help="interpolate with the neighbouring face's texels, or as the hardware of 2004 did with the "
        "face's own (default: seamless)",
    )
    several = parser.add_argument_group("several kinds", argument_default=argparse.SUPPRESS)
    several.add_argument(
        "--antialiased",
        action=argparse.BooleanOptionalAction,
        help="average what each pixel reflects (default: yes, but for reflection tables)",
    )
    banks = parser.add_argument_group("kernel banks", argument_default=argparse.SUPPRESS)
    banks.add_argument(
        "--brdf",
        metavar="SPEC",
        help="the reflectance model, as rsibr bake takes it (default: ggx:alpha=0.3,metal=copper)",
    )
    banks.add_argument(
        "--lobe-count", metavar="J", type=positive, help="for each layer of the model (default: 3)"
    )


def look(arguments: argparse.Namespace, kind: str) -> Any:
    """The look that the options ask for.

    Parameters
    ----------
    arguments : Namespace
    kind : str
        Of the map set.

    Returns
    -------
    object
        Of the kind's own type, see `core.kinds`.

    Raises
    ------
    RangeError
        An option is of another kind of map sets, or its value out of range.
    """
    from ..core.errors import RangeError
    from ..tasks.methods.kinds import KINDS

    given = {name: value for name, value in vars(arguments).items() if name in KIND_OF}
    for name in given:
        if kind not in KIND_OF[name]:
            kinds = " or ".join(KIND_OF[name])
            raise RangeError(f"The option for {name} is for {kinds}, but this map set holds {kind}: omit it.")
    return KINDS[kind].look(**given)
