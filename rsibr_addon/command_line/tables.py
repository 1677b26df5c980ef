"""Make reflection tables of a material from an environment."""

import argparse
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_environment(parser)
    parser.add_argument(
        "--material",
        metavar="PRESET",
        help="parts to start from: chrome, matte, plastic, varnished, copper, gold, silver, satin, "
        "car-paint, glass, cats-eye, glowing; those given below replace its own",
    )
    material = parser.add_argument_group("parts of the material", argument_default=argparse.SUPPRESS)
    material.add_argument(
        "--diffuse", metavar="SPEC", help="by the normal: lambert:kd=0.5/0.4/0.3 or luminous:kd=0.5"
    )
    material.add_argument("--emission", metavar="R/G/B", help="radiance that is added to the diffuse table")
    material.add_argument(
        "--specular", metavar="SPEC", help="by the mirrored view: mirror:ks=0.9 or phong:n=50,ks=0.3"
    )
    material.add_argument(
        "--coat",
        metavar="SPEC",
        help="a clear varnish, which mirrors its share and lets the rest through: fresnel:eta=1.5 or "
        "constant:k=0.5",
    )
    material.add_argument("--retro", metavar="SPEC", help="by the view itself: phong:n=200,ks=0.3 or mirror:")
    material.add_argument(
        "--refraction", metavar="SPEC", help="by the refracted view: clear:eta=1.5,tint=1/0.9/0.8"
    )
    material.add_argument(
        "--weights",
        metavar="SPEC",
        help="how angles share light out between the tables: fresnel:eta=1.5, fresnel:metal=copper or "
        "albedo:brdf=(BRDF), a BRDF's albedo part by part",
    )
    parser.add_argument(
        "--diffuse-rows",
        metavar="N",
        type=options.positive,
        default=36,
        help="of the diffuse table; tables have twice as many columns (default: %(default)s)",
    )
    parser.add_argument(
        "--rows",
        metavar="N",
        type=options.positive,
        help="of the other tables (default: as their lobes need; a mirror's as the environment)",
    )
    parser.add_argument(
        "--exact", action="store_true", help="sum lobes over all texels by brute force: slow, for comparison"
    )
    options.add_output(parser, "NAME.rsibr.exr", "the map set to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Make the tables.

    Returns
    -------
    dict
        "map_set", the path of the file.

    Raises
    ------
    RsibrError
        See `tasks.methods.reflection_tables`.
    """
    from ..core.kinds.reflection_tables.bake import TableSizes
    from ..core.kinds.reflection_tables.material import PARTS, preset
    from ..tasks.methods.reflection_tables import TableSettings, bake_table_set

    given = {part: text for part, text in vars(arguments).items() if part in PARTS}
    base = {} if arguments.material is None else preset(arguments.material)
    settings = TableSettings(
        base | given, TableSizes(arguments.diffuse_rows, arguments.rows), arguments.exact
    )
    target = arguments.output, arguments.force
    path = report.steps(bake_table_set(arguments.environment, settings, *target, arguments.clamp))
    report.say(f"{path}: {', '.join(f'{part} {text}' for part, text in settings.material.items())}")
    return {"map_set": str(path)}
