"""Light from all around: environments as worlds of Blender, and worlds as environments."""

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.environment import Environment, environment_from_pixels
from ..core.errors import SceneError
from .camera_ray_shell import add_camera_ray_shell
from .cameras import add_panoramic_camera
from .rendering import configure_cycles, render_passes
from .scenes import temporary_scene
from .working_space import rec709_from_working, working_from_rec709
from .world_light import make_bare

LARGEST_IMPORTANCE_MAP = 8192
"""Width of the largest map that Cycles chooses light directions from."""

LIGHT_OF_TEXEL = 90.0
"""Bytes of memory for each texel of an environment that lights a scene, in Blender and in Cycles."""

WORLD_OF_TEXEL = 100.0
"""Bytes of memory for each texel that a world is sampled at."""

FEWEST_WORLD_SAMPLES, MOST_WORLD_SAMPLES = 16, 1024
WORLD_ERROR = 0.01
"""Relative error at which a world's texel needs no more samples: a sun has an edge."""


def world_of(scene: bpy.types.Scene) -> bpy.types.World:
    """The world of a scene.

    Raises
    ------
    SceneError
        It has none.
    """
    if scene.world is None:
        raise SceneError(f"Scene {scene.name} has no world: add one in its World properties.")
    return scene.world


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
    # Interpolation spreads a sun into the texels beside it, which a map as fine as texels samples too rarely.
    # "Automatic" resolves the map far beyond the texels, and takes ten times as long.
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = min(2 * environment.radiance.shape[1], LARGEST_IMPORTANCE_MAP)
    scene.world = world


def sample_world(
    world: bpy.types.World, height: int, clamp: float | None = None, bare: bool = False
) -> Environment:
    """Render a world with any nodes as an environment.

    Parameters
    ----------
    world : bpy.types.World
    height : int
        Height of the environment in texels; it is twice as wide.
    clamp : float, optional
        See `core.environment.usable_radiance`.
    bare : bool
        Whether its rotation and strength are left out.

    Returns
    -------
    Environment
        Each texel the mean of the world over its extent in longitude and latitude.

    Raises
    ------
    SceneError
        It is to be bare, and does more than to turn and scale an Environment Texture.
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
    with temporary_scene() as scene:
        scene.world = world.copy()
        if bare:
            make_bare(scene.world)
        scene.world.cycles.sampling_method = "NONE"
        add_panoramic_camera(scene)
        configure_cycles(scene, 2 * height, height, MOST_WORLD_SAMPLES)
        scene.cycles.use_adaptive_sampling = True
        scene.cycles.adaptive_min_samples = FEWEST_WORLD_SAMPLES
        scene.cycles.adaptive_threshold = WORLD_ERROR
        if _tells_rays_apart(world.node_tree):
            add_camera_ray_shell(scene)
            scene.cycles.max_bounces = scene.cycles.transmission_bounces = 1
        seen = render_passes(scene)["Combined"][..., :3]
        return environment_from_pixels(rec709_from_working(seen), world.name, clamp)


def _image(environment: Environment) -> bpy.types.Image:
    """Float pixels count as colours of the working space."""
    height, width = environment.radiance.shape[:2]
    image = bpy.data.images.new(environment.name, width, height, float_buffer=True)
    rgba: Array = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :3] = working_from_rec709(environment.radiance)
    image.pixels.foreach_set(rgba.ravel())
    return image


def _tells_rays_apart(tree: bpy.types.NodeTree | None) -> bool:
    return tree is not None and any(
        node.bl_idname == "ShaderNodeLightPath" or _tells_rays_apart(getattr(node, "node_tree", None))
        for node in tree.nodes
    )
