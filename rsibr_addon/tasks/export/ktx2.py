"""KTX 2.0 files, with what their shaders have to know."""

import json
from dataclasses import dataclass
from pathlib import Path

from ...core.options import Choice, Options, option
from ...files.kinds.registry import STORED
from ...files.ktx2 import write_ktx2
from ...files.map_set_data import MapSet
from ...files.textures import Up
from .format import Format, textures_of


@dataclass(frozen=True, kw_only=True)
class Ktx2Settings(Options):
    """How textures are written."""

    up: Up = option(
        Up.Z,
        label="Up",
        help="Axis that points up in the textures; of mip chains alone it can be another than Z",
        choices={Up.Z: Choice("Z", "as in Blender"), Up.Y: Choice("Y", "as in glTF")},
    )


def write(map_set: Path, held: MapSet, output: Path, settings: Ktx2Settings, force: bool) -> list[Path]:
    """Write NAME.ktx2; where maps are of several sizes, NAME-ROLE.ktx2 for each: see `Format.write`."""
    textures = textures_of(map_set, held, settings.up)
    kept = {field: held.header[field] for field in ("layout", "material", "error_bound", "settings")}
    common = {"kind": held.kind, "environment": held.header["environment"]["name"], **kept}
    if suns := STORED[held.kind].suns(held):
        common["suns"] = suns
    written = []
    for texture in textures:
        alone = len(textures) == 1
        path = output if alone else output.with_stem(f"{output.stem}-{texture.name}")
        note = json.dumps({**texture.note, **common}, allow_nan=False)
        write_ktx2(path, texture, {"KTXwriter": held.header["software"], "rsibr": note}, force)
        written.append(path)
    return written


FORMAT = Format("Reflection Maps", ".ktx2", Ktx2Settings, write)
