"""A page in headless Chromium that is asked something and answers, without a network."""

import json
import os
import shlex
import subprocess
import tempfile
import threading
from collections.abc import Callable, Sequence
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import IO, Any

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
    *("--no-first-run", "--disable-dev-shm-usage"),
)

SWIFTSHADER = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Has Chromium draw with a driver of its own, which is there everywhere."""

WEBGPU = ("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader")
"""Has it have WebGPU by that driver."""

LIKE_BLENDER = ("--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist")
"""Has it draw with the driver that Blender draws with."""


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
        said = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if self.path == "/browser":
            self.server.browser.send(*said)  # type: ignore[attr-defined]
        else:
            self.server.said = said  # type: ignore[attr-defined]
            self.server.answered.set()  # type: ignore[attr-defined]
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_: Any) -> None:
        pass


def asked(
    page: str, question: dict[str, Any], files: Path, driver: Sequence[str] = SWIFTSHADER
) -> dict[str, Any]:
    """What a page of this folder answers to a question, which may name /files/NAME.

    Raises
    ------
    AssertionError
        It did not answer, or something went wrong there.
    """
    return _answer(lambda host: f"{host}/tests/{page}", {**PLACES, "files": files}, question, driver)


def driven(page: Path, script: str, before: str = "", driver: Sequence[str] = LIKE_BLENDER) -> dict[str, Any]:
    """What a page that is opened from disk answers to a script.

    Parameters
    ----------
    page : Path
        One of `tasks.export.page`.
    script : str
        Runs after the page's own, and gives its answer to `answer`. Its `browser(METHOD, PARAMETERS)` has
        Chromium's DevTools protocol do what a script cannot: real touches, keys and sizes of screens.
    before : str
        Runs before the page's own.
    driver : sequence of str
        `LIKE_BLENDER` or `SWIFTSHADER`.

    Raises
    ------
    AssertionError
        It did not answer, or told of trouble that `window.expectsTrouble`, set by `before`, did not foresee.
    """

    def address(host: str) -> str:
        text = page.read_text(encoding="utf-8").replace("<head>", f"<head><script>{before}</script>")
        copy = page.with_name(f"driven-{page.name}")
        copy.write_text(text + DRIVER.replace("HOST", host).replace("SCRIPT", script), encoding="utf-8")
        return copy.resolve().as_uri()

    return _answer(address, {}, {}, driver)


DRIVER = """<script type="module">
const post = (address, said) => fetch(address, {method: "POST", mode: "no-cors", body: JSON.stringify(said)});
const browser = (...command) => post("HOST/browser", command);
const answer = (said) => post("HOST", said);
const failed = (error) => answer({error: String(error)});
const trouble = document.querySelector("#trouble");
const look = () => trouble.hidden || window.expectsTrouble || failed(trouble.textContent);
new MutationObserver(look).observe(trouble, {attributes: true});
look();
(async () => {
SCRIPT
})().catch(failed);
</script>"""
"""A script that asks a page: HOST takes its answers."""


class _Browser:
    """Chromium, with its DevTools protocol on the pipes 3 and 4: JSON that ends with a zero byte."""

    def __init__(self, command: list[str], log: IO[str]) -> None:
        (commands, self._commands), (self._answers, answers) = os.pipe(), os.pipe()
        pipes = f"exec 3<&{commands} 4>&{answers}; exec {shlex.join(command)} --remote-debugging-pipe"
        self._process = subprocess.Popen(
            ["bash", "-c", pipes], stdout=subprocess.DEVNULL, stderr=log, pass_fds=(commands, answers)
        )
        os.close(commands)
        os.close(answers)
        self._number, self._read, self._session, self._turn = 0, b"", "", threading.Lock()

    def send(self, method: str, parameters: dict[str, Any]) -> None:
        """Have the page's tab do something, and wait until it is done."""
        with self._turn:
            if not self._session:
                targets = self._done("Target.getTargets", {})["targetInfos"]
                page = next(each["targetId"] for each in targets if each["type"] == "page")
                attached = self._done("Target.attachToTarget", {"targetId": page, "flatten": True})
                self._session = attached["sessionId"]
            self._done(method, parameters)

    def end(self) -> None:
        """End it."""
        self._process.terminate()
        self._process.wait()
        os.close(self._commands)
        os.close(self._answers)

    def _done(self, method: str, parameters: dict[str, Any]) -> dict[str, Any]:
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self._read:
                read = os.read(self._answers, 2**16)
                assert read, "Chromium has ended"
                self._read += read
            first, _, self._read = self._read.partition(b"\0")
            said = json.loads(first)
            if said.get("id") == self._number:
                assert "error" not in said, said["error"]
                result: dict[str, Any] = said["result"]
                return result


def _answer(
    address_of: Callable[[str], str],
    places: dict[str, Path],
    question: dict[str, Any],
    driver: Sequence[str],
) -> dict[str, Any]:
    """What the page of an address answers; the address is made of that of the server, which is asked."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Handler)
    server.places, server.question = places, question  # type: ignore[attr-defined]
    server.answered, server.said = threading.Event(), {}  # type: ignore[attr-defined]
    address = address_of(f"http://127.0.0.1:{server.server_port}")
    serving = threading.Thread(target=server.serve_forever)
    serving.start()
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile,
        tempfile.TemporaryFile("w+", errors="replace") as log,  # a pipe that nobody reads would fill up
    ):
        browser = _Browser([*CHROMIUM, *driver, f"--user-data-dir={profile}", address], log)
        server.browser = browser  # type: ignore[attr-defined]
        try:
            answered = server.answered.wait(PATIENCE)  # type: ignore[attr-defined]
        finally:
            browser.end()
            log.seek(0)
            told = log.read()
            server.shutdown()
            server.server_close()
            serving.join()
    assert answered, f"{address} did not answer: {told[-2000:]}"
    said: dict[str, Any] = server.said  # type: ignore[attr-defined]
    assert "error" not in said, said["error"]
    return said
