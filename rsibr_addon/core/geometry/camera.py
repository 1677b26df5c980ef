"""The camera of captures, previews and references: it looks at a unit sphere and fits it exactly."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from .directions import camera_frame, normalize

ORTHOGRAPHIC_DISTANCE = 2.0
"""Distance of an orthographic camera; any above 1 gives the same picture."""


@dataclass(frozen=True)
class Camera:
    """Looks along -`view_dir` at the unit sphere about the origin, which fills the square frame.

    Attributes
    ----------
    view_dir : tuple of 3 floats
        From the object to the eye, of any positive length; kept as a unit vector.
    field_of_view : float or None
        Full angle of a perspective frame in radians, in (0, pi); None for orthographic.

    Raises
    ------
    RangeError
        `view_dir` has length 0, or `field_of_view` lies outside (0, pi).
    """

    view_dir: tuple[float, float, float]
    field_of_view: float | None = None

    def __post_init__(self) -> None:
        x, y, z = (float(c) for c in normalize(self.view_dir))
        object.__setattr__(self, "view_dir", (x, y, z))
        if self.field_of_view is not None and not 0.0 < self.field_of_view < np.pi:
            raise RangeError("A perspective angle must lie between 0 and 180 degrees.")

    @property
    def distance(self) -> float:
        """From the origin to the eye; in perspective the frame's edges touch the unit sphere."""
        if self.field_of_view is None:
            return ORTHOGRAPHIC_DISTANCE
        return float(1.0 / np.sin(self.field_of_view / 2.0))

    @property
    def frame(self) -> Array:
        """Camera axes as columns, in world coordinates, shape (3, 3): see `camera_frame`."""
        return camera_frame(self.view_dir)

    @property
    def eye(self) -> Array:
        """Homogeneous position of the eye, shape (4,): (direction, 0) when orthographic.

        The direction from a point p to the eye is then ``eye[:3] - eye[3] * p``, normalised,
        for both kinds of camera.
        """
        if self.field_of_view is None:
            return np.array([*self.view_dir, 0.0])
        return np.array([*(self.distance * np.asarray(self.view_dir)), 1.0])

    @property
    def world_from_camera(self) -> Array:
        """The camera's pose, shape (4, 4), for column vectors."""
        pose = np.eye(4)
        pose[:3, :3] = self.frame
        pose[:3, 3] = self.distance * np.asarray(self.view_dir)
        return pose

    @property
    def projection(self) -> Array:
        """OpenGL clip coordinates from camera coordinates, shape (4, 4), for column vectors."""
        near, far = self.distance - 1.5, self.distance + 1.5
        if self.field_of_view is None:
            return np.array(
                [
                    [1.0, 0.0, 0.0, 0.0],
                    [0.0, 1.0, 0.0, 0.0],
                    [0.0, 0.0, -2.0 / (far - near), -(far + near) / (far - near)],
                    [0.0, 0.0, 0.0, 1.0],
                ]
            )
        near = max(near, 0.5 * (self.distance - 1.0))  # between the eye and the unit sphere
        scale = 1.0 / np.tan(self.field_of_view / 2.0)
        return np.array(
            [
                [scale, 0.0, 0.0, 0.0],
                [0.0, scale, 0.0, 0.0],
                [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
                [0.0, 0.0, -1.0, 0.0],
            ]
        )
