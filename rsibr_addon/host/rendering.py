"""What all our renders have in common."""

from pathlib import Path

import bpy

from ..core.errors import RenderError


def configure_cycles(scene: bpy.types.Scene, width: int, height: int, samples: int) -> None:
    """Have Cycles render on the CPU, each pixel the plain mean of its samples.

    Parameters
    ----------
    scene : bpy.types.Scene
    width, height, samples : int
    """
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sampling_pattern = "TABULATED_SOBOL"
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = 0
    # Each of these would save time by giving up light.
    cycles.light_sampling_threshold = 0.0
    cycles.sample_clamp_direct = 0.0


def render_to(scene: bpy.types.Scene, path: Path) -> None:
    """Render a scene into a file of the kind that it is set to.

    Parameters
    ----------
    scene : bpy.types.Scene
    path : Path
        Does not exist yet.

    Raises
    ------
    RenderError
        There is no file afterwards.
    """
    scene.render.filepath = str(path)
    scene.render.use_file_extension = False
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    except RuntimeError as error:
        raise RenderError(f"Blender cannot render: {str(error).strip()}.") from error
    if not path.exists():
        raise RenderError("Blender's render was cancelled, or another one is going on: try again.")
