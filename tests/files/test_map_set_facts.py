"""What the panel tells of a map set is what its file says, also after the file has changed."""

from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.tasks.map_set_facts import map_set_facts
from rsibr.tests.flat_capture import write_flat_capture


def test_facts_follow_the_file(tmp_path: Path) -> None:
    path = tmp_path / "flat.rsibr.exr"
    with pytest.raises(MapSetError, match=r"flat\.rsibr\.exr"):
        map_set_facts(path)
    write_flat_capture(path, (0.5, 0.0, 0.5))
    facts = map_set_facts(path)
    assert facts["Kind"] == "Radiance views"
    assert all(isinstance(which, str) and which for which in facts.values())
    path.write_text("no picture any more")
    with pytest.raises(MapSetError, match=r"flat\.rsibr\.exr"):
        map_set_facts(path)
