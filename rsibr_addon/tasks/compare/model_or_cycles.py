"""References of kinds that state a model: the model itself, or a material that Cycles renders."""

from collections.abc import Callable, Sequence
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
        """Error of a way to draw."""
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
        """Error of a way to draw."""
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


BY_CYCLES = Telling(
    name=lambda settings: "Cycles" if settings.material is None else f"{settings.material} by Cycles",
    made=lambda settings: "rendered by Cycles",
    notes=references.notes,
    quality=references.quality,
)
"""What is told of pictures by Cycles."""


def telling(is_by_model: Callable[[Any], bool]) -> Telling:
    """What is told of such references.

    Parameters
    ----------
    is_by_model : callable
        Settings to whether the truth is the model itself.
    """

    def of(settings: Any) -> Telling:
        return exact.EXACT if is_by_model(settings) else BY_CYCLES

    return Telling(
        name=lambda settings: of(settings).name(settings),
        made=lambda settings: of(settings).made(settings),
        notes=lambda comparison: of(comparison.settings).notes(comparison),
        quality=lambda settings: of(settings).quality(settings),
    )


UNLESS_NAMED = telling(lambda settings: settings.material is None)
"""The truth is the map set's model, unless settings name a material, which Cycles renders."""
