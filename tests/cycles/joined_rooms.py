"""Two rooms with a door between them, and a ball that moves through it, by Cycles and from probes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.live_environment import chain_of_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.probes import Place, Probe
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook, mip_chain_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import tent_halved
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.rsibr_addon.host.spheres import add_ball
from rsibr.rsibr_addon.settings.environment import SceneLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene

WIDTHS, HALF_DOOR, DOOR_HEIGHT, GAP = (6.0, 5.0, 4.0), 1.2, 1.2, 0.01
"""Each room's; half of the door's width, its top above their middles, and half of the wall's thickness."""

MIDDLES = (-3.0, 0.0, 0.0), (3.0, 0.0, 0.0)
COLOURS = (0.9, 0.5, 0.25), (0.2, 0.5, 0.9)
CAMERA = Camera((0.5, -0.7, 0.4))
RADIUS = 0.5


def add_rooms() -> None:
    """Rooms left and right of x = 0 whose walls shine, each in a colour that changes along them."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for side, colour in zip((-1.0, 1.0), COLOURS, strict=True):
        (_, y, z), beside = 0.5 * np.array(WIDTHS), side * GAP
        far = side * WIDTHS[0]
        outer = [
            [(beside, a * y, -z), (far, a * y, -z), (far, a * y, z), (beside, a * y, z)] for a in (-1, 1)
        ]
        outer += [
            [(beside, -y, b * z), (far, -y, b * z), (far, y, b * z), (beside, y, b * z)] for b in (-1, 1)
        ]
        outer.append([(far, -y, -z), (far, y, -z), (far, y, z), (far, -y, z)])
        walls = [(-y, -HALF_DOOR, -z, z), (HALF_DOOR, y, -z, z), (-HALF_DOOR, HALF_DOOR, DOOR_HEIGHT, z)]
        outer += [[(beside, a, c), (beside, b, c), (beside, b, d), (beside, a, d)] for a, b, c, d in walls]
        mesh = bpy.data.meshes.new("walls")
        corners = [corner for face in outer for corner in face]
        mesh.from_pydata(corners, [], np.arange(len(corners)).reshape(-1, 4).tolist())
        mesh.materials.append(shining(colour, (0.03, 0.08, 0.08)))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new("walls", mesh))


def shining(colour: Sequence[float], change: Sequence[float]) -> bpy.types.Material:
    """What shines in a colour at the origin, whose channels change by `change` along x, y and z."""
    material = bpy.data.materials.new("walls")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    place, wave = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeVectorMath")
    shine, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    wave.operation = "MULTIPLY_ADD"
    wave.inputs[1].default_value, wave.inputs[2].default_value = change, colour
    links.new(place.outputs["Position"], wave.inputs[0])
    links.new(wave.outputs["Vector"], shine.inputs["Color"])
    links.new(shine.outputs["Emission"], output.inputs["Surface"])
    return material


def rooms_chain(folder: Path, size: int, blend: float) -> MipChain:
    """The light of both rooms, captured in their middles, as probes in darkness."""
    probes = []
    for number, middle in enumerate(MIDDLES):
        light = SceneLight(size=4 * size, samples=1, point=middle)
        radiance = read_radiance(drain(illuminate_from_scene(light, folder / f"room{number}.exr")))
        chain = chain_of_faces(environment_faces(radiance, size).astype(np.float32), tent_halved)
        probes.append(Probe(Place(middle, Room.BOX, WIDTHS, middle, blend), chain.mips))
    dark = chain_of_faces(np.zeros((6, size, size, 3), np.float32), tent_halved)
    return MipChain(dark.mips, dark.harmonics, spread=dark.spread, probes=tuple(probes))


def rendered(material: bpy.types.Material, at: Sequence[float], size: int, samples: int) -> Array:
    """A ball in the rooms by Cycles, lit by the walls alone."""
    scene = bpy.context.scene
    ball = add_ball(scene, RADIUS, material, at)
    camera = add_camera(scene, CAMERA)
    camera.location = np.array(at) + np.array(camera.location) * RADIUS
    camera.data.ortho_scale *= RADIUS
    configure_cycles(scene, size, size, samples)
    cycles = scene.cycles
    cycles.max_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = 1
    scene.view_settings.view_transform = "Standard"
    try:
        return render_passes(scene)["Combined"][..., :3]
    finally:
        bpy.data.objects.remove(ball)
        bpy.data.objects.remove(camera)


def from_probes(chain: MipChain, look: MipLook, at: Sequence[float], size: int) -> Array:
    """The same ball from probes, by the reference in numpy."""
    normal = sphere_map.normal_from_uv(texel_centres(4 * size, 4 * size)) @ CAMERA.frame.T
    shaded = mip_chain_radiance(chain, normal, CAMERA.view_dir, look, position=at + RADIUS * normal)
    return shaded.reshape(size, 4, size, 4, 3).mean(axis=(1, 3))


def inside(size: int) -> Array:
    """The pixels within the ball's outline, shape (size, size)."""
    return np.linalg.norm(2.0 * texel_centres(size, size) - 1.0, axis=-1) < 0.9


def of_one(chain: MipChain, number: int) -> MipChain:
    """The light of one room alone, wherever one is."""
    probe = chain.probes[number]
    return replace(chain, probes=(replace(probe, place=replace(probe.place, blend=1e6)),))


def errors(
    chain: MipChain,
    material: bpy.types.Material,
    look: MipLook,
    along: Sequence[float],
    size: int,
    samples: int,
) -> dict[str, float]:
    """Root mean square errors against Cycles, of balls at places along x: way to choose probes -> error."""
    squares: dict[str, list[float]] = {"one": [], "nearest": [], "blended": []}
    for x in along:
        at = (x, 0.3, -0.2)
        reference = rendered(material, at, size, samples)
        chosen = {"one": of_one(chain, 0), "nearest": of_one(chain, int(x > 0.0)), "blended": chain}
        for way, each in chosen.items():
            wrong = (from_probes(each, look, at, size) - reference)[inside(size)]
            squares[way].append(float(np.mean(wrong**2)))
    return {way: float(np.sqrt(np.mean(each))) for way, each in squares.items()}
