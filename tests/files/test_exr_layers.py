"""Which channels of an OpenEXR file are taken for the picture, and what its header makes of them."""

from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.chromaticities import REC_709, XYZ, luminance_weights, rec709_from
from rsibr.rsibr_addon.files.pictures import describe_exr, read_exr, split_layer

AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)
AP1 = (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)
SCANLINES = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}


@pytest.fixture
def rgb() -> np.ndarray:
    """A picture as files hold it, top row first; exact in half floats."""
    return np.random.default_rng(0).integers(1, 2048, (16, 32, 3)).astype(np.float32) / 64


def write(path: Path, *parts: dict, **attributes: object) -> Path:
    """Write a file with the package alone; parts may have names, as an entry "name"."""
    described = []
    for number, part in enumerate(parts):
        planes = {
            name: pixels if isinstance(pixels, OpenEXR.Channel) else np.ascontiguousarray(pixels)
            for name, pixels in part.items()
            if name != "name"
        }
        described.append(OpenEXR.Part(SCANLINES | attributes, planes, part.get("name", str(number))))
    OpenEXR.File(described).write(str(path))
    return path


def channels(rgb: np.ndarray, prefix: str = "", names: str | list[str] = "RGB") -> dict[str, np.ndarray]:
    return {prefix + name: rgb[..., i] for i, name in enumerate(names)}


@pytest.mark.parametrize(
    "names", ["RGB", "rgb", ["red", "green", "blue"], ["Red", "Green", "Blue"], ["RED", "GREEN", "BLUE"]]
)
@pytest.mark.parametrize("prefix", ["", "ViewLayer.Combined.", "only."])
def test_channels_are_known_by_any_name_of_theirs(
    tmp_path: Path, rgb: np.ndarray, names: str, prefix: str
) -> None:
    others = {f"{prefix}Depth.Z": rgb[..., 0], f"{prefix}id": rgb[..., 0].astype(np.uint32)}
    path = write(tmp_path / "a.exr", channels(rgb, prefix, names) | others)
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])


def test_capitals_win(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb) | channels(7 * rgb, names="rgb"))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])


@pytest.mark.parametrize(
    "main",
    [
        "ViewLayer.Combined.",
        "Composite.Combined.",
        "beauty.",
        "rgba.",
        "RGBA.",
        "C.",
        "Beauty.x.",
        "Image.",
        "",
    ],
)
def test_of_a_renders_passes_the_picture_is_taken(tmp_path: Path, rgb: np.ndarray, main: str) -> None:
    passes = channels(7 * rgb, "ViewLayer.DiffCol.") | channels(7 * rgb, "A.D.") | {"AO.Y": rgb[..., 0]}
    path = write(tmp_path / "a.exr", passes | channels(rgb, main))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])


def test_any_layer_can_be_named(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb, "V.Combined.") | channels(2 * rgb, "V.Sky.X."))
    np.testing.assert_array_equal(read_exr(f"{path}:V.Sky.X"), 2 * rgb[::-1])
    np.testing.assert_array_equal(read_exr(f"{path}:sky.x"), 2 * rgb[::-1])
    np.testing.assert_array_equal(read_exr(f"{path}:Combined"), rgb[::-1])
    with pytest.raises(InputFileError, match=r"holds no layer Fog: choose V\.Combined, V\.Sky\.X\."):
        read_exr(f"{path}:Fog")


def test_names_of_files_may_have_colons(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr:b", channels(rgb))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])
    assert split_layer(path) == (path, None)
    assert split_layer("C:/a.exr") == (Path("C:/a.exr"), None)
    assert split_layer("C:/a.exr:V.Sky") == (Path("C:/a.exr"), "V.Sky")
    assert split_layer("forest") == (Path("forest"), None)


def test_passes_alone_are_left_to_the_user(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb, "DiffCol.") | channels(rgb, "GlossCol."))
    with pytest.raises(InputFileError, match=r"layers \(DiffCol, GlossCol\): name one, as .*:DiffCol\."):
        read_exr(path)


@pytest.mark.parametrize(
    "parts", [("left.", "right."), ("A.Combined.", "B.Combined."), ("V.left.Combined.", "V.right.Combined.")]
)
def test_of_equals_the_first_is_taken_and_told_of(
    tmp_path: Path, rgb: np.ndarray, parts: tuple[str, str]
) -> None:
    path = write(tmp_path / "a.exr", channels(rgb, parts[0]) | channels(7 * rgb, parts[1]))
    with pytest.warns(RsibrWarning, match=f"{parts[0][:-1]} is taken, {parts[1][:-1]} not; name another"):
        picture = read_exr(path)
    np.testing.assert_array_equal(picture, rgb[::-1])


