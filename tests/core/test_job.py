"""Jobs go to JSON and back, and refuse what they do not understand."""

import json

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError
from rsibr.rsibr_addon.job import BakeJob, CaptureJob

JOB = BakeJob(("capture", "--material", "copper", "-o", "out.rsibr.exr"))


def test_a_job_survives_json() -> None:
    assert BakeJob.from_json(JOB.to_json(), "job") == JOB
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
        ('{"format": 2, "arguments": ["capture"]}', "job.json is a job of format 2, not 1: update"),
        ('{"format": 1, "arguments": "capture"}', "arguments is not a list"),
        ('{"format": 1, "arguments": ["capture", 3]}', r"arguments\[1\] is not text"),
        ('{"format": 1, "arguments": []}', "job.json cannot be done. A job begins with what is to be made"),
        ('{"format": 1, "arguments": ["info", "a"]}', "one of capture, bake, tables, mips, bank, illuminate"),
    ],
)
def test_what_is_no_job_is_refused(text: str, words: str) -> None:
    with pytest.raises(InputFileError, match=words):
        BakeJob.from_json(text, "job.json")


@pytest.mark.parametrize("views", [0, 11, 43])
def test_views_are_those_of_a_geodesic_sphere(views: int) -> None:
    with pytest.raises(RangeError, match=f"A capture cannot have {views} views: choose one of 12, 42, 162"):
        CaptureJob("forest", "copper", "out.rsibr.exr", views)
