"""A page in headless Chromium that is asked something and answers, without a network."""

import json
import os
import subprocess
import tempfile
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

TESTS = Path(__file__).parent
PLACES = {
    "packages": Path(os.environ.get("RSIBR_WEB", Path.home() / ".cache" / "rsibr-web")) / "node_modules",
    "docs": TESTS.parents[1] / "docs" / "engines",
    "tests": TESTS,
}
"""First part of an address -> folder; `files` is the test's own."""

PATIENCE = 120
"""Seconds after which a page that does not answer has failed; they take 5."""

CHROMIUM = (
    *("chromium", "--headless", "--no-sandbox", "--disable-extensions", "--disable-background-networking"),
    *("--no-first-run", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"),
)


class _Handler(SimpleHTTPRequestHandler):
    """Serves files, the question, and takes the answer."""

    def guess_type(self, path: Any) -> str:
        return "text/javascript" if str(path).endswith(".mjs") else super().guess_type(path)

    def translate_path(self, path: str) -> str:
        first, _, rest = path.partition("?")[0].lstrip("/").partition("/")
        return str(self.server.places.get(first, Path("/nowhere")) / rest)  # type: ignore[attr-defined]

    def do_GET(self) -> None:
        if self.path != "/question":
            super().do_GET()
            return
        text = json.dumps(self.server.question).encode()  # type: ignore[attr-defined]
        self.send_response(200)
        self.end_headers()
        self.wfile.write(text)

    def do_POST(self) -> None:
        said = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(200)
        self.end_headers()
        self.server.said = json.loads(said)  # type: ignore[attr-defined]
        self.server.answered.set()  # type: ignore[attr-defined]

    def log_message(self, *_: Any) -> None:
        pass


def asked(page: str, question: dict[str, Any], files: Path) -> dict[str, Any]:
    """What a page of this folder answers to a question, which may name /files/NAME.

    Raises
    ------
    AssertionError
        It did not answer, or something went wrong there.
    """
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Handler)
    server.places, server.question = {**PLACES, "files": files}, question  # type: ignore[attr-defined]
    server.answered, server.said = threading.Event(), {}  # type: ignore[attr-defined]
    serving = threading.Thread(target=server.serve_forever)
    serving.start()
    address = f"http://127.0.0.1:{server.server_port}/tests/{page}"
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile,
        tempfile.TemporaryFile("w+", errors="replace") as log,  # a pipe that nobody reads would fill up
    ):
        command = [*CHROMIUM, f"--user-data-dir={profile}", "--remote-debugging-port=0", address]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=log)
        try:
            answered = server.answered.wait(PATIENCE)  # type: ignore[attr-defined]
        finally:
            process.terminate()
            process.wait()
            log.seek(0)
            told = log.read()
            server.shutdown()
            server.server_close()
            serving.join()
    assert answered, f"{page} did not answer: {told[-2000:]}"
    said: dict[str, Any] = server.said  # type: ignore[attr-defined]
    assert "error" not in said, said["error"]
    return said
