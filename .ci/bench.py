"""Time the commands on this machine, each as a user would run it; the figures are for comparison only."""

import os
import tempfile
import time

from rsibr.rsibr_addon.command_line.main import run

CAPTURE = ["capture", "--environment", "forest", "--material", "copper", "--samples", "16", "--denoise"]
TURN = ["preview", "12.rsibr.exr", "--mesh", "monkey", "--size", "256", "--turntable", "24"]

COMMANDS = {
    "12 views of 128x128, first of the process": [*CAPTURE, "--size", "128", "-o", "12.rsibr.exr"],
    "12 views of 128x128 again": [*CAPTURE, "--size", "128", "-o", "again.rsibr.exr"],
    "12 views of 256x256": [*CAPTURE, "--size", "256", "-o", "large.rsibr.exr"],
    "24 frames of 256x256, paper": [*TURN, "--mode", "paper", "-o", "paper.png"],
    "24 frames of 256x256, texel": [*TURN, "--mode", "texel", "-o", "texel.png"],
    "24 frames of 256x256, fragment": [*TURN, "--mode", "fragment", "-o", "fragment.png"],
    "3 views of 128x128 compared": ["compare", "12.rsibr.exr", "--views", "3", "-o", "compare"],
}


def main() -> None:
    """Run every command in a folder that is thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for what, command in COMMANDS.items():
            start = time.perf_counter()
            if run([*command, "--progress", "none", "--json"]) != 0:
                raise SystemExit(f"'{what}' failed: see above.")
            print(f"{time.perf_counter() - start:8.2f} s  {what}", flush=True)


if __name__ == "__main__":
    main()
