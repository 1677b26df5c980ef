"""Materials of Blender files as reflectance models, measured whatever their nodes."""

import numpy as np

from ...core.brdf.albedo import directional_albedo as table_albedo
from ...core.brdf.albedo import warn_of_gain
from ...core.brdf.measured_material import MeasuredMaterial, measured_material, measured_pairs
from ...core.brdf.spec import MATERIAL
from ...core.errors import SceneError
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...host.furnace import COSINES, directional_albedo
from ...host.goniophotometer import LEAST_COSINE, measure
from ...host.materials import lasting_spec, load_material
from ...host.scenes import temporary_scene
from ...host.shape_dependence import shape_dependence

CHECKED = slice(COSINES // 16, None, COSINES // 16)
"""The furnace's cosines that are checked: closer to grazing, a table's own interpolation would count."""

TOLERATED_DIFFERENCE = 0.03
"""Share of the light sent back that may be missing or too much before somebody is told."""


def measure_material(material: str) -> Steps[MeasuredMaterial]:
    """Measure the reflectance of a material, whatever its nodes.

    Parameters
    ----------
    material : str
        As `host.materials.load_material` names it.

    Yields
    ------
    Progress
        Before each angle between light and view. Between two steps nothing of ours is in the open file.

    Returns
    -------
    MeasuredMaterial
        Exact at the centres of its tables' cells; a lobe narrower than alpha = 0.01 is not resolved.

    Raises
    ------
    InputFileError, SceneError
        There is no such material, it has no surface, or none that a table holds.
    RenderError
        Cycles did not deliver.

    Warns
    -----
    RsibrWarning
        The material depends on more than light and view; it sends back light that tables do not hold, or
        more than it gets.
    """
    with temporary_scene():
        reasons = shape_dependence(load_material(material))
    if reasons:
        warn(
            f"No BRDF can hold {material}, so it is measured as it looks on a small flat tile: "
            f"{'; '.join(reasons)}."
        )
    light_dir, view_dir, wanted = measured_pairs(LEAST_COSINE)
    diffuse, glossy = (np.full(light_dir.shape, np.nan) for _ in range(2))
    angles = wanted.shape[1]
    for angle in range(angles):
        yield Progress(angle, angles, f"measuring {material} at angle {angle + 1} of {angles}")
        at = np.nonzero(wanted[:, angle])
        with temporary_scene() as scene:
            found = measure(scene, load_material(material), light_dir[:, angle][at], view_dir[:, angle][at])
        diffuse[:, angle][at], glossy[:, angle][at] = found
    brdf = measured_material(diffuse, glossy, f"{MATERIAL}:{lasting_spec(material)}")
    _compare_with_furnace(brdf, material)
    warn_of_gain(brdf, brdf.spec)
    return brdf


def _compare_with_furnace(brdf: MeasuredMaterial, material: str) -> None:
    """Warn if a table's albedo differs from what the material reflects in a white furnace."""
    with temporary_scene() as scene:
        sent = float(directional_albedo(scene, load_material(material), seed=0).sum(axis=0)[CHECKED].sum())
    held = float(table_albedo(brdf, (np.arange(COSINES) + 0.5)[CHECKED] / COSINES).sum())
    if held == 0.0 < sent:
        raise SceneError(
            f"Material {material} only mirrors, lets light through or glows, which no table of reflectance "
            f"holds: give it a roughness of 0.1 or more."
        )
    if abs(held - sent) > TOLERATED_DIFFERENCE * sent:
        warn(
            f"The measured reflectance of {material} sends back {abs(held / sent - 1.0):.0%} "
            f"{'more' if held > sent else 'less'} light than the material: it does not hold highlights "
            f"sharper than roughness 0.1, light that passes through, nor light of its own."
        )
