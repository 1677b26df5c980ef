"""Send to Farm in Blender's window: a manager of a few lines, whose worker is the same Blender."""

from collections.abc import Callable

from rsibr.tests.gui.test_panel import PRELUDE

MANAGER = """
import fcntl, http.server, json, socket, struct, subprocess, threading

def wake_loopback():
    # The tests' Blender has a network of its own, whose loopback sleeps
    UP, SIOCSIFFLAGS = 0x1 | 0x40, 0x8914
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as plug:
        fcntl.ioctl(plug, SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", UP))

class Manager(http.server.BaseHTTPRequestHandler):
    settings, tasks, held = None, {}, True

    def do_GET(self):
        path = self.path.removeprefix("/api/v3/")
        if path == "jobs/type/rsibr-bake":
            keys = ("folder", "batch", "parts", "program")
            self.answer({"etag": "1", "settings": [{"key": key} for key in keys]})
        elif path.startswith("configuration/shared-storage/users/"):
            self.answer({"location": "/job/shared"})
        elif path == "jobs/1":
            self.answer({"id": "1", "status": Manager.status})
        elif path == "jobs/1/tasks":
            self.answer({"tasks": [{"id": n, "name": n, "status": s} for n, s in Manager.tasks.items()]})
        elif path.endswith("/logtail"):
            self.answer("no such program")

    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if self.path.endswith("setstatus"):
            Manager.status = "canceled"
            return self.answer({})
        Manager.settings, Manager.status = body["settings"], "active"
        Manager.tasks = {name: "active" for name in body["settings"]["parts"].split()} | {"page": "queued"}
        threading.Thread(target=work, daemon=True).start()
        self.answer({"id": "1", "status": "queued"})

    def answer(self, plain):
        self.send_response(200)
        self.end_headers()
        self.wfile.write((plain if isinstance(plain, str) else json.dumps(plain)).encode())

    def log_message(self, *told):
        pass

def work():
    # What the job type has a worker do
    folder = Manager.settings["folder"]
    batch = [f"{folder}/inputs/{Manager.settings['batch']}.json", "--output", f"{folder}/maps"]
    for name in list(Manager.tasks):
        while Manager.held:
            time.sleep(0.05)
        which = ["--page"] if name == "page" else ["--part", name]
        program = [bpy.app.binary_path, "--background", "--disable-autoexec", "--command", "rsibr"]
        done = subprocess.run([*program, "batch", *batch, *which], capture_output=True)
        Manager.tasks[name] = "failed" if done.returncode else "completed"
    failed = "failed" in Manager.tasks.values()
    Manager.status = "failed" if failed else "completed"
"""

WAY = """
def send():
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        return list(bpy.ops.rsibr.send_to_farm("INVOKE_DEFAULT"))

def said(words):
    bakes = session().bakes.bakes
    return lambda: bakes[-1].progress is not None and words in bakes[-1].progress.what

def picture(name):
    area, region = sidebar()
    region.tag_redraw()
    for _ in range(3):
        yield from drawn()
    xshot.save(xshot.grab(), f"/job/{name}.png")

def scenario(told):
    wake_loopback()
    os.makedirs("/job/shared", exist_ok=True)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Manager)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    preferences = bpy.context.preferences
    farm = preferences.addons[ROOT].preferences
    chosen, cube = settings(), bpy.context.object
    chosen.light = "WORLD"
    sidebar()
    yield from drawn()
    sidebar()[1].active_panel_category = "RSIBR"
    told["without a farm"] = bpy.ops.rsibr.send_to_farm.poll()
    farm.farm_manager = f"127.0.0.1:{server.server_port}"
    preferences.system.use_online_access = False
    told["offline"] = bpy.ops.rsibr.send_to_farm.poll()
    preferences.system.use_online_access = True

    # Cancelled here, it is cancelled there
    send()
    yield from done(said("baking world-radiance-views"))
    yield from picture("farm-baking")
    bpy.ops.rsibr.cancel_bake(number=len(session().bakes.bakes) - 1)
    yield from done(lambda: Manager.status == "canceled")

    # Sent again, it comes and shades the object; a bake here goes on beside it
    Manager.held = False
    send()
    yield from done()
    told["state"] = [str(session().bakes.bakes[-1].state), session().bakes.bakes[-1].message]
    told["shaded"] = os.path.isfile(bpy.path.abspath(cube.rsibr.map_set))
    yield from picture("farm-done")
    told["again"] = send()
    told["waits"] = session().bakes.busy

    # No manager: the list says so
    server.shutdown()
    server.server_close()
    chosen.radiance_views.samples = 3
    send()
    yield from done()
    told["away"] = "does not answer" in session().bakes.bakes[-1].message
    yield from picture("farm-away")
"""


def test_a_bake_that_is_sent_comes_back_and_shades(told: Callable[[str], dict]) -> None:
    assert told(PRELUDE + MANAGER + WAY) == {
        "without a farm": False,
        "offline": False,
        "state": ["done", ""],
        "shaded": True,
        "again": ["FINISHED"],
        "waits": False,
        "away": True,
    }
