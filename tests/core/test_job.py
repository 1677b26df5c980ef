"""Jobs go to JSON and back, and refuse what they do not understand."""

import dataclasses
import json

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError
from rsibr.rsibr_addon.job import CaptureJob

JOB = CaptureJob("forest", "copper", "out.rsibr.exr", 42, 128, 16, True, 7, True)


def test_a_job_survives_json() -> None:
    assert CaptureJob.from_json(JOB.to_json(), "job") == JOB
    assert json.loads(JOB.to_json()) == dataclasses.asdict(JOB)


def test_defaults_may_be_left_out() -> None:
    text = '{"environment": null, "material": ":Paint", "output": "out.exr"}'
    assert CaptureJob.from_json(text, "job") == CaptureJob(None, ":Paint", "out.exr")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"sizes": 3}, "job.json has an unknown field sizes: choose from environment, material"),
        ({"size": "big"}, 'job.json has "big" for size: give a value of int'),
        ({"size": 3.0}, "has 3.0 for size"),
        ({"size": True}, "has true for size"),
        ({"denoise": 1}, "has 1 for denoise: give a value of bool"),
        ({"environment": 3}, r"has 3 for environment: give a value of str \| None"),
        ({"material": None}, "has null for material"),
    ],
)
def test_wrong_fields_are_named(change: dict[str, object], words: str) -> None:
    text = json.dumps(dataclasses.asdict(JOB) | change)
    with pytest.raises(InputFileError, match=words):
        CaptureJob.from_json(text, "job.json")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "job.json is not JSON"),
        ("[" * 100_000, "job.json is not JSON"),
        ("[1]", "job.json is no JSON object"),
        ('{"material": "copper"}', "job.json lacks the field environment: add it"),
    ],
)
def test_wrong_texts_are_refused(text: str, words: str) -> None:
    with pytest.raises(InputFileError, match=words):
        CaptureJob.from_json(text, "job.json")


def test_only_geodesic_numbers_of_views_are_taken() -> None:
    with pytest.raises(RangeError, match="A capture cannot have 13 views: choose one of 12, 42, 162"):
        dataclasses.replace(JOB, views=13)
