"""Relight what was captured of a node tree, beside Cycles, for docs/captured-lobes.md.

The tree is no model: a layer weight mixes a diffuse with a glossy shader, and a sharper one is mixed in.
It is captured once, in `forest`; lobes fitted to that show it in three other environments.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.lobes.bake import bake_stack
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.lobe_stack import GpuLobeStack
from rsibr.rsibr_addon.files.fits import read_fit
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.host.meshes import load_mesh
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.fit import FitSettings
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.compare.comparison import random_directions
from rsibr.rsibr_addon.tasks.compare.contact_sheet import contact_sheet
from rsibr.rsibr_addon.tasks.compare.exact import picture
from rsibr.rsibr_addon.tasks.compare.lobe_stack import StackWay
from rsibr.rsibr_addon.tasks.compare.pictures import difference_picture
from rsibr.rsibr_addon.tasks.compare.references import Captured, error_beyond_noise, noise_of, rendered
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.reflectance.fit_lobes import fit_lobes

CAPTURED_IN, RELIT_IN = "forest", ("city", "sunset", "interior")
MAPS, CAPTURE_SAMPLES = 64, 64
VIEWS, SIZE, SAMPLES = 3, 48, 1024
PICTURE = Path(__file__).parents[1] / "docs" / "images" / "relit-node-tree.png"


@dataclass(frozen=True)
class _Samples:
    """What `references.rendered` asks of settings."""

    size: int = SIZE
    samples: int = SAMPLES
    seed: int = 0


def build_tree(path: Path) -> str:
    """Write the material's file, and tell its name for commands."""
    material = bpy.data.materials.new("Shell")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output, outer, inner = (
        tree.nodes.new(kind) for kind in ("ShaderNodeOutputMaterial", *2 * ["ShaderNodeMixShader"])
    )
    diffuse, wide, sharp = (
        tree.nodes.new(kind) for kind in ("ShaderNodeBsdfDiffuse", *2 * ["ShaderNodeBsdfGlossy"])
    )
    facing = tree.nodes.new("ShaderNodeLayerWeight")
    facing.inputs["Blend"].default_value = 0.4
    diffuse.inputs["Color"].default_value = (0.05, 0.25, 0.3, 1.0)
    wide.inputs["Color"].default_value, wide.inputs["Roughness"].default_value = (0.9, 0.5, 0.2, 1.0), 0.6
    sharp.inputs["Color"].default_value, sharp.inputs["Roughness"].default_value = (0.8, 0.8, 0.9, 1.0), 0.3
    tree.links.new(facing.outputs["Facing"], inner.inputs["Factor"])
    tree.links.new(diffuse.outputs[0], inner.inputs[1])
    tree.links.new(wide.outputs[0], inner.inputs[2])
    outer.inputs["Factor"].default_value = 0.15
    tree.links.new(inner.outputs[0], outer.inputs[1])
    tree.links.new(sharp.outputs[0], outer.inputs[2])
    tree.links.new(outer.outputs[0], output.inputs["Surface"])
    material.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return f"{path}:Shell"


def main() -> None:
    """Capture, fit, relight and measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="where the capture is kept")
    folder = parser.parse_args().folder.resolve()
    folder.mkdir(exist_ok=True)
    spec = build_tree(folder / "shell.blend")
    capture, fit = folder / "shell.rsibr.exr", folder / "shell.json"
    settings = RadianceViewsSettings(material=spec, size=MAPS, samples=CAPTURE_SAMPLES, denoise=False)
    drain(bake(BakeJob(settings, str(capture), Light(environment=CAPTURED_IN), if_missing=True)))
    if not fit.exists():
        drain(fit_lobes(FitSettings(captures=str(capture)), fit))
    stated = read_fit(fit).left_out
    ensure_context()
    mesh = load_mesh("sphere")
    cameras = [Camera((x, y, z)) for x, y, z in random_directions(VIEWS, 0).tolist()]
    lines = ["| relit in | error | worst view | noise of Cycles |", "|---|---:|---:|---:|"]
    sheet = []
    for name in RELIT_IN:
        light = load_environment(name)
        stack = drain(bake_stack(light.radiance, read_fit(fit), "octahedral", 128)).stack
        ours = [picture(GpuLobeStack(stack), StackLook(), mesh, camera, SIZE) for camera in cameras]
        true = drain(rendered(Captured(spec, light, None), cameras, _Samples()))
        way = StackWay(len(stack.maps), len(stack.mu), 1)
        found = error_beyond_noise(way, ours, true)
        pooled = f"{found.pooled:.1%}" if found.pooled else "less than its noise tells"
        lines.append(f"| {name} | {pooled} | {found.worst:.1%} | {noise_of(true):.1%} |")
        print(lines[-1], flush=True)
        worst = int(
            np.argmax([error_beyond_noise(way, [o], [t]).pooled for o, t in zip(ours, true, strict=True)])
        )
        reference = true[worst].rgba
        scale = 0.35 / np.sqrt(np.mean(reference[..., :3] ** 2))
        shown = [each * np.array([scale, scale, scale, 1.0]) for each in (reference, ours[worst])]
        sheet += [*shown, difference_picture(shown[1], shown[0], 0.1)]
    noise = read_map_set_header(capture)["error_bound"]["relative_noise"]
    lines.append(
        f"\nThe fit states {stated:.1%} for views of its own light that were left out; the capture's noise "
        f"is {noise:.0%}."
    )
    save_png(PICTURE, contact_sheet(sheet, 3))
    write_table("captured-lobes.md", "relit", "\n".join(lines))


if __name__ == "__main__":
    main()
