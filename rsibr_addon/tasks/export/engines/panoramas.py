"""Engines that take the environment as a latitude-longitude picture and filter it themselves."""

from .engine import PanoramaEngine

UNITY = PanoramaEngine(
    label="Unity",
    use="set it as the texture of a material Skybox/Panoramic, or import it with Texture Shape Cube",
    quarters=2,
)
"""The middle of the picture is +X (Skybox-Panoramic.shader), where Blender's -X is: Unity mirrors x."""

UNREAL = PanoramaEngine(
    label="Unreal Engine",
    use="import it, which makes a Texture Cube, and set that as the Cubemap of a Sky Light",
    quarters=0,
)

GODOT = PanoramaEngine(
    label="Godot",
    use="set it as the panorama of a PanoramaSkyMaterial in the Environment's sky",
    quarters=1,
)
"""The middle of the picture is +Z (sky.glsl), a quarter turn from +X, where Blender's middle is."""
