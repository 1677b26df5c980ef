"""Which pictures hold baked inputs, and inputs with pictures in their place."""

from dataclasses import fields, replace

import numpy as np
from rsibr.rsibr_addon.core.materials.packing import CHANNELS, COLORS, NORMALS, pictures_of, with_pictures
from rsibr.rsibr_addon.core.materials.principled import Baked, Input, NormalMap, PrincipledInputs, Texture
from rsibr.rsibr_addon.core.materials.sampling import evaluate

NAMES = [field.name for field in fields(PrincipledInputs) if field.name != "missing"]
CONSTANT = {
    name: None if name in NORMALS else Input(CHANNELS if name in COLORS else CHANNELS[:1]) for name in NAMES
}


def inputs(*baked: str) -> PrincipledInputs:
    return replace(PrincipledInputs(**CONSTANT), **{name: Baked("Noise Texture") for name in baked})


def test_every_baked_input_is_in_one_picture() -> None:
    pictures = pictures_of(inputs(*NAMES))
    assert sorted(name for picture in pictures for name in picture) == sorted(NAMES)
    assert {len(picture) for picture in pictures if picture[0] in COLORS + NORMALS} == {1}
    assert len(pictures) == len(COLORS) + len(NORMALS) + 4  # 12 values, three together
    assert pictures_of(inputs()) == ()


def test_pictures_take_the_place_of_what_is_baked() -> None:
    wanted = inputs("base_color", "roughness", "metallic", "normal", "alpha")
    textures = {
        picture: Texture(" ".join(picture), bake="a.exr", uv_map="other") for picture in pictures_of(wanted)
    }
    given = with_pictures(wanted, textures.items())
    assert given.base_color == Input(CHANNELS, textures["base_color",])
    values = textures["metallic", "roughness", "alpha"]
    assert given.metallic == Input(CHANNELS[:1], values)
    assert given.alpha == Input(CHANNELS[2:], values)
    assert isinstance(given.normal, NormalMap)
    assert given.normal.color.texture == textures["normal",]
    assert given.normal.uv_map == "other"
    assert given.ior == wanted.ior


def test_a_picture_s_colours_are_the_values_as_they_are() -> None:
    wanted = inputs("base_color", "roughness", "metallic", "normal", "alpha")
    given = with_pictures(wanted, [(each, Texture("picture", bake="a.exr")) for each in pictures_of(wanted)])
    texels, uv = np.array([[[0.1, 0.2, 0.3, 0.4]]]), np.zeros(2)
    for value, held in {given.metallic: 0.1, given.roughness: 0.2, given.alpha: 0.3}.items():
        np.testing.assert_allclose(evaluate(value, texels, uv), held, rtol=1e-12)
    for colour in (given.base_color, given.normal.color):
        np.testing.assert_allclose(evaluate(colour, texels, uv), [0.1, 0.2, 0.3], rtol=1e-12)
    assert given.normal.strength.constant == (1.0,)


def test_old_pictures_leave_what_is_followed_by_now() -> None:
    old = [(("base_color",), Texture("0 base_color", bake="a.exr"))]
    now = inputs("metallic")
    assert with_pictures(now, old) == now
