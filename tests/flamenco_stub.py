"""A stub of Flamenco's manager as strict as its OpenAPI document, whose worker does a task at each look."""

import json
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from rsibr.rsibr_addon.core.errors import RsibrError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.batch.bakes import parts_of
from rsibr.rsibr_addon.tasks.batch.description import read_batch
from rsibr.rsibr_addon.tasks.batch.notes import Failure, batch_folder, write_note
from rsibr.rsibr_addon.tasks.farm.flamenco import SCRIPT
from rsibr.rsibr_addon.tasks.methods.bake import bake

ETAG = "9ceca15e1080b307064b909182da3b403cd2b575"

SUBMITTED = {
    "name": str, "type": str, "type_etag": str, "priority": int, "submitter_platform": str, "settings": dict,
    "metadata": dict,
}  # fmt: skip
"""Fields of SubmittedJob that a client of ours may give, all of which it should."""


@dataclass
class Stub:
    """A manager.

    Attributes
    ----------
    shared : Path
        Shared storage.
    has_job_type : bool
        Whether our job type is in its folder `scripts`.
    broken : str
        What a worker says of every task, where it can start none.
    jobs : list of dict
        Those that were submitted.
    status : str
        Of the last one.
    refused : list of str
        What was wrong with requests.
    """

    shared: Path
    has_job_type: bool = True
    broken: str = ""
    jobs: list[dict[str, Any]] = field(default_factory=list)
    status: str = "queued"
    refused: list[str] = field(default_factory=list)
    url: str = ""
    _tasks: dict[str, str] = field(default_factory=dict)

    def answer(self, method: str, path: str, body: Any) -> tuple[int, Any]:
        """Code and JSON of an answer."""
        if method == "GET" and path == "jobs/type/rsibr-bake" and self.has_job_type:
            return 200, {
                "name": "rsibr-bake",
                "label": "RSIBR Bake",
                "etag": ETAG,
                "settings": job_type_settings(),
            }
        if method == "GET" and re.fullmatch(
            "configuration/shared-storage/users/(linux|windows|darwin)", path
        ):
            location = {"location": str(self.shared), "shamanEnabled": False}
            return 200, location | {"audience": "users", "platform": path.rpartition("/")[2]}
        if method == "POST" and path == "jobs":
            return self._submitted(body)
        if method == "GET" and path == "jobs/1":
            return 200, {"id": "1", "status": self.status, "activity": "", "steps_total": 0}
        if method == "GET" and path == "jobs/1/tasks":
            self._work()
            return 200, {
                "tasks": [{"id": name, "name": name, "status": state} for name, state in self._tasks.items()]
            }
        if method == "GET" and (task := re.fullmatch(r"tasks/([\w.-]+)/logtail", path)):
            return (200, f"starting\n{self.broken}\n") if task[1] in self._tasks else missing(path)
        if method == "POST" and path == "jobs/1/setstatus" and body.keys() == {"status", "reason"}:
            self.status = {"cancel-requested": "canceled"}[body["status"]]
            return 204, None
        return missing(path)

    def _submitted(self, body: Any) -> tuple[int, Any]:
        wrong = [name for name, kind in SUBMITTED.items() if not isinstance(body.get(name), kind)]
        wrong += [name for name in body if name not in SUBMITTED]
        wanted = {each["key"] for each in job_type_settings()}
        wrong += [f"settings.{name}" for name in wanted ^ body["settings"].keys()]
        wrong += [name for name, value in body["settings"].items() if not isinstance(value, str) or not value]
        wrong += [name for name, value in body["metadata"].items() if not isinstance(value, str)]
        if wrong:
            self.refused.append(str(wrong))
            return 400, {"code": 400, "message": f"invalid format: {wrong}"}
        if body["type_etag"] != ETAG:
            return 412, {"code": 412, "message": "rejecting job because its settings are outdated"}
        self.jobs.append(body)
        self._tasks = dict.fromkeys([*body["settings"]["parts"].split(" "), "page"], "queued")
        self.status = "active"
        return 200, {"id": "1", "status": "queued", **body}

    def _work(self) -> None:
        """Do the next task, as a worker would; the page is not what is tested with a stub."""
        task = next((name for name, state in self._tasks.items() if state == "queued"), None)
        if task is None or (self.broken and task == "page"):
            return
        if self.broken:
            self._tasks[task] = "failed"
            return
        settings = self.jobs[-1]["settings"]
        folder = Path(settings["folder"])
        path, maps = folder / "inputs" / f"{settings['batch']}.json", folder / "maps"
        bakes, notes = read_batch(path, maps), batch_folder(path, maps)
        notes.mkdir(exist_ok=True)
        for each in parts_of(bakes).get(task, []):
            Path(each.job.output).parent.mkdir(exist_ok=True, parents=True)
            try:
                drain(bake(each.job))
            except RsibrError as error:
                write_note(notes, each, Failure(error=str(error), try_again=False))
        self._tasks[task] = "completed"
        if task == "page":
            (notes / "index.html").write_text("the page")
            self.status = "completed"


def job_type_settings() -> list[dict[str, Any]]:
    """The settings that the script of our job type declares."""
    return [
        {"key": key, "type": "string"}
        for key in re.findall(r'\{ key: "(\w+)", type: "string"', SCRIPT.read_text())
    ]


def missing(path: str) -> tuple[int, Any]:
    """The answer where something is unknown."""
    return 404, {"code": 404, "message": f"no {path}"}


@contextmanager
def manager(shared: Path) -> Iterator[Stub]:
    """A manager that answers on this machine alone."""
    stub = Stub(shared)

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self._answer(None)

        def do_POST(self) -> None:
            assert self.headers["Content-Type"] == "application/json"
            self._answer(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))

        def _answer(self, body: Any) -> None:
            assert self.path.startswith("/api/v3/")
            code, plain = stub.answer(self.command, self.path.removeprefix("/api/v3/"), body)
            data = b"" if plain is None else (plain if isinstance(plain, str) else json.dumps(plain)).encode()
            self.send_response(code)
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        def log_message(self, *told: Any) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        stub.url = f"http://127.0.0.1:{server.server_port}"
        try:
            yield stub
        finally:
            server.shutdown()
            thread.join()
