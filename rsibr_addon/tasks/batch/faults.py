"""What is wrong with a bake of a batch before it is tried."""

import re

from ...core.brdf.cycles_presets import PRESETS
from ...core.brdf.gallery import GALLERY
from ...core.brdf.spec import MATERIAL, MODELS, is_model
from ...core.errors import RsibrError
from ...core.near_names import did_you_mean
from ...core.options import declared_options
from ...files.apart import check_apart
from ...files.reading import opened
from ..methods.bake import METHODS, source_files
from .bakes import BatchBake

_OF_BLENDER = re.compile(rf"(?:{MATERIAL})?:|.+\.blend\d*:", re.IGNORECASE)


def fault_of(bake: BatchBake) -> str:
    """Why a bake is sure to fail, as where its material is misspelt; empty where nothing is known against it.

    Parameters
    ----------
    bake : BatchBake
    """
    settings = bake.job.settings
    for each in declared_options(type(settings)):
        taken, text = each.option.materials, getattr(settings, each.name)
        if taken and taken.model and text and not (settings.only_names_material or _is_known(text)):
            return _unknown(text)
    try:
        METHODS[settings.KIND].cost(settings)
        files = source_files(bake.job)
        for file in files:
            with opened(file):
                pass
        check_apart(bake.job.output, files)
    except RsibrError as error:
        return str(error)
    return ""


def _unknown(text: str) -> str:
    gallery = [name for models in GALLERY.values() for name in models]
    near = did_you_mean(text, [*gallery, *PRESETS, *MODELS])
    names = "" if near else f", {', '.join(gallery)}"
    return (
        f'There is no material "{text}"{near}: name a preset, a reflectance model, or one of the '
        f"gallery{names}."
    )


def _is_known(text: str) -> bool:
    return is_model(text) or text in PRESETS or bool(_OF_BLENDER.match(text))
