"""Make an illumination map: the light of an environment, as a latitude-longitude map."""

from . import illuminate_brackets, illuminate_faces, illuminate_scene, illuminate_world

KINDS = {
    "scene": illuminate_scene,
    "world": illuminate_world,
    "faces": illuminate_faces,
    "brackets": illuminate_brackets,
}
"""What it is made from -> the module with its arguments and its run."""
