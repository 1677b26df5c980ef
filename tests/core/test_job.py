"""Jobs go to JSON and back, and refuse what they do not understand."""

import json

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError
from rsibr.rsibr_addon.job import BakeJob, CommandJob, read_job
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings

JOB = CommandJob(("capture", "--material", "copper", "-o", "out.rsibr.exr"))


def test_a_job_survives_json() -> None:
    bake = BakeJob(MipChainSettings(size=2, roughness=(0.0, 1.0)), "a.rsibr.exr", Light(clamp=5.0), True)
    assert read_job(bake.to_json(), "job") == bake
    assert read_job(JOB.to_json(), "job") == JOB
    assert json.loads(JOB.to_json()) == {"format": 1, "arguments": list(JOB.arguments)}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", r"job.json is no job \(it is not JSON: "),
        (
            "[]",
            r"job.json is no job \(it is not an object\): give an object with the fields",
        ),
        ('{"format": 1}', "job.json is no job"),
        ('{"format": 1, "arguments": [], "more": 0}', "job.json is no job"),
        ('{"format": 3}', "job.json is a job of format 3, not 2: update"),
        ('{"format": 2, "arguments": ["capture"]}', "kind is missing"),
        (
            '{"format": 2, "kind": "views", "settings": {}, "output": "a"}',
            "kind is not one of kernel_pyramid",
        ),
        (
            '{"format": 2, "kind": "mip_chain", "settings": {"size": 3}, "output": "a"}',
            "settings is impossible: A mip chain cannot be 3 texels wide",
        ),
        (
            '{"format": 2, "kind": "mip_chain", "settings": {}, "light": {"clamp": 0}, "output": "a"}',
            "light is impossible: Clamp cannot be 0: choose 1e-30 to 1e",
        ),
        ('{"format": 1, "arguments": "capture"}', "arguments is not a list"),
        ('{"format": 1, "arguments": ["capture", 3]}', r"arguments\[1\] is not text"),
        ('{"format": 1, "arguments": []}', "job.json cannot be done. A job begins with what is to be made"),
        ('{"format": 1, "arguments": ["info", "a"]}', "one of capture, bake, tables, mips, bank, illuminate"),
    ],
)
def test_what_is_no_job_is_refused(text: str, words: str) -> None:
    with pytest.raises(InputFileError, match=words):
        read_job(text, "job.json")


@pytest.mark.parametrize("views", [0, 11, 43])
def test_views_are_those_of_a_geodesic_sphere(views: int) -> None:
    with pytest.raises(RangeError, match=f"Views cannot be {views}: choose one of 12, 42, 162"):
        RadianceViewsSettings(material="copper", views=views)
