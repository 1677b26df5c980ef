"""Make an illumination map: the light of an environment, as a latitude-longitude map."""

from . import illuminate_faces

KINDS = {"faces": illuminate_faces}
"""What it is made from -> the module with its arguments and its run."""
