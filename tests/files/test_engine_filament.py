"""Light for Filament, read back as its loader does, by nothing of ours, against the sum over all texels."""

import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.radiance_hdr import write_hdr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.tests.engine_light import check_cube, cube_directions, diffuse_truth, exported, from_y_up, sky


def read_ktx1(path: Path) -> tuple[list[np.ndarray], dict[str, str], tuple[int, ...]]:
    """Levels, notes and header of a KTX 1 file of packed floats."""
    data = path.read_bytes()
    assert data[:12] == b"\xabKTX 11\xbb\r\n\x1a\n"
    header = struct.unpack_from("<13I", data, 12)
    width, mips, noted = header[6], header[11], header[12]
    notes, at = {}, 64
    while at < 64 + noted:
        (length,) = struct.unpack_from("<I", data, at)
        key, value = data[at + 4 : at + 4 + length].split(b"\0", 1)
        notes[key.decode()] = value.decode()
        at += 4 + -(-length // 4) * 4
    levels = []
    for mip in range(mips):
        (length,) = struct.unpack_from("<I", data, at)
        size = width >> mip
        assert length == 4 * size**2
        packed = np.frombuffer(data, "<u4", 6 * size**2, at + 4).reshape(6, size, size)
        levels.append(
            np.stack([small_float(packed, *place) for place in ((0, 6), (11, 6), (22, 5))], axis=-1)
        )
        at += 4 + 6 * length
    assert at == len(data)
    return levels, notes, header


def small_float(packed: np.ndarray, start: int, bits: int) -> np.ndarray:
    """The value of a float of 5 bits of exponent and so many of mantissa: OpenGL 4.6, section 2.3.4.3."""
    mantissa = (packed >> start & (1 << bits) - 1) / (1 << bits)
    exponent = (packed >> start + bits & 31).astype(np.float64)
    return np.where(exponent == 0, 2.0**-14 * mantissa, 2.0 ** (exponent - 15.0) * (1.0 + mantissa))


def filament_irradiance(text: str, normal: np.ndarray) -> np.ndarray:
    """What Filament's shader makes of the text."""
    terms = np.array([float(word) for word in text.split()]).reshape(9, 3)
    x, y, z = np.moveaxis(normal, -1, 0)
    one = np.ones_like(x)
    return np.stack([one, y, z, x, y * x, y * z, 3 * z * z - 1, z * x, x * x - y * y], axis=-1) @ terms


def test_filament_shows_the_light_upright(tmp_path: Path) -> None:
    lit, sky_box = exported(tmp_path, "filament", ".ktx")
    assert (lit.name, sky_box.name) == ("sky.ktx", "sky-skybox.ktx")
    levels, notes, _ = read_ktx1(lit)
    # The shader looks up at last (2 r - r^2), down to 16 texels
    check_cube(levels, [0.0, 1.0 - np.sqrt(0.5), 1.0], from_y_up, np.array([2.0**-7, 2.0**-7, 2.0**-6]))
    normal = cube_directions(8)
    irradiance = filament_irradiance(notes["sh"], normal)
    wanted = diffuse_truth(from_y_up(normal))
    # Degree 2 leaves at most a few per cent of the mean [Ramamoorthi2001]
    assert np.abs(irradiance - wanted).max() < 0.06 * wanted.mean()
    np.testing.assert_array_equal(read_ktx1(sky_box)[0], levels[:1])


@pytest.mark.needs("cmgen")  # which is in Debian's libfilament-tools
def test_filaments_own_tool_writes_the_same(tmp_path: Path) -> None:
    # cmgen takes a map's middle to be +Z, we take it to be +X: a quarter turn
    turned = np.roll(sky(), -len(sky()) // 2, axis=1)
    write_hdr(tmp_path / "sky.hdr", turned)
    cmgen = ["cmgen", "-q", "--format=ktx", "--size=64", "--sh-window=no", f"--deploy={tmp_path / 'theirs'}"]
    subprocess.run([*cmgen, tmp_path / "sky.hdr"], check=True)
    for ours, part in zip(exported(tmp_path, "filament", ".ktx"), ("ibl", "skybox"), strict=True):
        theirs = tmp_path / "theirs" / f"theirs_{part}.ktx"
        levels, notes, header = read_ktx1(ours)
        their_levels, their_notes, their_header = read_ktx1(theirs)
        # All but the length of the text
        assert header[:12] == their_header[:12]
        assert notes.keys() == their_notes.keys()
        for mine, other in zip(levels, their_levels, strict=True):
            # Its 1024 samples miss the sum by 3 to 6 per cent
            assert np.median(np.abs(mine - other) / mine) < 0.06
        if notes:
            normal = cube_directions(4)
            mine, other = (filament_irradiance(each["sh"], normal) for each in (notes, their_notes))
            np.testing.assert_allclose(mine, other, rtol=0.05)


def test_light_beyond_an_encoding_is_cut_and_told(tmp_path: Path) -> None:
    sun = np.ones((8, 16, 3), np.float32)
    sun[6, 3] = 1e6
    write_radiance(tmp_path / "sun.exr", sun)
    with pytest.warns(
        RsibrWarning, match=r"sun\.exr has radiance up to 9\d+, and R11F_G11F_B10F ends at 64512"
    ):
        lit, _ = drain(export_for_engine(tmp_path / "sun.exr", tmp_path / "sun.ktx", "filament"))
    levels, _, _ = read_ktx1(lit)
    assert max(level.max() for level in levels) == 64512.0
