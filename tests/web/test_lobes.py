"""Lobes for engines, as three.js and WebGPU shade with them in a browser."""

import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.engine_light import from_y_up, sky
from rsibr.tests.web.browser import WEBGPU, asked

MATERIALS: list[dict[str, Any]] = [
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 0.08},
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 0.15},
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 0.6},
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 1.0},
    {"color": (0.5, 0.1, 0.05), "metalness": 0.0, "roughness": 0.3},
    {"color": (0.2, 0.4, 0.6), "metalness": 0.4, "roughness": 0.5},
]


SUNLIT = 30
"""The first so many points mirror a sun nearly."""


def light() -> np.ndarray:
    """A sky with two suns, which lobes of roughness 0.08 are narrower than."""
    texels = sky()
    texels[90, 100], texels[50, 30] = (4000.0, 3500.0, 3000.0), (2000.0, 3000.0, 4000.0)
    return texels


@cache
def pyramid() -> Pyramid:
    return drain(bake_pyramid(light(), 128)).pyramid


def points() -> tuple[np.ndarray, np.ndarray]:
    """Normals and views of a world with Y up, the latter from 5 degrees above the surface on."""
    rng = np.random.default_rng(4)
    normal, view_dir = normalize(rng.normal(size=(2, 400, 3)))
    x, y, z = pyramid().suns.direction[np.arange(200) % 2].T
    aside = rng.normal(size=(200, 3)) * rng.choice([0.01, 0.1, 0.5], (200, 1))
    view_dir[:200] = normalize(reflect(np.stack([x, z, -y], axis=-1), normal[:200]) + aside)
    (seen,) = np.nonzero(dot(normal, view_dir) > 0.09)
    used = np.concatenate([seen[seen < 200][:SUNLIT], seen[seen >= 200][:30]])
    return normal[used], view_dir[used]


WGSL = """
struct Point { color: vec3f, metalness: f32, normal: vec3f, roughness: f32, view_dir: vec4f };
@group(0) @binding(3) var<storage, read> points: array<Point>;
@group(0) @binding(4) var<storage, read_write> shown: array<vec4f>;

@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
  let it = points[id.x];
  shown[id.x] = vec4f(rsibr_shade(it.color, it.metalness, it.roughness, it.normal, it.view_dir.xyz), 1.0);
}
"""

HLSL = """
struct Point { float3 color; float metalness; float3 normal; float roughness; float4 view_dir; };
StructuredBuffer<Point> points : register(t3);
RWStructuredBuffer<float4> shown : register(u4);

[numthreads(1, 1, 1)] void main(uint3 id : SV_DispatchThreadID)
{
  Point it = points[id.x];
  shown[id.x] = float4(rsibr_shade(it.color, it.metalness, it.roughness, it.normal, it.view_dir.xyz), 1.0);
}
"""


def check(shown: list[Any], normal: np.ndarray, view_dir: np.ndarray) -> None:
    """Half floats and 8-bit weights of texels cost less than 1 %; the lookups are core's own."""
    assert len(pyramid().suns) == 2
    families = shipped_families()
    for material, found in zip(MATERIALS, shown, strict=True):
        surface = Surface(
            base_color=np.array(material["color"]),
            metallic=np.array(material["metalness"]),
            roughness=np.array(material["roughness"]),
        )
        wanted = principled_radiance(pyramid(), families, surface, from_y_up(normal), from_y_up(view_dir))
        error = np.array(found) - wanted
        for part in (slice(SUNLIT), slice(SUNLIT, None)):
            assert np.sqrt(np.mean(error[part] ** 2) / np.mean(wanted[part] ** 2)) < 0.01, material


def export(folder: Path) -> None:
    picture, output = folder / "sky.exr", folder / "sky.ktx2"
    write_radiance(picture, light())
    assert run(["export", str(picture), "--for", "lobes", "--widest", "128", "-o", str(output)]) == 0


@pytest.mark.slow
def test_three_shades_with_lobes_as_core_does(tmp_path: Path) -> None:
    export(tmp_path)
    normal, view_dir = points()
    question = {
        "name": "/files/sky",
        "materials": MATERIALS,
        "points": np.stack([normal, view_dir], axis=1).tolist(),
    }
    check(asked("lobes.html", question, tmp_path)["radiance"], normal, view_dir)


@pytest.mark.slow
@pytest.mark.parametrize(
    "language",
    ["wgsl", pytest.param("hlsl", marks=[pytest.mark.needs("naga"), pytest.mark.needs("glslangValidator")])],
)
def test_webgpu_shades_with_lobes_as_core_does(language: str, tmp_path: Path) -> None:
    """HLSL is compiled to SPIR-V, and that is told in WGSL."""
    export(tmp_path)
    entry = {"wgsl": WGSL, "hlsl": HLSL}[language]
    program = tmp_path / f"entry.{language}"
    program.write_text((tmp_path / f"sky.{language}").read_text() + entry)
    if language == "hlsl":
        compiled = "glslangValidator -D -e main -V -S comp --shift-sampler-binding 2 -o entry.spv entry.hlsl"
        for command in (compiled, "naga entry.spv entry.wgsl"):
            done = subprocess.run(command.split(), cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stdout + done.stderr
    normal, view_dir = points()
    given = [
        [[*material["color"], material["metalness"]], [*n, material["roughness"]], [*v, 0.0]]
        for material in MATERIALS
        for n, v in zip(normal.tolist(), view_dir.tolist(), strict=True)
    ]
    question = {"name": "/files/sky", "program": "/files/entry.wgsl", "points": given}
    shown = asked("lobes_webgpu.html", question, tmp_path, WEBGPU)["radiance"]
    check(np.reshape(shown, (len(MATERIALS), len(normal), 3)).tolist(), normal, view_dir)
