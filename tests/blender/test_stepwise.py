"""What operators ask for before they work step by step."""

from types import SimpleNamespace

import pytest
from rsibr.operators.bake_kinds import CLASSES
from rsibr.operators.capture_environment import RSIBR_OT_capture_environment
from rsibr.operators.fit_lobes import RSIBR_OT_fit_lobes
from rsibr.operators.from_pictures import FromPictures
from rsibr.operators.stepwise import Stepwise


@pytest.mark.parametrize(
    ("operator", "name"),
    [
        (RSIBR_OT_capture_environment, "environment.exr"),
        (RSIBR_OT_fit_lobes, "lobes.json"),
        *((each, "untitled.rsibr.exr") for each in CLASSES),
        (FromPictures, ""),
    ],
)
def test_the_file_browser_begins_with_a_name_of_what_is_written(operator: type[Stepwise], name: str) -> None:
    """Blender's own would be that of the open file, which no operator of ours can write."""
    asked = SimpleNamespace(filepath="", proposed=operator.proposed)
    shown: list[str] = []
    manager = SimpleNamespace(fileselect_add=lambda asking: shown.append(asking.filepath))
    assert operator.invoke(asked, SimpleNamespace(window_manager=manager), None) == {"RUNNING_MODAL"}
    assert shown == [name]
