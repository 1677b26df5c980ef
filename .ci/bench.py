"""Time the commands on this machine, each as a user would run it; the figures are for comparison only."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

RSIBR = Path(sys.executable).with_name("rsibr")
CAPTURE = ["capture", "--environment", "forest", "--material", "copper", "--size", "128", "--samples", "16"]
TURN = ["preview", "copper.rsibr.exr", "--mesh", "monkey", "--size", "256", "--turntable", "24"]

COMMANDS = {
    "12 views of 128x128, 16 samples": [*CAPTURE, "-o", "copper.rsibr.exr"],
    "12 views of 128x128, 16 samples, denoised": [*CAPTURE, "--denoise", "-o", "denoised.rsibr.exr"],
    "24 frames of 256x256, paper": [*TURN, "--mode", "paper", "-o", "paper.png"],
    "24 frames of 256x256, texel": [*TURN, "--mode", "texel", "-o", "texel.png"],
    "24 frames of 256x256, fragment": [*TURN, "--mode", "fragment", "-o", "fragment.png"],
    "2 views of 128x128 compared": ["compare", "copper.rsibr.exr", "--views", "2", "-o", "compare"],
}


def main() -> None:
    """Run every command in a folder that is thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        for what, command in COMMANDS.items():
            start = time.perf_counter()
            process = subprocess.run(
                [RSIBR, *command], cwd=folder, capture_output=True, text=True, check=False
            )
            if process.returncode != 0:
                raise SystemExit(process.stderr)
            print(f"{time.perf_counter() - start:8.2f} s  {what}", flush=True)


if __name__ == "__main__":
    main()
