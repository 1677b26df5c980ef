"""References of kinds that state a model: the model itself, or a material that Cycles renders."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...core.brdf.spec import is_model
from ...core.conventions import Array
from ...core.environment import Environment
from ...core.geometry.camera import Camera
from ...core.progress import Steps
from ...host.meshes import TriangleMesh
from . import exact, references
from .comparison import Comparison, Way, WayError
from .references import Captured, Reference
from .truth import Drawn


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


def by_model(settings: Any) -> bool:
    """Whether settings name a reflectance model, or leave it to the map set; else a material of Blender."""
    return settings.material is None or is_model(settings.material)


def name(settings: Any) -> str:
    """See `Truth`."""
    return exact.name(settings) if by_model(settings) else f"{settings.material} by Cycles"


def made(settings: Any) -> str:
    """See `Truth`."""
    return exact.made(settings) if by_model(settings) else "rendered by Cycles"


def notes(comparison: Comparison) -> str:
    """See `Truth`."""
    return exact.notes(comparison) if by_model(comparison.settings) else references.notes(comparison)


def quality(settings: Any) -> str:
    """See `Truth`."""
    return exact.quality(settings) if by_model(settings) else references.quality(settings)
