"""Send to Farm in Blender's window: a manager of a few lines, whose worker is the same Blender."""

from collections.abc import Callable

from rsibr.tests.gui.panel import PRELUDE

MANAGER = """
import fcntl, http.server, json, socket, struct, subprocess, threading

def wake_loopback():
    # The tests' Blender has a network of its own, whose loopback sleeps
    UP, SIOCSIFFLAGS = 0x1 | 0x40, 0x8914
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as plug:
        fcntl.ioctl(plug, SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", UP))

class Manager(http.server.BaseHTTPRequestHandler):
    jobs, held = [], True

    def do_GET(self):
        path = self.path.removeprefix("/api/v3/")
        if path == "jobs/type/rsibr-bake":
            keys = ("folder", "batch", "parts", "program")
            self.answer({"etag": "1", "settings": [{"key": key} for key in keys]})
        elif path.startswith("configuration/shared-storage/users/"):
            self.answer({"location": "/job/shared"})
        elif path.endswith("/logtail"):
            self.answer("no such program")
        elif path.endswith("/tasks"):
            tasks = self.job(path)["tasks"].items()
            self.answer({"tasks": [{"id": name, "name": name, "status": status} for name, status in tasks]})
        elif path.startswith("jobs/"):
            self.answer({"id": path.split("/")[1], "status": self.job(path)["status"]})

    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if self.path.endswith("setstatus"):
            self.job(self.path.removeprefix("/api/v3/"))["status"] = "canceled"
            return self.answer({})
        tasks = {name: "active" for name in body["settings"]["parts"].split()} | {"page": "queued"}
        Manager.jobs.append({"settings": body["settings"], "status": "active", "tasks": tasks})
        threading.Thread(target=work, args=(Manager.jobs[-1],), daemon=True).start()
        self.answer({"id": str(len(Manager.jobs) - 1), "status": "queued"})

    def job(self, path):
        return Manager.jobs[int(path.split("/")[1])]

    def answer(self, plain):
        self.send_response(200)
        self.end_headers()
        self.wfile.write((plain if isinstance(plain, str) else json.dumps(plain)).encode())

    def log_message(self, *told):
        pass

def work(job):
    # What the job type has a worker do
    folder, tasks = job["settings"]["folder"], job["tasks"]
    batch = [f"{folder}/inputs/{job['settings']['batch']}.json", "--output", f"{folder}/maps"]
    for name in list(tasks):
        while Manager.held:
            time.sleep(0.05)
        which = ["--page"] if name == "page" else ["--part", name]
        program = [bpy.app.binary_path, "--background", "--disable-autoexec", "--command", "rsibr"]
        done = subprocess.run([*program, "batch", *batch, *which], capture_output=True)
        tasks[name] = "failed" if done.returncode else "completed"
    job["status"] = "failed" if "failed" in tasks.values() else "completed"

def started():
    wake_loopback()
    os.makedirs("/job/shared", exist_ok=True)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Manager)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server
"""

SEND = """
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

"""

WAY = """
def scenario(told):
    server = started()
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
    yield from done(lambda: Manager.jobs[-1]["status"] == "canceled")

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
    assert told(PRELUDE + MANAGER + SEND + WAY) == {
        "without a farm": False,
        "offline": False,
        "state": ["done", ""],
        "shaded": True,
        "again": ["FINISHED"],
        "waits": False,
        "away": True,
    }


TEXTURES = """
def scenario(told):
    server, cube, inputs = started(), bpy.data.objects["Cube"], session().previews.inputs
    bare(view())
    bpy.context.preferences.system.use_online_access = True
    preferences = bpy.context.preferences.addons[ROOT].preferences
    preferences.farm_manager, preferences.bake_inputs = f"127.0.0.1:{server.server_port}", False
    preferences.inputs.size = 32
    tree = cube.active_material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise").outputs["Color"]
    tree.links.new(noise, tree.nodes["Principled BSDF"].inputs["Base Color"])
    chosen = settings()
    chosen.kind = "kernel_pyramid"
    Manager.held = False
    sidebar()
    yield from drawn()
    sidebar()[1].active_panel_category = "RSIBR"
    send()
    told["sent"] = len(session().bakes.bakes)
    yield from done()
    told["bakes"] = [[str(each.state), each.message] for each in session().bakes.bakes]
    while cube.session_uid not in inputs._shown:
        yield from drawn()
    told["lacks"] = inputs.lacks(cube)
    yield from picture("farm-textures")
    told["again"] = send()
    told["waits"] = session().bakes.busy
"""


def test_textures_of_materials_that_are_sent_come_back_and_show(told: Callable[[str], dict]) -> None:
    assert told(PRELUDE + MANAGER + SEND + TEXTURES) == {
        "sent": 2,
        "bakes": [["done", ""], ["done", ""]],
        "lacks": False,
        "again": ["FINISHED"],
        "waits": False,
    }
