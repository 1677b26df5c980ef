"""Import bpy, or say in one sentence which system libraries to install."""

import re
import sys

DEBIAN = (
    "libegl1 libgl1 libgl1-mesa-dri libglx0 libice6 libopengl0 libsm6 libx11-6 libxext6 libxfixes3 libxi6 "
    "libxkbcommon0 libxrender1 libxt6"
)
FEDORA = (
    "libglvnd-egl libglvnd-glx libglvnd-opengl libICE libSM libX11 libXext libXfixes libXi libXrender libXt "
    "libxkbcommon mesa-dri-drivers"
)


def main() -> int:
    """Return 0 when bpy runs, 1 after saying what it lacks."""
    try:
        import bpy  # noqa: F401
    except ImportError as error:
        missing = re.search(r"lib[\w.+-]+\.so[\w.]*", str(error))
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
