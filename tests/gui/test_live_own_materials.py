"""Live light in Blender's window: objects show their own materials in what surrounds them, and follow it."""

from collections.abc import Callable

import pytest
from rsibr.tests.gui.test_live_light import PRELUDE

Told = Callable[[str], dict]

OWN = """
def painted(colours):
    # An image of as many texels beside each other
    image = bpy.data.images.new("Stripes", len(colours), 1, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    image.pixels = [channel for colour in colours for channel in (*colour, 1.0)]
    image.pack()
    return image

def scenario(told):
    cube = mirror()
    cube.rsibr.live.mips = False
    material = cube.active_material
    nodes, links = material.node_tree.nodes, material.node_tree.links
    inputs = nodes["Principled BSDF"].inputs
    inputs["Metallic"].default_value, inputs["Roughness"].default_value = 1.0, 0.0
    inputs["Base Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    colours = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1)]
    walls = room(colours)
    region_3d = view().spaces.active.region_3d
    region_3d.view_perspective = "ORTHO"
    towards = Vector((0.75, -0.5, 0.43)).normalized()  # each side mirrors a wall's middle
    region_3d.view_rotation = towards.to_track_quat("Z", "Y")
    yield from drawn()
    among = own()
    cube.rsibr.live.on = True
    yield from drawn()
    told["kind"], told["area"] = previews.kind(cube), int(among.sum())
    picture = pixels()
    told["mirrored"] = []
    for side in map(Vector, ((1, 0, 0), (0, -1, 0), (0, 0, 1))):
        x, y = location_3d_to_region_2d(region(view()), region_3d, side)
        reflected = towards.reflect(side) * -1.0
        axis = max(range(3), key=lambda i: abs(reflected[i]))
        wall = colours[2 * axis + (reflected[axis] < 0.0)]
        told["mirrored"].append(bool(like(picture[int(y), int(x)], tuple(255 * c for c in wall))))
    # A white wall all around, and a tile of red and one of green, matte: what is lit evenly shows its colour
    for wall in walls:
        wall.color = (1.0, 1.0, 1.0, 1.0)
    texture = nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = painted([(0.5, 0.0, 0.0), (0.0, 0.5, 0.0)]), "Closest"
    links.new(texture.outputs["Color"], inputs["Base Color"])
    inputs["Metallic"].default_value, inputs["Specular IOR Level"].default_value = 0.0, 0.0
    yield from drawn()
    shown = [int((among & like(pixels(), colour)).sum()) for colour in ((188, 0, 0), (0, 188, 0))]
    told["textured"] = [min(shown) > 1000, int(among.sum()) - sum(shown)]
    for wall in walls:
        wall.color = (0.5, 0.5, 0.5, 1.0)
    yield from drawn()
    shown = [int((among & like(pixels(), colour)).sum()) for colour in ((137, 0, 0), (0, 137, 0))]
    told["darker"] = [min(shown) > 1000, int(among.sum()) - sum(shown)]
    told["messages"] = [previews.messages(cube), previews.faults.trouble]
    cube.rsibr.kernel_pyramid.own = False
    cube.rsibr.kernel_pyramid.base_color = (0.2, 0.2, 1.0)
    cube.rsibr.kernel_pyramid.metallic = 1.0
    yield from drawn()
    told["by sliders"] = others((89, 89, 188), among)
"""


@pytest.mark.slow
def test_own_materials_are_lit_by_what_surrounds_them(told: Told) -> None:
    answer = told(PRELUDE + OWN)
    assert answer["kind"] == "kernel_pyramid"
    assert answer["area"] > 2000
    assert answer["mirrored"] == [True, True, True]
    # Edges between the tiles, and between faces of the cube, are averaged over pixels
    assert answer["textured"][0]
    assert answer["textured"][1] < 0.1 * answer["area"]
    assert answer["darker"][0]
    assert answer["darker"][1] < 0.1 * answer["area"]
    assert answer["messages"] == [[], None]
    assert answer["by sliders"] == 0