def test_a_part_in_colour_goes_before_grey_ones(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(
        tmp_path / "a.exr",
        {"name": "occlusion", "Y": rgb[..., 0]},
        {"name": "depth", "Z": rgb[..., 0]},
        {"name": "sky"} | channels(rgb),
        {"name": "moon"} | channels(7 * rgb),
    )
    with pytest.warns(RsibrWarning, match="sky is taken, occlusion, moon not; name another as .*:occlusion"):
        picture = read_exr(path)
    np.testing.assert_array_equal(picture, rgb[::-1])
    np.testing.assert_array_equal(read_exr(f"{path}:moon"), 7 * rgb[::-1])


@pytest.mark.parametrize("stated", [None, AP1])
def test_luminance_and_chroma_become_colours(tmp_path: Path, rgb: np.ndarray, stated: tuple | None) -> None:
    weights = luminance_weights(stated or REC_709)
    luminance = rgb @ weights
    chroma = {"RY": rgb[..., 0] / luminance - 1, "BY": rgb[..., 2] / luminance - 1}
    planes = {name: plane.astype(np.float32) for name, plane in ({"Y": luminance} | chroma).items()}
    path = write(tmp_path / "a.exr", planes, **({"chromaticities": stated} if stated else {}))
    expected = rgb[::-1] @ rec709_from(stated or REC_709).T
    # Single precision, with 32 the greatest value
    np.testing.assert_allclose(read_exr(path), expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize(("names", "left"), [(("RY",), "RY"), (("BY",), "BY"), (("R", "B"), "R, B")])
def test_a_part_of_a_colour_is_told_of(
    tmp_path: Path, rgb: np.ndarray, names: tuple[str, ...], left: str
) -> None:
    planes = {f"V.{name}": rgb[..., i] for i, name in enumerate(("Y", *names))}
    path = write(tmp_path / "a.exr", planes | {"Z": rgb[..., 0]})
    told = ", ".join(f"V.{name}" for name in names)
    with pytest.warns(RsibrWarning, match=rf"a\.exr has {told} beside V\.Y, but not the other channels"):
        picture = read_exr(path)
    np.testing.assert_array_equal(picture, rgb[::-1, :, :1])


@pytest.mark.parametrize("step", [(2, 2), (2, 1), (4, 2)])
def test_subsampled_chroma_is_interpolated(tmp_path: Path, step: tuple[int, int]) -> None:
    # Colours that change slowly: a period of 64 texels, of which a chroma has every second or fourth
    x, y = np.meshgrid(np.arange(64), np.arange(48))
    luminance = 2.0 + np.cos(x) + (x + y) % 2
    red = 0.2 * np.sin(2 * np.pi * x / 64 + 2 * np.pi * y / 48)
    blue = 0.1 * np.cos(2 * np.pi * x / 64) * np.cos(2 * np.pi * y / 48)
    planes: dict[str, object] = {"Y": luminance.astype(np.float32)}
    for name, plane in (("RY", red), ("BY", blue)):
        # The package wants an array of the whole size, and writes the first samples of it
        stored = plane[:: step[1], :: step[0]].astype(np.float32).ravel()
        whole = np.zeros(plane.size, np.float32)
        whole[: stored.size] = stored
        planes[name] = OpenEXR.Channel(name, whole.reshape(plane.shape), *step)
    picture = read_exr(write(tmp_path / "a.exr", planes))[::-1].astype(float)
    found_red, found_blue = (picture[..., i] / luminance - 1 for i in (0, 2))
    inner = np.s_[6:-6, 12:-12]  # at the edges the last sample repeats
    # 0.2 (pi / 8)^6 / 205, of quintic polynomials at 16 samples a period
    np.testing.assert_allclose(found_red[inner], red[inner], rtol=0, atol=1e-5)
    np.testing.assert_allclose(found_blue[inner], blue[inner], rtol=0, atol=1e-5)
    # Whatever the chroma, the luminance is what is stored; in single precision
    np.testing.assert_allclose(picture @ luminance_weights(REC_709), luminance, rtol=1e-5)


def test_xyz_is_cie_xyz(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb, names="XYZ"))
    with pytest.warns(RsibrWarning, match="X, Y and Z, which are taken as CIE XYZ"):
        picture = read_exr(path)
    np.testing.assert_allclose(picture, rgb[::-1] @ rec709_from(XYZ).T, rtol=0, atol=1e-4)


@pytest.mark.parametrize(
    ("attributes", "primaries"),
    [
        ({}, REC_709),
        ({"chromaticities": (0.0,) * 8}, REC_709),
        ({"chromaticities": AP0}, AP0),
        ({"colorInteropID": "lin_ap1_scene"}, AP1),
        ({"colorInteropID": "unknown"}, REC_709),
        ({"acesImageContainerFlag": 1}, AP0),
        ({"whiteLuminance": 0.0, "expTime": 0.5, "owner": "x"}, REC_709),
        ({"adoptedNeutral": np.float32([0.3127, 0.329])}, REC_709),
        ({"Orientation": 1, "oiio:ColorSpace": "scene_linear", "cycles.ViewLayer.samples": "9"}, REC_709),
    ],
)
def test_colours_are_those_that_the_header_states(
    tmp_path: Path, rgb: np.ndarray, attributes: dict, primaries: tuple
) -> None:
    path = write(tmp_path / "a.exr", channels(rgb), **attributes)
    # float32 arithmetic: three products of size up to 3 * 32
    np.testing.assert_allclose(read_exr(path), rgb[::-1] @ rec709_from(primaries).T, rtol=0, atol=1e-4)


@pytest.mark.parametrize(
    ("attributes", "sentence"),
    [
        ({"chromaticities": (0.3,) * 8}, "states chromaticities that span no colours"),
        ({"chromaticities": (np.nan,) * 8}, "states chromaticities that span no colours"),
        (
            {"chromaticities": (0.64, 0.33, 0.3, 0.6, 0.0, 0.0, 0.0, 0.0)},
            "states chromaticities that span no colours",
        ),
        ({"chromaticities": AP0, "colorInteropID": "lin_rec709_scene"}, "not those of lin_rec709_scene"),
        ({"colorInteropID": "data"}, "'data', which is not linear light"),
        ({"colorInteropID": "srgb_rec709_scene"}, "'srgb_rec709_scene', which is not linear light"),
        ({"oiio:ColorSpace": "ACEScg"}, "oiio:ColorSpace 'ACEScg', which is not used"),
        ({"pixelAspectRatio": 2.0}, "a pixelAspectRatio of 2"),
        ({"Orientation": 6}, "an Orientation of 6"),
        ({"envmap": OpenEXR.ENVMAP_CUBE}, "it is a cube map"),
        ({"adoptedNeutral": np.float32([0.4, 0.4])}, "an adoptedNeutral of 0.4 0.4"),
        ({"interim": 1, "exposure": 2.0}, "not used: exposure, interim"),
    ],
)
def test_what_is_not_used_of_a_header_is_told(
    tmp_path: Path, rgb: np.ndarray, attributes: dict, sentence: str
) -> None:
    path = write(tmp_path / "a.exr", channels(rgb), **attributes)
    with pytest.warns(RsibrWarning, match=sentence) as caught:
        read_exr(path)
    assert len(caught) == 1
    assert sentence in describe_exr(path).remarks[0]


def test_primaries_of_another_type_are_left_out(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb), chromaticities=(0.3,) * 8)
    path.write_bytes(path.read_bytes().replace(b"s\0chromaticities\0", b"s\0cbromaticities\0"))
    with pytest.warns(RsibrWarning, match="span no colours"):
        np.testing.assert_array_equal(read_exr(path), rgb[::-1])


