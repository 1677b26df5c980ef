"""What the panel says below its buttons."""

from types import SimpleNamespace

import pytest
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.ui import preview_panel


@pytest.mark.parametrize("offline", [True, False])
def test_it_says_why_nothing_can_be_sent(offline: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def check_online() -> None:
        if offline:
            raise SceneError("Blender may not use the network: switch on Allow Online Access.")

    told: list[str] = []
    column = SimpleNamespace(label=lambda text, icon: told.append(text))
    monkeypatch.setattr(preview_panel, "check_online", check_online)
    preview_panel._draw_offline(SimpleNamespace(column=lambda align: column), 300)
    assert " ".join(told).startswith("Blender may not use the network: switch on" if offline else "")
    assert bool(told) == offline
