"""The light of a world alone."""

from pathlib import Path

from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...files.memory import check_memory
from ...files.radiance_pictures import check_radiance_target
from ...host.cycles import BYTES_BESIDES
from ...host.scenes import find_scene
from ...host.worlds import WORLD_OF_TEXEL, sample_world, world_of
from ...settings.environment import WorldLight
from .scaling import write_scaled


def illuminate_from_world(settings: WorldLight, output: Path, force: bool = False) -> Steps[Path]:
    """Sample the world of a scene of the open file into a latitude-longitude map.

    Raises
    ------
    SceneError
        There is no such scene, or it has no world.
    InputFileError, RenderError
        See `sample_world`.
    RangeError
        See `check_memory`.

    Warns
    -----
    RsibrWarning
        See `sample_world`.
    """
    check_radiance_target(output, force)
    _, height, _ = representation("equirect").shape(settings.size)
    check_memory(WORLD_OF_TEXEL * settings.size * height, str(output), (settings.size, height), BYTES_BESIDES)
    world = world_of(find_scene(settings.scene))
    yield Progress(0, 1, f"sampling world {world.name}")
    write_scaled(output, sample_world(world, height, settings.clamp).radiance, settings, force)
    return output
