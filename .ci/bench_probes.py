"""What a ball that moves from one room into another gains by blended probes, for docs/mip-chains.md."""

from pathlib import Path
from tempfile import TemporaryDirectory

import bpy  # noqa: F401  (before what it brings)
from docs_table import write_table
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.tests.cycles.joined_rooms import add_rooms, errors, rooms_chain
from rsibr.tests.cycles.test_reflection_tables import shader

ALONG = (-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0)
BALLS = {
    "mirror": ("Glossy", {"Roughness": 0.0}, MipLook(f0=(1.0,) * 3, kd=(0.0,) * 3), 32),
    "diffuse": ("Diffuse", {}, MipLook(f0=(0.0,) * 3, kd=(1.0,) * 3), 144),
}
"""Ball -> Cycles' shader, its inputs, our look, and samples."""


def main() -> None:
    """Measure, and write the table."""
    lines = ["| ball | one probe | the nearest | blended |", "|---|---|---|---|"]
    with TemporaryDirectory() as folder:
        add_rooms()
        chain = rooms_chain(Path(folder), 64, 0.5)
        for ball, (name, inputs, look, samples) in BALLS.items():
            found = errors(chain, shader(name, **inputs), look, ALONG, 24, samples)
            lines.append(f"| {ball} | " + " | ".join(f"{error:.3f}" for error in found.values()) + " |")
    write_table("mip-chains.md", "probes", "\n".join(lines))


if __name__ == "__main__":
    main()
