"""Import bpy, or say in one sentence which system libraries to install."""

import ctypes
import re
import sys
from pathlib import Path

DEBIAN = Path(__file__).with_name("debian-libraries").read_text().strip()
FEDORA = (
    "libICE libSM libX11 libXext libXfixes libXi libXrender libxkbcommon "
    "mesa-dri-drivers mesa-libEGL mesa-libGL"
)


def main() -> int:
    """Return 0 when bpy runs, 1 after saying what it lacks."""
    try:
        import bpy  # noqa: F401

        if sys.platform == "linux":
            # bpy opens it late, for graphics, and ends the process without it
            ctypes.CDLL("libEGL.so.1")
    except (ImportError, OSError) as error:
        missing = re.match(r"lib[\w.+-]+\.so[\w.]*", str(error))
        if missing is None:
            raise
        print(
            f"Blender's bpy needs the system library {missing.group()}: install it, on Debian and Ubuntu "
            f"with 'apt install {DEBIAN}', on Fedora with 'dnf install {FEDORA}'.",
            file=sys.stderr,
        )
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
