// The page: what was packed, the picture, the panel, and fingers and mice on the canvas.

const SAMPLES = 4; // Along each side of a pixel at rest; one while something moves
const SHARPEST = 2; // Pixels of the picture to a pixel of CSS

const canvas = document.querySelector("canvas");

function say(sentence) {
  const place = document.querySelector("#trouble");
  place.textContent = sentence;
  place.hidden = false;
}

class Page {
  constructor(content, picture) {
    this.content = content;
    this.picture = picture;
    this.camera = new Camera(content.view, content.angle);
    this.exposure = content.exposure;
    this.turn = 0;
    this.waiting = [];
    this.samples = 1;
    this.asked = false;
  }

  async start() {
    await this.picture.load(this.content);
    if (this.picture.coarse) {
      say("This device does not interpolate 32-bit float textures, so the picture may show steps.");
    }
    await this.picture.show(this.content.displays[this.content.display]);
    this.fillPanel();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  fillPanel() {
    const panel = new Panel(document.querySelector("#settings"));
    const { block } = this.picture;
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
    const exposure = { name: "exposure", label: "Exposure", help: "In stops, which double the light" };
    const reach = Math.max(6, Math.abs(this.exposure));
    panel.slider(exposure, -reach, reach, this.exposure, (stops) => {
      this.exposure = stops;
      this.ask();
    });
    const names = Object.keys(this.content.displays);
    const display = { name: "display", label: "View", help: "How radiance is shown" };
    panel.menu(display, names, names.indexOf(this.content.display), async (number) => {
      await this.picture.show(this.content.displays[names[number]]);
      this.ask();
    });
    const reset = () => {
      this.camera.reset();
      panel.resets.forEach((each) => each());
      block.set(this.content.block);
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
    this.waiting = this.picture.tiles(1);
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
      this.picture.draw(this.camera, this.turn, tile, this.samples);
    }
    this.picture.present(this.exposure);
    if (tiles.length && !this.waiting.length) {
      if (finest) {
        // For scripts and tests: the picture as radiance
        canvas.dispatchEvent(new CustomEvent("drawn", { detail: () => this.picture.read() }));
      } else {
        this.samples = SAMPLES;
        this.waiting = this.picture.tiles(SAMPLES);
      }
    }
    if (this.waiting.length) {
      this.ask();
    }
  }

  listen() {
    const fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      canvas.classList.add("held");
    });
    window.addEventListener("pointermove", (event) => {
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
    for (const end of ["pointerup", "pointercancel"]) {
      window.addEventListener(end, (event) => {
        fingers.delete(event.pointerId);
        canvas.classList.toggle("held", fingers.size > 0);
      });
    }
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.magnify(Math.exp(-event.deltaY / 500));
      this.moved();
    });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (step) {
        event.preventDefault();
        this.camera.orbit(step[0] / 36, step[1] / 36);
        this.moved();
      }
    });
    canvas.addEventListener("webglcontextlost", () => say("The graphics driver has given up: load the page again."));
  }
}

async function begin() {
  if (!window.DecompressionStream) {
    throw new Missing("This page needs a browser of 2023 or later, which unpacks its maps.");
  }
  const content = JSON.parse(document.querySelector("#content").textContent);
  await new Page(content, new Picture(canvas)).start();
}

begin().catch((error) => {
  say(error instanceof Missing ? error.message : `This page is damaged: ${error.message}`);
  throw error;
});
