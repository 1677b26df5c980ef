"""What tables are made of, and how large: [Miller1984]."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from ..core.kinds.reflection_tables.bake import DIFFUSE_ROWS, LARGEST, TableSizes
from ..core.kinds.reflection_tables.material import PARTS, PRESETS, preset
from ..core.options import Choice, Materials, option
from .method import MethodSettings


def _part(label: str, help: str) -> Any:
    return option(
        None,
        label=label,
        help=help,
        none="the preset's own, if any",
        none_as="",
        advanced=True,
        metavar="SPEC",
    )


@dataclass(frozen=True, kw_only=True)
class ReflectionTablesSettings(MethodSettings):
    """Settings of reflection tables."""

    KIND: ClassVar = "reflection_tables"
    LABEL: ClassVar = "Reflection Tables"
    SUMMARY: ClassVar = "Simple materials: diffuse, mirror, varnish, glass"

    material: str | None = option(
        None,
        label="Material",
        help=f"Parts to start from: {', '.join(PRESETS)}; given parts replace those of the preset",
        none="only the parts that are given",
        metavar="PRESET",
        materials=Materials(
            presets={
                name: Choice(
                    name.replace("-", " ").title(),
                    ", ".join(f"{part} {text}" for part, text in parts.items()),
                )
                for name, parts in PRESETS.items()
            },
            preset=next(iter(PRESETS)),
        ),
    )
    diffuse: str | None = _part("Diffuse", "Light by the normal: lambert:kd=0.5/0.4/0.3 or luminous:kd=0.5")
    emission: str | None = _part("Emission", "Radiance that is added to the diffuse table: 2/1/0.5")
    specular: str | None = _part(
        "Specular", "Light by the mirror direction: mirror:ks=0.9 or phong:n=50,ks=0.3"
    )
    coat: str | None = _part(
        "Coat",
        "Clear varnish, which mirrors its share and lets the rest through: fresnel:eta=1.5, constant:k=0.5",
    )
    retro: str | None = _part(
        "Retro-Reflection", "Light by the view direction: phong:n=200,ks=0.3 or mirror:"
    )
    refraction: str | None = _part(
        "Refraction", "Light by the refracted direction: clear:eta=1.5,tint=1/0.9/0.8"
    )
    weights: str | None = _part(
        "Weights",
        "How angles share light out between the tables: fresnel:eta=1.5, fresnel:metal=copper or "
        "albedo:brdf=(BRDF), a BRDF's albedo part by part",
    )
    diffuse_rows: int = option(
        DIFFUSE_ROWS,
        label="Diffuse Rows",
        help="Height of the diffuse table, which is twice as wide; diffuse light changes slowly",
        unit="texels",
        least=1,
        most=LARGEST,
        draft=18,
        final=72,
    )
    rows: int | None = option(
        None,
        label="Rows",
        help="Height of the other tables, which are twice as wide",
        unit="texels",
        least=1,
        most=LARGEST,
        none="what the lobes need; for a mirror, the environment's own",
        none_as=0,
    )
    exact: bool = option(
        False,
        label="Exact",
        help="Sum lobes over all texels by brute force: slow, for comparison",
        advanced=True,
    )

    @property
    def parts(self) -> Mapping[str, str]:
        """Part -> its text: the preset's, and those that were given."""
        given = {part: getattr(self, part) for part in PARTS if getattr(self, part) is not None}
        return ({} if self.material is None else preset(self.material)) | given

    @property
    def sizes(self) -> TableSizes:
        """How many rows the tables have."""
        return TableSizes(self.diffuse_rows, self.rows)