@pytest.mark.parametrize(("corner", "side"), [((100, 0), 31), ((-40, 0), 31), ((0, 0), 20000)])
def test_pixels_beside_the_picture_or_a_speck_in_it_are_refused(
    tmp_path: Path, rgb: np.ndarray, corner: tuple[int, int], side: int
) -> None:
    window = (np.int32(corner), np.int32(corner) + np.int32([31, 15]))
    display = (np.int32([0, 0]), np.int32([side, side]))
    path = write(tmp_path / "a.exr", channels(rgb), dataWindow=window, displayWindow=display)
    with pytest.raises(InputFileError, match="is black, as its data window lies beside"):
        read_exr(path)


def test_names_that_are_no_text_are_refused_in_a_sentence(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", channels(rgb, "layer."))
    path.write_bytes(path.read_bytes().replace(b"layer.", b"lay\xffr."))
    with pytest.raises(InputFileError, match=r"a\.exr has names of channels that are not UTF-8"):
        read_exr(path)


def test_headers_tell_what_will_be_read(tmp_path: Path, rgb: np.ndarray) -> None:
    passes = channels(rgb, "V.Combined.") | channels(rgb, "V.Sky.")
    facts = describe_exr(write(tmp_path / "a.exr", passes, chromaticities=AP0))
    assert facts.size == (32, 16)
    assert facts.window == "0,0 to 31,15"
    assert facts.channels == "V.Combined.R, V.Combined.G, V.Combined.B"
    assert facts.layers == ("V.Combined", "V.Sky")
    assert facts.colours.startswith("of the primaries 0.7347 0.2653 0 1 ")
    assert facts.remarks == ()
