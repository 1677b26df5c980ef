"""What no image says of an object's materials, to a file of pictures that previews look up."""

from pathlib import Path

from ...core.counted import counted
from ...core.materials.packing import bytes_needed
from ...core.progress import Steps
from ...files.map_set_header import Recipe
from ...job import BakeJob
from ...settings.baked_inputs import ObjectInputsSettings
from .method import BLENDER_MEMORY, RGB, STORED, Baked, Cost, Method

PICTURES = 2
"""Of a usual object."""

TEXEL_SECONDS, SAMPLE_SECONDS = 4.5e-7, 1.3e-7
"""Processor time of a texel, and of each of its samples, as a noise takes it."""


def cost(settings: ObjectInputsSettings) -> Cost:
    """See `Method`."""
    texels = PICTURES * settings.size**2
    seconds = (TEXEL_SECONDS + SAMPLE_SECONDS * settings.samples) * texels
    memory = BLENDER_MEMORY + bytes_needed(PICTURES, settings.size)
    return Cost(seconds, memory, STORED * RGB * texels)


def material(settings: ObjectInputsSettings) -> str:
    """See `Method`."""
    return f"materials of {settings.object}"


def recipe(job: BakeJob[ObjectInputsSettings]) -> Recipe:
    """See `Method`.

    Raises
    ------
    SceneError
        See `object_to_bake` and `inputs_recipe` of `tasks.baked_inputs`.
    """
    from ...host.scenes import evaluated, find_scene
    from ..baked_inputs import inputs_recipe, object_to_bake

    return inputs_recipe(*object_to_bake(job.settings.object), job.settings, evaluated(find_scene(None)))


def bake(job: BakeJob[ObjectInputsSettings], recipe: Recipe) -> Steps[Baked]:
    """Bake: see `Method`, and `tasks.baked_inputs.bake_inputs` for what it raises."""
    from ..baked_inputs import bake_inputs

    output = Path(job.output)
    baked = yield from bake_inputs(job.settings.object, job.settings, output, job.force)
    count = len(baked.pictures)
    return Baked(output, counted(count, "picture"), {"pictures": count})


METHOD = Method(bake, cost, material, recipe=recipe)
