"""Reflectance models by their text, materials of Blender files included: those are measured."""

from functools import partial
from typing import NoReturn

from ...core.brdf.model import Brdf
from ...core.brdf.spec import MATERIAL
from ...core.brdf.spec import brdf_from_spec as spec_without_files
from ...core.errors import InputFileError
from ...core.progress import Steps
from ...files.brdfs import brdf_from_spec


def load_brdf(spec: str) -> Steps[Brdf]:
    """Make the model that a text describes; a material is measured.

    Parameters
    ----------
    spec : str
        See `core/brdf/spec.py`; or ``blend:`` and a material, as `host.materials.load_material` names it.

    Yields
    ------
    Progress
        Only where something is measured.

    Raises
    ------
    RangeError, InputFileError
        The text describes no model; a file is missing or not what it should be.
    SceneError, RenderError
        The material cannot be used; Cycles did not deliver.

    Warns
    -----
    RsibrWarning
        See `files.brdfs.brdf_from_spec` and `measured_materials.measure_material`.
    """
    if not is_material(spec):
        return brdf_from_spec(spec)
    from .measured_materials import measure_material

    return (yield from measure_material(material_of(spec)))


def told_brdf(spec: str, flag: str = "--brdf") -> Brdf:
    """The model that a map set's text describes; unlike `load_brdf`, it opens no file and measures nothing.

    Parameters
    ----------
    spec : str
        Text of a file that may come from anywhere.
    flag : str
        The option by which a user can name the model, for messages.

    Raises
    ------
    RangeError
        The text describes no model.
    InputFileError
        The model is in another file, or is a material of Blender.
    """
    if is_material(spec):
        raise InputFileError(f"{spec} is a material of Blender: name it with {flag} to have it measured.")
    return spec_without_files(spec, partial(_refuse_file, flag))


def check_told_brdf(spec: str) -> None:
    """Refuse to open a file because a map set says so, in a text like that of `told_brdf`.

    Raises
    ------
    RangeError
        The text describes no model.
    InputFileError
        The model is in a file that is not open.
    """
    if not is_material(spec):
        told_brdf(spec)
        return
    from ...host.materials import names_other_file

    if names_other_file(material_of(spec)):
        _refuse_file("--brdf", MATERIAL, material_of(spec))


def is_material(spec: str) -> bool:
    """Whether a text stands for a material, which Blender measures."""
    return spec.partition(":")[0].strip() == MATERIAL


def material_of(spec: str) -> str:
    """The material in such a text, as `host.materials.load_material` names it."""
    return spec.partition(":")[2].strip()


def _refuse_file(flag: str, name: str, path: str) -> NoReturn:
    raise InputFileError(
        f"The map set names a model in {path}, a file that is opened only if you name it: do so "
        f"with {flag} {name}:..."
    )
