"""Lists of photographs of a ball: what each shows, and from where."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, NotRequired, TypedDict

from ..core.errors import InputFileError, RangeError, SchemaError, ShapeError
from ..core.geometry.view_sphere import MOST_VIEWS, view_sphere
from ..core.schema import LARGEST_TEXT, decode, length, loads
from .reading import opened

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class BallPhotograph:
    """A photograph of a ball.

    Attributes
    ----------
    path : Path
    name : str
        As the list names it.
    view_dir : (float, float, float)
        From the ball to the camera, of any length.
    circle : (float, float, float) or None
        x, y and radius of the ball's outline in pixels from the top left corner, as the photograph is stored;
        None to find it.
    """

    path: Path
    name: str
    view_dir: Triple
    circle: Triple | None


class _Photograph(TypedDict):
    file: str
    view_dir: Triple
    circle: NotRequired[Triple]


class _List(TypedDict):
    photographs: Annotated[list[_Photograph], length(1, MOST_VIEWS)]


def read_ball_list(path: str | Path) -> list[BallPhotograph]:
    """Read a list of photographs.

    Parameters
    ----------
    path : str or Path
        JSON: an object with the list `photographs` of objects, each with `file`, which is relative to the
        list's folder, `view_dir` and, where it is known, `circle`.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, holds something else, or its directions are none of `view_sphere`.
    """
    with opened(path) as stream:
        data = stream.read(LARGEST_TEXT)
    try:
        photographs = decode(_List, loads(data))["photographs"]
        view_sphere([each["view_dir"] for each in photographs])
    except SchemaError as error:
        raise InputFileError(
            f"{path} is no list of photographs, as {error}: write "
            '{"photographs": [{"file": "front.exr", "view_dir": [0, -1, 0.2]}, ...]}.'
        ) from error
    except (RangeError, ShapeError) as error:
        raise InputFileError(f"{path}: {error}") from error
    folder = Path(path).parent
    return [
        BallPhotograph(folder / each["file"], each["file"], each["view_dir"], each.get("circle"))
        for each in photographs
    ]
