"""A toy export format: the mean colour of every texture, as text. As a module of `tasks/export`."""

from dataclasses import dataclass
from pathlib import Path

from rsibr.rsibr_addon.core.options import Options, option
from rsibr.rsibr_addon.files.atomic import written_aside
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.textures import Up
from rsibr.rsibr_addon.tasks.export.format import Format, textures_of


@dataclass(frozen=True)
class MeansSettings(Options):
    """How exactly colours are written."""

    digits: int = option(3, label="Digits", help="Digits after the point", least=0, most=9)


def write(map_set: Path, held: MapSet, output: Path, settings: MeansSettings, force: bool) -> list[Path]:
    means = [texture.levels[0].mean(axis=(0, 1, 2)) for texture in textures_of(map_set, held, Up.Z)]
    lines = (" ".join(f"{value:.{settings.digits}f}" for value in mean) for mean in means)
    with written_aside(output, force) as aside:
        aside.write_text("\n".join(lines))
    return [output]


FORMAT = Format("Mean Colours", ".means", MeansSettings, write)
