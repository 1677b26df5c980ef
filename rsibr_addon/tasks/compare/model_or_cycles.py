"""References of kinds that state a model: the model itself, or a material that Cycles renders."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.geometry.camera import Camera
from ...core.progress import Steps
from ...host.meshes import TriangleMesh
from . import exact, references
from .comparison import Way, WayError
from .references import Captured, Reference
from .truth import Drawn, Telling


@dataclass(frozen=True, eq=False)
class ByCycles:
    """Pictures by Cycles, and how others are measured against them.

    Attributes
    ----------
    rendered : list of Reference
    """

    rendered: list[Reference]

    @property
    def pictures(self) -> list[Array]:
        """See `Drawn.references`."""
        return [each.rgba for each in self.rendered]

    @property
    def noise(self) -> float:
        """See `Comparison.reference_noise`."""
        return references.noise_of(self.rendered)

    def error(self, way: Way, drawn: Sequence[Array]) -> WayError:
        """Error of a way to draw; `drawn` is as `pictures`."""
        return references.error_beyond_noise(way, drawn, self.rendered)


@dataclass(frozen=True, eq=False)
class ByModel:
    """Pictures of the model itself, and how others are measured against them.

    Attributes
    ----------
    pictures : list of ndarray
        See `Drawn.references`.
    """

    pictures: list[Array]
    noise = 0.0

    def error(self, way: Way, drawn: Sequence[Array]) -> WayError:
        """Error of a way to draw; `drawn` is as `pictures`."""
        return exact.error_of(way, drawn, self.pictures)


Pictures = ByModel | ByCycles


def by_cycles(
    environment: Environment, mesh: TriangleMesh, cameras: Sequence[Camera], settings: Any
) -> Steps[ByCycles]:
    """Render the material that settings name.

    Raises
    ------
    RenderError, InputFileError, SceneError, RangeError
        See `references.render_reference`.
    """
    shape = None if settings.mesh == "sphere" else mesh
    captured = Captured(settings.material, environment, shape)
    rendered = yield from references.rendered(captured, cameras, settings)
    return ByCycles(rendered)


def beside(
    truth: Pictures, drawn: dict[Any, list[Array]], material: str, map_size: int, settings: Any
) -> Drawn:
    """Pictures that were drawn, beside the truth: arguments and result are attributes of `Drawn`."""
    return Drawn(
        material=material,
        map_size=map_size,
        settings=settings,
        references=truth.pictures,
        drawn=drawn,
        errors=tuple(truth.error(way, pictures) for way, pictures in drawn.items()),
        noise=truth.noise,
    )


def telling(settings: Any) -> Telling:
    """What is told of the map set's model; of Cycles, where settings name a material, which it renders."""
    return exact.telling(settings) if settings.material is None else references.telling(settings)
