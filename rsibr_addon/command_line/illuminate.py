"""Make an illumination map: the light of an environment, as a latitude-longitude map."""

from . import (
    illuminate_ball,
    illuminate_brackets,
    illuminate_faces,
    illuminate_painted,
    illuminate_scene,
    illuminate_world,
)

KINDS = {
    "scene": illuminate_scene,
    "world": illuminate_world,
    "faces": illuminate_faces,
    "ball": illuminate_ball,
    "brackets": illuminate_brackets,
    "painted": illuminate_painted,
}
"""What it is made from -> the module with its arguments and its run."""
