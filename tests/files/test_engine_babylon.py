"""Light for Babylon.js and in glTF, read back as that does, by nothing of ours, against the whole sum."""

import base64
import json
import struct
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from rsibr.rsibr_addon.core.filtering.irradiance import real_harmonics
from rsibr.rsibr_addon.core.rgbd import rgbd_from_radiance
from rsibr.tests.engine_light import check_cube, cube_directions, diffuse_truth, exported, from_mirrored_x

RNG = np.random.default_rng(3)


def pngs_of(data: bytes, places: list[dict[str, int]], folder: Path) -> list[np.ndarray]:
    """Radiance of RGBD pictures, row 0 on top, as Babylon.js decodes it."""
    made = []
    for place in places:
        path = folder / "face.png"
        path.write_bytes(data[place["position"] : place["position"] + place["length"]])
        picture = OpenImageIO.ImageInput.open(str(path), _unassociated())
        rgbd = picture.read_image(0, 0, 0, 4, "uint8") / 255.0
        picture.close()
        made.append(rgbd[..., :3] ** 2.2 / rgbd[..., 3:])
    return made


def _unassociated() -> OpenImageIO.ImageSpec:
    """Colours as they are in the file, not times alpha."""
    spec = OpenImageIO.ImageSpec()
    spec.attribute("oiio:UnassociatedAlpha", 1)
    return spec


def babylon_irradiance(polynomial: dict[str, list[float]], normal: np.ndarray) -> np.ndarray:
    """What its shader makes of a polynomial: `SphericalHarmonics.FromPolynomial`, each times its constant."""
    of = {name: np.array(colour) for name, colour in polynomial.items()}
    xx, yy, zz = of["xx"], of["yy"], of["zz"]
    terms = [
        0.282094 * 0.376127 * (xx + yy + zz),
        *(0.488603 * 0.977204 * of[name] for name in ("y", "z", "x")),
        *(1.092548 * 1.16538 * of[name] for name in ("xy", "yz")),
        0.315392 * (1.34567 * zz - 0.672834 * (xx + yy)),
        1.092548 * 1.16538 * of["zx"],
        0.546274 * 1.16538 * (xx - yy),
    ]
    x, y, z = np.moveaxis(normal, -1, 0)
    basis = [np.ones_like(x), y, z, x, y * x, y * z, 3 * z * z - 1, z * x, x * x - y * y]
    return np.pi * np.stack(basis, axis=-1) @ np.array(terms)


def test_babylon_takes_its_own_format(tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "babylon", ".env")
    data = path.read_bytes()
    assert data[:8] == bytes.fromhex("86168796f6d69636")
    text, _, pictures = data[8:].partition(b"\0")
    manifest = json.loads(text)
    assert (manifest["version"], manifest["width"]) == (1, 64)
    places = manifest["specular"]["mipmaps"]
    assert len(places) == 6 * 7
    assert places[-1]["position"] + places[-1]["length"] == len(pictures)
    faces = pngs_of(pictures, places, tmp_path)
    # It uploads pictures upside down, and looks up at 0.8 log2(alpha width)
    levels = [np.stack(faces[6 * mip : 6 * mip + 6])[:, ::-1] for mip in range(7)]
    alpha = [0.0, *(min(2.0 ** (mip / 0.8) / 64, 1.0) for mip in range(1, 7))]
    # A byte of gamma 2.2 is 1 % of a tenth, the darkest here
    check_cube(levels, [each**0.5 for each in alpha], from_mirrored_x, 0.01)
    wanted = diffuse_truth(from_mirrored_x(cube_directions(8)))
    shown = babylon_irradiance(manifest["irradiance"], cube_directions(8))
    # Degree 2 leaves at most a few per cent of the mean [Ramamoorthi2001]
    assert np.abs(shown - wanted).max() < 0.06 * wanted.mean()


@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_gltf_takes_its_extension(ending: str, tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "gltf", ending)
    data = path.read_bytes()
    if ending == ".glb":
        magic, version, length, text, kind = struct.unpack_from("<4s3I4s", data)
        assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
        described = json.loads(data[20 : 20 + text])
        binary, kind = struct.unpack_from("<I4s", data, 20 + text)
        pictures = data[28 + text :]
        assert (binary, kind) == (len(pictures), b"BIN\0")
    else:
        described = json.loads(data)
        pictures = base64.b64decode(described["buffers"][0]["uri"].partition(",")[2])
    assert described["buffers"][0]["byteLength"] == len(pictures)
    assert described["extensionsUsed"] == ["EXT_lights_image_based"]
    assert described["scenes"][described["scene"]]["extensions"] == {"EXT_lights_image_based": {"light": 0}}
    (light,) = described["extensions"]["EXT_lights_image_based"]["lights"]
    views = [described["bufferViews"][described["images"][each]["bufferView"]] for each in range(18)]
    places = [{"position": view["byteOffset"], "length": view["byteLength"]} for view in views]
    faces = pngs_of(pictures, places, tmp_path)
    levels = [np.stack([faces[face] for face in mip])[:, ::-1] for mip in light["specularImages"]]
    assert light["specularImageSize"] == 64
    check_cube(levels, [0.0, 0.5, 1.0], from_mirrored_x, 0.01)
    # Their sum over the nine harmonics of the specification's sources, of which odd orders are negative
    basis = real_harmonics(cube_directions(8), 2) * [1, -1, 1, -1, 1, -1, 1, -1, 1]
    wanted = diffuse_truth(from_mirrored_x(cube_directions(8)))
    assert np.abs(basis @ light["irradianceCoefficients"] / np.pi - wanted).max() < 0.06 * wanted.mean()


def test_babylons_divisor_beats_the_largest() -> None:
    radiance = np.exp2(RNG.uniform(-6.0, 7.0, (4000, 3)))
    rgbd = rgbd_from_radiance(radiance) / 255.0
    # What Babylon.js's own encoder does
    largest = (
        np.floor(np.minimum(255.0 / np.maximum(radiance.max(axis=-1, keepdims=True), 1.0), 255.0)) / 255.0
    )
    colour = np.rint(255.0 * (radiance * largest) ** (1 / 2.2)) / 255.0
    ours, theirs = (
        np.abs(colours**2.2 / divisors - radiance) / radiance
        for colours, divisors in ((rgbd[:, :3], rgbd[:, 3:]), (colour, largest))
    )
    assert np.median(ours) < 0.75 * np.median(theirs)
    assert np.all(rgbd[:, 3] >= 1 / 255)
