"""Light from all around: environments as worlds of Blender, and worlds as environments."""

import tempfile
from pathlib import Path

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.environment import Environment, environment_from_pixels
from ..core.errors import SceneError
from ..files.pictures import read_exr
from .rendering import configure_cycles, render_to
from .scenes import temporary_scene
from .working_space import rec709_from_working, working_from_rec709

LARGEST_IMPORTANCE_MAP = 8192
"""Width of the largest map that Cycles chooses light directions from."""

FEWEST_WORLD_SAMPLES, MOST_WORLD_SAMPLES = 16, 1024
WORLD_ERROR = 0.01
"""Texels of a world take more samples until their relative error is this: a sun has an edge."""


def studio_environments() -> dict[str, Path]:
    """The environments that come with Blender, by bare name, as "forest"."""
    folder = Path(bpy.utils.system_resource("DATAFILES", path="studiolights/world"))
    return {path.stem: path for path in sorted(folder.glob("*.exr"))}


def current_world() -> bpy.types.World:
    """The world of the scene that the artist works in.

    Raises
    ------
    SceneError
        It has none.
    """
    world = bpy.context.scene.world
    if world is None:
        raise SceneError(f"Scene {bpy.context.scene.name} has no world: add one in its World properties.")
    return world


def light_with(scene: bpy.types.Scene, environment: Environment) -> None:
    """Make an environment the only light of a scene.

    Parameters
    ----------
    scene : bpy.types.Scene
        To be rendered by Cycles; its world is replaced.
    environment : Environment
        Between texel centres Blender interpolates linearly.
    """
    world = bpy.data.worlds.new(environment.name)
    tree = world.node_tree
    tree.nodes.clear()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = _image(environment)
    background = tree.nodes.new("ShaderNodeBackground")
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    # "Automatic" resolves the map far beyond the texels, and takes ten times as long.
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = min(environment.radiance.shape[1], LARGEST_IMPORTANCE_MAP)
    scene.world = world


def sample_world(world: bpy.types.World, height: int) -> Environment:
    """See a world as an environment, whatever its nodes.

    Parameters
    ----------
    world : bpy.types.World
    height : int
        Of the environment in texels; it is twice as wide.

    Returns
    -------
    Environment
        Each texel the mean of the world over its extent in longitude and latitude.

    Raises
    ------
    RenderError
        Cycles did not deliver.
    InputFileError
        The world's radiance is infinite or NaN somewhere.

    Warns
    -----
    RsibrWarning
        Its radiance is negative somewhere; that is taken as 0.

    Notes
    -----
    Where the world's nodes tell the camera's rays from others, the panoramic camera stands in a shell
    that refracts without bending: through it, it sees what lights a surface.
    """
    with tempfile.TemporaryDirectory() as folder, temporary_scene() as scene:
        scene.world = world.copy()
        scene.world.cycles.sampling_method = "NONE"
        _add_panoramic_camera(scene)
        configure_cycles(scene, 2 * height, height, MOST_WORLD_SAMPLES)
        scene.cycles.use_adaptive_sampling = True
        scene.cycles.adaptive_min_samples = FEWEST_WORLD_SAMPLES
        scene.cycles.adaptive_threshold = WORLD_ERROR
        if _tells_rays_apart(world.node_tree):
            _add_clear_shell(scene)
            scene.cycles.max_bounces = scene.cycles.transmission_bounces = 1
        image = scene.render.image_settings
        image.media_type, image.file_format, image.color_depth = "IMAGE", "OPEN_EXR", "32"
        path = Path(folder) / "world.exr"
        render_to(scene, path)
        return environment_from_pixels(rec709_from_working(read_exr(path)[..., :3]), world.name)


def _image(environment: Environment) -> bpy.types.Image:
    """Float pixels count as colours of the working space."""
    height, width = environment.radiance.shape[:2]
    image = bpy.data.images.new(environment.name, width, height, float_buffer=True)
    rgba: Array = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :3] = working_from_rec709(environment.radiance)
    image.pixels.foreach_set(rgba.ravel())
    return image


def _add_panoramic_camera(scene: bpy.types.Scene) -> None:
    """The middle of the map shows +X, its top +Z."""
    data = bpy.data.cameras.new("RSIBR panorama")
    data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
    item = bpy.data.objects.new("RSIBR panorama", data)
    item.rotation_euler = (np.pi / 2.0, 0.0, -np.pi / 2.0)
    scene.collection.objects.link(item)
    scene.camera = item


def _tells_rays_apart(tree: bpy.types.NodeTree | None) -> bool:
    return tree is not None and any(
        node.bl_idname == "ShaderNodeLightPath" or _tells_rays_apart(getattr(node, "node_tree", None))
        for node in tree.nodes
    )


def _add_clear_shell(scene: bpy.types.Scene) -> None:
    """A cube about the camera through which rays go straight, no longer as the camera's own."""
    material = bpy.data.materials.new("RSIBR shell")
    tree = material.node_tree
    tree.nodes.clear()
    refraction = tree.nodes.new("ShaderNodeBsdfRefraction")
    refraction.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    refraction.inputs["Roughness"].default_value = 0.0
    refraction.inputs["IOR"].default_value = 1.0
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(refraction.outputs["BSDF"], output.inputs["Surface"])
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    data = bpy.data.meshes.new("RSIBR shell")
    data.from_pydata(corners, [], faces)
    data.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("RSIBR shell", data))
