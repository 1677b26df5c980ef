"""Commands run as a program runs them, for their JSON."""

import json
from typing import Any

import pytest
from rsibr.rsibr_addon.command_line.main import run


def json_result(capfd: pytest.CaptureFixture[str], *argv: str) -> dict[str, Any]:
    """Run a command, and return its only line, which agrees with its exit code."""
    code = run([*argv, "--json"])
    (line,) = capfd.readouterr().out.splitlines()
    result: dict[str, Any] = json.loads(line)
    assert code == (0 if result["ok"] else 1)
    return result
