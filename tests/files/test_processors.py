"""What a file holds does not hang on the processor that it is made on: docs/architecture.md says how far."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.tests.files.processors import SETTINGS
from rsibr.tests.small_works import works, write_sources

NEIGHBOUR, HALF_NEIGHBOUR = 2.0**-23, 2.0**-10
"""Relative difference of neighbouring floats: double precision is rounded to one or the other."""

DARKEST = 1e-11
"""Of the brightest: a hundred thousand roundings of double precision, 1e-16 of it each, all to one side."""

DIGITS = 1e-6
"""Relative: of what is said of maps and lobes, differences of sums in double precision among it."""

ZERO = 1e-13
"""What differences of double precision's numbers near 1 are uncertain by: an error of the albedo is such."""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    sources = tmp_path_factory.mktemp("sources")
    write_sources(sources)
    folders = {}
    for setting, variables in SETTINGS.items():
        folders[setting] = tmp_path_factory.mktemp("made")
        command = [sys.executable, "-m", "rsibr.tests.small_works", str(sources), str(folders[setting])]
        done = subprocess.run(
            command, env=os.environ | variables, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    return folders


@pytest.mark.slow
@pytest.mark.parametrize("setting", list(SETTINGS)[1:])
@pytest.mark.parametrize("name", works(Path()))
def test_a_file_is_the_same(name: str, setting: str, made: dict[str, Path]) -> None:
    header, maps = _held(made["as it is"] / name)
    other_header, other_maps = _held(made[setting] / name)
    _check_same(header, other_header)
    assert list(maps) == list(other_maps)
    step = HALF_NEIGHBOUR if name.startswith(("half", "pyramid")) else NEIGHBOUR
    for part, pixels in maps.items():
        scale = float(np.abs(pixels).max())
        np.testing.assert_allclose(other_maps[part], pixels, rtol=step, atol=DARKEST * scale, err_msg=part)


def _held(path: Path) -> tuple[Any, dict[str, np.ndarray]]:
    """What a file says and the pixels that it holds."""
    if path.suffix == ".json":
        return json.loads(path.read_text()), {}
    if not path.name.endswith(".rsibr.exr"):
        return {}, {"": read_radiance(path).astype(np.float64)}
    held = read_map_set(path)
    return held.header, {name: pixels.astype(np.float64) for name, pixels in held.maps.items()}


def _check_same(said: Any, other: Any, scale: float = 0.0) -> None:
    """Words and whole numbers exactly, but for hashes of pixels; others to `DIGITS` of those beside them."""
    assert type(said) is type(other)
    match said:
        case dict():
            assert list(said) == list(other)
            for key in said.keys() - {"sha256", "created", "seconds"}:
                _check_same(said[key], other[key])
        case list():
            assert len(said) == len(other)
            beside = np.abs([*_numbers(said)]).max(initial=scale)
            for one, another in zip(said, other, strict=True):
                _check_same(one, another, beside)
        case float():
            assert abs(said - other) <= DIGITS * max(abs(said), scale) + ZERO
        case _:
            assert said == other


def _numbers(said: Any) -> Any:
    if isinstance(said, list):
        for item in said:
            yield from _numbers(item)
    elif isinstance(said, float):
        yield said
