// The page: what was packed, the picture, the panel, and fingers and mice on the canvas.

const SAMPLES = 4; // Along each side of a pixel at rest; one while something moves
const SHARPEST = 2; // Pixels of the picture to a pixel of CSS

const KEYS = {
  ArrowLeft: (camera) => camera.orbit(-1 / 36, 0),
  ArrowRight: (camera) => camera.orbit(1 / 36, 0),
  ArrowUp: (camera) => camera.orbit(0, 1 / 36),
  ArrowDown: (camera) => camera.orbit(0, -1 / 36),
  "+": (camera) => camera.magnify(1.1),
  "-": (camera) => camera.magnify(1 / 1.1),
};

const canvas = document.querySelector("canvas");

function say(sentence) {
  const place = document.querySelector("#trouble");
  place.textContent = sentence;
  place.hidden = false;
  document.querySelector("#waiting").hidden = true;
}

class Page {
  constructor(content, picture) {
    this.content = content;
    this.picture = picture;
    this.camera = new Camera(content.view, content.angle, content.fill);
    this.exposure = content.exposure;
    this.backgroundExposure = content.matte?.exposure ?? 0;
    this.display = content.display;
    this.blocks = content.materials.map((material) => new Float32Array(material.block));
    this.turn = 0;
    this.beside = false; // Whether the split sum is
    this.waiting = [];
    this.samples = 1;
    this.asked = false;
  }

  async start() {
    await this.picture.load();
    await this.picture.show(this.content.displays[this.display]);
    document.querySelector("#waiting").hidden = true;
    document.querySelector("#hint").hidden = false;
    document.querySelector("#reset").hidden = false;
    this.fillPanel();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    window.addEventListener("resize", () => this.resize()); // also of pixels of another size
    this.resize();
  }

  // Drivers take a context away, as from a page that was long in the background, and give another.
  async restore() {
    const picture = new Picture(canvas, this.content);
    await picture.load();
    await picture.show(this.content.displays[this.display]);
    this.picture = picture;
    document.querySelector("#trouble").hidden = true;
    this.resize();
  }

  fillPanel() {
    const panel = new Panel(document.querySelector("#settings"));
    const [block] = this.blocks; // sliders are of pages with one material
    const moved = () => this.moved();
    const more = document.querySelector("#more");
    for (const told of this.content.parameters) {
      panel.parameter(told, block, moved, told.advanced ? more : undefined);
    }
    more.parentElement.hidden = more.childElementCount === 0;
    const turn = { name: "turn", label: "Light", help: "Turn the light about the object", unit: "degrees" };
    panel.slider(turn, 0, 360, 0, (degrees) => {
      this.turn = (degrees * Math.PI) / 180;
      moved();
    });
    if (Object.keys(this.content.split).length) {
      const beside = { name: "beside", label: "Split Sum Beside", help: "Show what engines make of the same material and light" };
      panel.check(beside, false, (checked) => {
        this.beside = checked;
        document.querySelector("#sides").hidden = !checked;
        moved();
      });
    }
    if (this.content.matte?.light || this.content.matte?.picture) {
      const behind = { name: "background_exposure", label: "Background", help: "How much brighter the background is, in stops" };
      const most = Math.max(6, Math.abs(this.backgroundExposure));
      panel.slider(behind, -most, most, this.backgroundExposure, (stops) => {
        this.backgroundExposure = stops;
        moved();
      });
    }
    const exposure = { name: "exposure", label: "Exposure", help: "In stops, which double the light" };
    const reach = Math.max(6, Math.abs(this.exposure));
    panel.slider(exposure, -reach, reach, this.exposure, (stops) => {
      this.exposure = stops;
      this.ask();
    });
    const names = Object.keys(this.content.displays);
    const display = { name: "display", label: "View", help: "How radiance is shown" };
    panel.menu(display, names, names.indexOf(this.display), async (number) => {
      this.display = names[number];
      await this.picture.show(this.content.displays[this.display]);
      this.ask();
    });
    const reset = () => {
      this.camera.reset();
      panel.resets.forEach((each) => each());
      this.blocks.forEach((each, number) => each.set(this.content.materials[number].block));
      moved();
    };
    document.querySelector("#reset").addEventListener("click", reset);
  }

