"""RGL tensor files, written here by the format's description, and three real ones."""

import struct
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.rgl import TYPES, read_rgl, read_tensors
from rsibr.tests.measurements import measurement

NAMES = ["satin_rosaline", "vch_golden_yellow", "cg_sunflower"]


def tensor_file(fields: dict[str, np.ndarray]) -> bytes:
    """The magic, version 1.0, a directory, then the fields at multiples of 8 bytes."""
    kinds = {np.dtype(name): number for number, name in TYPES.items()}
    entries = [
        struct.pack("<H", len(name)) + name.encode() + struct.pack("<HB", field.ndim, kinds[field.dtype])
        for name, field in fields.items()
    ]
    size = 18 + sum(
        len(entry) + 8 + 8 * field.ndim for entry, field in zip(entries, fields.values(), strict=True)
    )
    head, data = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
    for entry, field in zip(entries, fields.values(), strict=True):
        data += bytes(-(size + len(data)) % 8)
        head += entry + struct.pack(f"<Q{field.ndim}Q", size + len(data), *field.shape)
        data += field.tobytes()
    return head + data


@pytest.fixture
def fields() -> dict[str, np.ndarray]:
    """A small measurement with every field that files of the database have."""
    rng = np.random.default_rng(0)
    return {
        "version": np.array([1, 0], np.uint32),
        "description": np.frombuffer(b"made of numbers", np.uint8),
        "phi_i": np.zeros(1, np.float32),
        "theta_i": np.linspace(0.0, 1.5, 4, dtype=np.float32),
        "sigma": np.ones((2, 16), np.float32),
        "ndf": np.full((2, 16), 0.3, np.float32),
        "vndf": rng.random((1, 4, 9, 8), np.float32),
        "luminance": rng.random((1, 4, 5, 6), np.float32),
        "rgb": rng.random((1, 4, 3, 5, 6), np.float32),
        "jacobian": np.ones(1, np.uint8),
        "valid": np.ones(30, np.uint8),
    }


def test_every_field_is_read_back(tmp_path: Path, fields: dict[str, np.ndarray]) -> None:
    fields |= {
        "half": np.float16([[0.5, 2.0]]),
        "scalar": np.float64(3.0).reshape(()),
        "none": np.zeros(0, "<i8"),
    }
    path = tmp_path / "a.bsdf"
    path.write_bytes(tensor_file(fields))
    found = read_tensors(path)
    assert list(found) == list(fields)
    for name, field in fields.items():
        assert found[name].dtype == field.dtype
        np.testing.assert_array_equal(found[name], field)


def test_fields_reach_the_model(tmp_path: Path, fields: dict[str, np.ndarray]) -> None:
    path = tmp_path / "a.bsdf"
    fields["rgb"][0, 1, 2, 3, 4] = -0.5
    fields["rgb"][0, 0, 0, 0, 0] = -1e-9
    path.write_bytes(tensor_file(fields))
    with pytest.warns(RsibrWarning, match=r"a\.bsdf has 2 values of colours outside Rec. 709"):
        brdf = read_rgl(path)
    np.testing.assert_array_equal(brdf.theta_v, fields["theta_i"])
    np.testing.assert_array_equal(brdf.weight, np.maximum(fields["rgb"][0], 0.0))
    np.testing.assert_array_equal(brdf.vndf, fields["vndf"][0])
    assert brdf.spec == f"rgl:path={path}"


@pytest.mark.parametrize(
    ("name", "field", "sentence"),
    [
        ("rgb", None, "no field rgb"),
        ("phi_i", np.zeros(8, np.float32), "anisotropic"),
        ("jacobian", np.zeros(1, np.uint8), "jacobian 0"),
        ("ndf", np.full((2, 16), np.nan, np.float32), "32 values that are NaN or infinite"),
        ("sigma", np.ones((2, 5), np.float32), "unfit fields"),
        ("sigma", np.ones((0, 16), np.float32), "unfit fields"),
        ("theta_i", np.zeros(4, np.float32), "do not increase"),
        ("theta_i", np.arange(3, dtype=np.float32), "unfit fields"),
        ("rgb", np.ones((1, 4, 4, 5, 6), np.float32), "unfit fields"),
        ("vndf", np.ones((9, 8), np.float32), "unfit fields"),
        ("vndf", np.zeros((1, 4, 9, 8), np.float32), "no visible normals"),
        ("sigma", np.zeros((2, 16), np.float32), "no visible normals"),
        ("ndf", np.full((2, 16), -1.0, np.float32), "no visible normals"),
    ],
)
def test_files_that_hold_no_model_are_refused_in_words(
    tmp_path: Path, fields: dict[str, np.ndarray], name: str, field: np.ndarray | None, sentence: str
) -> None:
    path = tmp_path / "a.bsdf"
    changed = {**fields, name: field}
    path.write_bytes(tensor_file({key: value for key, value in changed.items() if value is not None}))
    with pytest.raises(InputFileError, match=sentence) as caught:
        read_rgl(path)
    assert str(path) in str(caught.value)


