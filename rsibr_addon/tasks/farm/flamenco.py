"""A manager of Flamenco 3, over its HTTP interface."""

import json
import re
import sys
from dataclasses import dataclass, field
from http.client import HTTPException
from pathlib import Path
from typing import Any, TypedDict, TypeVar
from urllib.error import HTTPError, URLError
from urllib.parse import quote
from urllib.request import OpenerDirector, ProxyHandler, Request, build_opener

from ...core.errors import FarmError, NotNowError, SchemaError
from ...core.schema import decode, loads

JOB_TYPE = "rsibr-bake"
"""Flamenco's name for `SCRIPT`."""

SCRIPT = Path(__file__).with_name("rsibr_bake.js")
"""What makes tasks of a job; the manager has a copy."""

SETTINGS = {"folder", "batch", "parts", "program"}
"""All settings of a job of this type: over HTTP, Flamenco sets no defaults."""

SECONDS = 20.0
"""Longest time that the manager may take to answer."""

BUSY = (502, 503, 504)
"""HTTP's codes of what may answer later."""

PLATFORMS = {"win32": "windows", "darwin": "darwin"}
"""Python's name of a system -> Flamenco's; others are as Linux."""


class _JobType(TypedDict):
    etag: str
    settings: list["_Setting"]


class _Setting(TypedDict):
    key: str


class _SharedStorage(TypedDict):
    location: str


class _Job(TypedDict):
    id: str
    status: str


class FarmTask(TypedDict):
    """A task of a job: its number, its name, and its status in Flamenco's words."""

    id: str
    name: str
    status: str


class _Tasks(TypedDict):
    tasks: list[FarmTask]


class _Refusal(TypedDict):
    message: str


Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Manager:
    """A manager of Flamenco 3.

    All methods raise FarmError where it refuses, and NotNowError where it does not answer now.

    Attributes
    ----------
    url : str
        Its address, as http://farm:8080; without a scheme, http is meant.

    Raises
    ------
    FarmError
        The address is none.
    """

    url: str
    _opener: OpenerDirector = field(
        # In a local network alone, as it asks nobody for a name: no proxy knows it
        default_factory=lambda: build_opener(ProxyHandler({})),
        repr=False,
        compare=False,
    )

    def __post_init__(self) -> None:
        url = self.url.strip().rstrip("/")
        url = url if "://" in url else f"http://{url}"
        if not re.fullmatch(r"https?://([^][/?#:\s]+|\[[\da-fA-F:]+\])(:\d+)?", url):
            raise FarmError(f"{self.url} is no address of a Flamenco manager: give one as http://farm:8080.")
        object.__setattr__(self, "url", url)

    def etag(self) -> str:
        """What tells which version of our job type the manager has."""
        remedy = f"copy {SCRIPT} into the folder scripts beside flamenco-manager, and start it anew"
        try:
            known = self._get(_JobType, f"jobs/type/{JOB_TYPE}")
        except _NotFoundError:
            raise FarmError(
                f"The manager {self.url} does not know the job type {JOB_TYPE}: {remedy}."
            ) from None
        if {each["key"] for each in known["settings"]} != SETTINGS:
            raise FarmError(
                f"The manager {self.url} has the job type {JOB_TYPE} of another version: {remedy}."
            )
        return known["etag"]

    def shared_storage(self) -> Path:
        """The folder that the manager shares with its workers, as this machine should see it."""
        told = self._get(_SharedStorage, f"configuration/shared-storage/users/{platform()}")
        return Path(told["location"])

    def submit(self, title: str, settings: dict[str, str], etag: str) -> str:
        """Start a job.

        Parameters
        ----------
        title : str
        settings : dict
            All of `SETTINGS`.
        etag : str
            See `etag`.

        Returns
        -------
        str
            The job's number.
        """
        job = {
            "name": title,
            "type": JOB_TYPE,
            "type_etag": etag,
            "priority": 50,
            "submitter_platform": platform(),
            "settings": settings,
            "metadata": {"project": title},
        }
        return self._post(_Job, "jobs", job)["id"]

    def status(self, job: str) -> str:
        """The status of a job, in Flamenco's words."""
        return self._get(_Job, f"jobs/{quote(job)}")["status"]

    def tasks(self, job: str) -> list[FarmTask]:
        """All tasks of a job."""
        return self._get(_Tasks, f"jobs/{quote(job)}/tasks")["tasks"]

    def log(self, task: str) -> str:
        """The end of a task's log."""
        return self._ask("GET", f"tasks/{quote(task)}/logtail").decode(errors="replace")

    def cancel(self, job: str) -> None:
        """Ask for the end of a job."""
        wanted = {"status": "cancel-requested", "reason": "It was cancelled where it was sent from"}
        self._ask("POST", f"jobs/{quote(job)}/setstatus", wanted)

    def page(self, job: str) -> str:
        """The address of a job's page."""
        return f"{self.url}/app/jobs/{quote(job)}"

    def _get(self, schema: type[Answer], path: str) -> Answer:
        return self._decoded(schema, self._ask("GET", path))

    def _post(self, schema: type[Answer], path: str, body: Any) -> Answer:
        return self._decoded(schema, self._ask("POST", path, body))

    def _decoded(self, schema: type[Answer], answer: bytes) -> Answer:
        try:
            return decode(schema, loads(answer))
        except SchemaError as error:
            raise FarmError(
                f"{self.url} answers as no manager of Flamenco 3 does ({error}): check it."
            ) from error

    def _ask(self, method: str, path: str, body: Any = None) -> bytes:
        request = Request(
            f"{self.url}/api/v3/{path}",
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json", "Accept": "application/json"},
            method=method,
        )
        try:
            with self._opener.open(request, timeout=SECONDS) as answer:
                read: bytes = answer.read()
                return read
        except HTTPError as error:
            raise self._refusal(error) from error
        except (URLError, HTTPException, OSError) as error:
            reason = getattr(error, "reason", error)
            raise NotNowError(
                f"The manager {self.url} does not answer ({reason}): check its address, and that it runs."
            ) from error

    def _refusal(self, error: HTTPError) -> Exception:
        try:
            told = decode(_Refusal, loads(error.read()))["message"]
        except (SchemaError, OSError, HTTPException):
            told = error.reason
        if error.code == 404:
            return _NotFoundError(f"The manager {self.url} does not know what was asked for: {told}.")
        if error.code in BUSY:
            return NotNowError(f"The manager {self.url} is busy ({told}): try again.")
        return FarmError(f"The manager {self.url} refuses ({told}): see its log.")


class _NotFoundError(FarmError):
    """The manager does not know what was asked for."""


def platform() -> str:
    """Flamenco's name of this machine's system."""
    return PLATFORMS.get(sys.platform, "linux")