  resize() {
    const sharpness = Math.min(window.devicePixelRatio, SHARPEST);
    const sizes = [canvas.clientWidth, canvas.clientHeight];
    this.picture.fit(...sizes.map((size) => Math.max(Math.round(size * sharpness), 1)));
    this.moved();
  }

  // Anything but exposure and view transform is another: draw all of it.
  moved() {
    this.samples = 1;
    this.waiting = this.picture.tiles(1, this.beside);
    this.ask();
  }

  ask() {
    if (!this.asked) {
      this.asked = true;
      requestAnimationFrame(() => this.frame());
    }
  }

  frame() {
    this.asked = false;
    const finest = this.samples === SAMPLES;
    const tiles = this.waiting.splice(0, finest ? 1 : this.waiting.length);
    for (const tile of tiles) {
      this.picture.draw(this, tile, this.samples);
    }
    this.picture.present(this.exposure);
    if (tiles.length && !this.waiting.length) {
      if (finest) {
        // For scripts and tests: the picture as radiance
        canvas.dispatchEvent(new CustomEvent("drawn", { detail: () => this.picture.read() }));
      } else {
        this.samples = SAMPLES;
        this.waiting = this.picture.tiles(SAMPLES, this.beside);
      }
    }
    if (this.waiting.length) {
      this.ask();
    }
  }

  listen() {
    for (const known of ["pointerdown", "wheel", "keydown"]) {
      canvas.addEventListener(known, () => { document.querySelector("#hint").hidden = true; }, { once: true });
    }
    const fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button === 0) {
        canvas.setPointerCapture(event.pointerId); // or a drag that ends outside of a frame would not end
        fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        canvas.classList.add("held");
      }
    });
    canvas.addEventListener("pointermove", (event) => {
      const finger = fingers.get(event.pointerId);
      if (!finger) {
        return;
      }
      const before = fingers.size === 2 ? spread() : 0;
      const [across, up] = [event.clientX - finger.x, finger.y - event.clientY];
      Object.assign(finger, { x: event.clientX, y: event.clientY });
      const size = Math.min(canvas.clientWidth, canvas.clientHeight);
      if (fingers.size === 2 && before > 0) {
        this.camera.magnify(spread() / before);
      } else if (fingers.size === 1) {
        this.camera.orbit(across / size, up / size);
      }
      this.moved();
    });
    canvas.addEventListener("lostpointercapture", (event) => {
      fingers.delete(event.pointerId);
      canvas.classList.toggle("held", fingers.size > 0);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const pinched = event.ctrlKey ? 10 : 1; // Two fingers on a touch pad, whose steps are small
      this.camera.magnify(Math.exp((-pinched * event.deltaY) / 500));
      this.moved();
    });
    canvas.addEventListener("keydown", (event) => {
      const act = KEYS[event.key];
      if (act && !event.ctrlKey && !event.metaKey && !event.altKey) {
        event.preventDefault();
        act(this.camera);
        this.moved();
      }
    });
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // asks for another
      say("The graphics driver has stopped this page, which waits for it: load the page again if nothing comes.");
    });
    canvas.addEventListener("webglcontextrestored", () => this.restore().catch(failed));
  }
}

function failed(error) {
  say(error instanceof Missing ? error.message : `This page is damaged: ${error.message}`);
  throw error;
}

async function begin() {
  if (!window.DecompressionStream) {
    throw new Missing("This page needs a browser of 2023 or later, which unpacks its maps.");
  }
  const content = JSON.parse(document.querySelector("#content").textContent);
  await new Page(content, new Picture(canvas, content)).start();
}

begin().catch(failed);