def test_a_truncated_file_is_refused_wherever_it_ends(tmp_path: Path, fields: dict[str, np.ndarray]) -> None:
    path, whole = tmp_path / "a.bsdf", tensor_file(fields)
    for length in {*range(0, len(whole), 61), len(whole) - 1}:
        path.write_bytes(whole[:length])
        with pytest.raises(InputFileError):
            read_rgl(path)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"#?RADIANCE\n", "no tensor file"),
        (b"tensor_file\0\2\0\0\0\0\0", "version 2.0; only 1.0"),
        (b"tensor_file\0\1\0\0\0\0\0", "no field phi_i"),
        (b"tensor_file\0\1\0\xff\xff\xff\xff", "ends too early"),
        (b"tensor_file\0\1\0\1\0\0\0" + b"\1\0a" + b"\0\0\x63" + bytes(8), "unknown type 99"),
        (b"tensor_file\0\1\0\1\0\0\0" + b"\1\0\xff" + b"\0\0\1" + bytes(8), "truncated or damaged"),
        (b"tensor_file\0\1\0\1\0\0\0" + b"\1\0a" + b"\2\0\x0b" + bytes(8) + b"\xff" * 16, "too large"),
        (b"tensor_file\0\1\0\1\0\0\0" + b"\1\0a" + b"\0\0\1" + b"\xff" * 8, "truncated or damaged"),
    ],
)
def test_damaged_headers_are_refused_in_words(tmp_path: Path, content: bytes, sentence: str) -> None:
    path = tmp_path / "a.bsdf"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match=sentence):
        read_rgl(path)


@pytest.fixture(params=NAMES)
def measured(request: pytest.FixtureRequest) -> Path:
    """A real file."""
    return measurement(f"brdf/rgl/{request.param}_rgb.bsdf")


@pytest.mark.filterwarnings("ignore::rsibr.rsibr_addon.core.errors.RsibrWarning")
def test_real_materials_reflect_what_their_measured_weights_average_to(measured: Path) -> None:
    brdf = read_rgl(measured)
    # A direction drawn by the warp is worth its weight: the albedo of a measured view is the mean over the
    # square. The files' own density of normals, times the cosine, integrates to 1.008; then 8 views
    # are interpolated, and tables are linear
    weight = brdf.weight[:-1]
    corners = (weight[..., 1:, 1:], weight[..., :-1, 1:], weight[..., 1:, :-1], weight[..., :-1, :-1])
    expected = np.mean(corners, axis=(0, 3, 4))
    albedo = directional_albedo(brdf, np.cos(brdf.theta_v[:-1]))
    np.testing.assert_allclose(albedo, expected, rtol=0.02, atol=0.005)
    assert albedo.max() < 1.2  # a vinyl that was measured with 1.09 at 79 degrees


@pytest.mark.filterwarnings("ignore::rsibr.rsibr_addon.core.errors.RsibrWarning")
def test_real_materials_are_nearly_reciprocal_and_smooth(measured: Path) -> None:
    brdf, rng = read_rgl(measured), np.random.default_rng(0)
    z, phi = rng.uniform(0.1, 1.0, (2, 20_000)), 2.0 * np.pi * rng.random((2, 20_000))
    radius = np.sqrt(1.0 - z**2)
    light_dir, view_dir = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    forwards, backwards = (
        brdf(*pair).mean(axis=1) for pair in ((light_dir, view_dir), (view_dir, light_dir))
    )
    assert np.isfinite(forwards).all()
    assert forwards.min() >= 0.0
    weight = light_dir[:, 2] * view_dir[:, 2]
    # Measured apart, and interpolated between eight views: 12 % is seen, 28 % were the cosine forgotten
    assert np.sum(weight * np.abs(forwards - backwards)) < 0.15 * np.sum(weight * forwards)
    # A lobe of one view along the plane of incidence moves on without jumps
    theta = np.radians(np.linspace(-85.0, 85.0, 3401))
    line = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    lobe = brdf(line, np.array([-np.sin(0.7), 0.0, np.cos(0.7)]))[:, 0]
    assert np.abs(np.diff(lobe)).max() < 0.2 * lobe.max()
