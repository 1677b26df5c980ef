"""Hold pictures drawn from a lobe stack against the BRDF itself, integrated over the environment."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import MapSetError
from ...core.geometry.camera import Camera
from ...core.geometry.lit_sphere import lit_spheres
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.metrics import relative_rmse, unpremultiplied
from ...core.progress import Progress, Steps
from ...device.context import ensure_context
from ...device.drawing import OnDevice
from ...device.kinds.lobe_stack import LobeStackOnDevice
from ...device.lit_sphere import LitSphereOnDevice
from ...device.preview import PreviewRenderer
from ...files.folders import check_folder_target
from ...files.map_set import read_map_set_header
from ...files.map_set_header import content_hash
from ...host.meshes import TriangleMesh, load_mesh
from ..methods.kinds import open_map_set
from ..reflectance.brdfs import check_told_brdf, load_brdf
from .comparison import RESULT, Comparison, StackComparisonSettings, StackWay, WayError
from .views import save_comparison

LEAST_RINGS = 32
"""Of a reference, where no number is asked for."""


def compare_stack(
    map_set: Path,
    settings: StackComparisonSettings,
    output: Path,
    force: bool = False,
    brdf: str | None = None,
) -> Steps[Comparison[StackWay]]:
    """Light a sphere exactly, show a mesh as it and from a lobe stack, and tell the difference.

    Parameters
    ----------
    map_set : Path
        A lobe stack, with the environment that it was made of.
    settings : StackComparisonSettings
    output : Path
        A folder to be made, as by `compare.compare`.
    force : bool
        Whether an earlier comparison in `output` is replaced.
    brdf : str, optional
        The model that counts as true, as `tasks.reflectance.brdfs.load_brdf` takes it; by default the map
        set's own, which must not be in another file.

    Yields
    ------
    Progress

    Returns
    -------
    Comparison

    Raises
    ------
    MapSetError
        The map set does not hold its environment, or is no lobe stack.
    InputFileError, RangeError
        Its BRDF is none, cannot be read, or is in another file; or the mesh cannot be used.
    OutputFileError, DeviceError

    Notes
    -----
    Seen from afar, radiance depends on the normal alone, and so a sphere's is any mesh's: what
    [Kautz2000] section 6 calls filtering with the true BRDF on a per-pixel basis. Both pictures take the
    same samples of the same mesh. Texels of a stack lie so close that linear lookups are good to some 0.3 %;
    cubics between rings twice as far apart are good to a tenth of that.
    """
    check_folder_target(output, RESULT, force)
    yield Progress(0, 1, f"reading {map_set.name}")
    opened = open_map_set(map_set, "lobe_stack")
    if opened.environment is None:
        raise MapSetError(f"{map_set} does not hold the environment to light exactly: bake it again.")
    spec = brdf or opened.material["brdf"]
    if brdf is None:
        check_told_brdf(spec)
    model = yield from load_brdf(spec)
    mesh = load_mesh(settings.mesh)
    cameras = settings.cameras
    view_dirs = [camera.view_dir for camera in cameras]
    stack = opened.subject
    rings = settings.rings or max(LEAST_RINGS, stack.size // 2)
    settings = replace(settings, rings=rings)
    spheres = yield from lit_spheres(model, opened.environment.radiance, view_dirs, rings)
    yield Progress(0, 1, f"writing {output.name}")
    ensure_context()
    references = [
        _picture(LitSphereOnDevice(sphere), None, mesh, camera, settings.size)
        for sphere, camera in zip(spheres, cameras, strict=True)
    ]
    ours = LobeStackOnDevice(stack)
    drawn = [_picture(ours, StackLook(), mesh, camera, settings.size) for camera in cameras]
    way = StackWay(len(stack.maps), len(stack.mu), stack.taps.shape[2])
    comparison = Comparison(
        map_set=map_set.name,
        content=content_hash(read_map_set_header(map_set)),
        environment=opened.environment.name,
        material=spec,
        map_size=stack.size,
        settings=settings,
        view_dirs=tuple(view_dirs),
        reference_noise=0.0,
        errors=(_error(way, np.stack(drawn), np.stack(references)),),
    )
    save_comparison(output, comparison, references, {way: drawn}, force)
    return comparison


def _picture(
    subject: OnDevice, look: StackLook | None, mesh: TriangleMesh, camera: Camera, size: int
) -> Array:
    surface = mesh.positions, mesh.normals, mesh.triangles
    return PreviewRenderer(subject).draw(*surface, camera, size, look)


def _error(way: StackWay, drawn: Array, references: Array) -> WayError[StackWay]:
    compared = unpremultiplied(drawn), unpremultiplied(references), references[..., 3]
    per_view = tuple(relative_rmse(*each) for each in zip(*compared, strict=True))
    return WayError(way, per_view, pooled=relative_rmse(*compared))
