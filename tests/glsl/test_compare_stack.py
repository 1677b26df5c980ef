"""`rsibr compare` of lobe stacks: right where the answer is known, whole on disk, refused in words."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError, RangeError
from rsibr.rsibr_addon.core.lobes.bake import bake_stack
from rsibr.rsibr_addon.core.lobes.bank import octaves
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.target import elevation_slices
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.lobe_stack import to_map_set
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.settings.lobe_stack import StackComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison
from rsibr.rsibr_addon.tasks.compare.lobe_stack import StackWay

KD = 0.8
LIGHT = np.random.default_rng(61).random((32, 64, 3), dtype=np.float32) ** 2
QUICK = StackComparison(views=2, size=32, rings=24)


def lambert_fit() -> Fit:
    """max(cos, 0) as kernels about the normal: tilted by theta / sin(theta), one map for all elevations."""
    mu = elevation_slices(16)
    bank = octaves(64.0)
    angle = np.linspace(0.0, np.pi, 2000)
    values = bank.values(np.sin(0.5 * angle) ** 2)
    root = np.sqrt(np.sin(angle))[:, None]
    weights = np.linalg.lstsq(root * values, root[:, 0] * np.maximum(np.cos(angle), 0.0) * KD / np.pi)[0]
    offsets = np.zeros((1, 16, 1, 2))
    offsets[0, :, 0, 0] = np.arccos(mu) / np.sqrt(1.0 - mu**2)
    return Fit(
        brdf=f"lambert:kd={KD}",
        method="joint",
        mu=mu,
        bank=bank,
        weights=np.repeat(weights[:, None], 3, axis=1)[None, None],
        scale=np.ones((1, 16, 3)),
        offsets=offsets,
        taps=np.ones((1, 16, 1)),
    )


def map_set(brightness: float = 1.0) -> MapSet:
    fit = lambert_fit()
    stack = drain(bake_stack(LIGHT, fit, "octahedral", 32)).stack
    stack.maps[:] *= brightness
    material = {"brdf": fit.brdf, "method": fit.method}
    return to_map_set(stack, Origin(Environment(LIGHT, "noise"), {}, "test", material))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    write_map_set(tmp_path / "lambert.rsibr.exr", map_set())
    return tmp_path / "lambert.rsibr.exr"


def test_a_nearly_exact_stack_is_close_and_all_is_written(tmp_path: Path, path: Path) -> None:
    found = drain(compare(path, QUICK, tmp_path / "out"))
    (error,) = found.errors
    # The fit of the cosine's kink with kernels 1/8 wide is off by some 0.5 %, the environment turned into
    # the camera's axes by 32 rows of bilinear lookups, interpolated elevations by (1/16)^2 / 8 of a radian.
    assert error.worst < 0.01
    assert min(error.per_view) <= error.median <= error.worst == max(error.per_view)
    written = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert Comparison.from_json(written, StackComparison, StackWay) == found
    page = (tmp_path / "out" / "index.html").read_text()
    assert "integrated exactly" in page
    assert "Cycles" not in page


def test_a_known_error_is_found_on_any_mesh(tmp_path: Path) -> None:
    write_map_set(tmp_path / "bright.rsibr.exr", map_set(1.25))
    (tmp_path / "tilted.obj").write_text(
        "v -1 -1 0\nv 1 -1 0\nv 0 1 1\nvn 0 -.4 1\nvn .5 0 1\nf 1//1 2//2 3//1\n"
    )
    settings = StackComparison(views=3, size=24, rings=16, mesh=str(tmp_path / "tilted.obj"))
    found = drain(compare(tmp_path / "bright.rsibr.exr", settings, tmp_path / "out"))
    # A quarter too bright, give or take what the stack itself is off by. A view from behind counts too: there
    # the normals point away, and both pictures show what the rim does.
    assert found.errors[0].median == pytest.approx(0.25, abs=0.02)


def test_the_command_tells_the_errors(path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    quick = ["--views", "1", "--size", "16", "--rings", "8"]
    assert run(["compare", str(path), *quick, "-o", str(path.parent / "out")]) == 0
    told = capfd.readouterr().out
    assert "Relative RMSE against the model itself, 1 view:" in told
    assert "lobes: 1, elevations: " in told


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--warp", "split"], "option --warp is for radiance_views, not for lobe_stack"),
        (["--samples", "16"], "radiance_views or reflection_tables or mip_chain, not for lobe_stack"),
        (["--perspective", "40"], "are orthographic: leave the perspective out"),
        (["--rings", "3"], "Rings cannot be 3"),
        (["--size", "5000"], "choose 1 to 1024"),
    ],
)
def test_what_cannot_be_compared_is_refused(
    path: Path, options: list[str], complaint: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["compare", str(path), *options, "-o", str(path.parent / "out")]) == 1
    assert complaint in capfd.readouterr().err
    assert not (path.parent / "out").exists()


def test_a_stack_without_its_environment_is_refused(tmp_path: Path) -> None:
    bare = map_set()
    bare.header["environment"]["part"] = None
    del bare.header["parts"][0], bare.maps["environment"]
    write_map_set(tmp_path / "bare.rsibr.exr", bare)
    with pytest.raises(MapSetError, match=r"bare\.rsibr\.exr does not hold the environment"):
        drain(compare(tmp_path / "bare.rsibr.exr", QUICK, tmp_path / "out"))


def test_a_brdf_that_is_gone_is_named(tmp_path: Path) -> None:
    strange = map_set()
    strange.header["material"]["brdf"] = "velvet:"
    write_map_set(tmp_path / "strange.rsibr.exr", strange)
    with pytest.raises(RangeError, match='no BRDF model "velvet"'):
        drain(compare(tmp_path / "strange.rsibr.exr", QUICK, tmp_path / "out"))
