"""What tables are made of, and how large: [Miller1984]."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from ..core.kinds.reflection_tables.bake import DIFFUSE_ROWS, LARGEST, TableSizes
from ..core.kinds.reflection_tables.material import PRESETS, changed_parts, preset
from ..core.kinds.reflection_tables.part_options import part_option
from ..core.options import Choice, Materials, option
from .comparison import ExactComparison, cycles_material_option, samples_option
from .method import MethodSettings

_OF_PRESET = "the preset's own, if any"


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
            parts=PRESETS,
        ),
    )
    diffuse: str | None = part_option("diffuse", _OF_PRESET)
    emission: str | None = part_option("emission", _OF_PRESET)
    specular: str | None = part_option("specular", _OF_PRESET)
    coat: str | None = part_option("coat", _OF_PRESET)
    retro: str | None = part_option("retro", _OF_PRESET)
    refraction: str | None = part_option("refraction", _OF_PRESET)
    weights: str | None = part_option("weights", _OF_PRESET)
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
        return changed_parts({} if self.material is None else preset(self.material), self)

    @property
    def sizes(self) -> TableSizes:
        """How many rows the tables have."""
        return TableSizes(self.diffuse_rows, self.rows)


@dataclass(frozen=True, kw_only=True)
class TablesComparison(ExactComparison):
    """How reflection tables are compared with what they stand for, or with a material of Cycles'."""

    material: str | None = cycles_material_option()
    samples: int = samples_option()
