// What lies behind the objects, and the floor that takes their shadow: tasks/matte.py and device/matte_layer.py.

const STILL = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

class Matte {
  constructor(picture, packed) {
    this.picture = picture;
    this.packed = packed;
    this.shadowAt = null; // The turn of the light that the floor's shadow is of
  }

  async load() {
    const { picture, packed } = this;
    const gl = picture.gl;
    this.behind = picture.target(TILE, TILE, false);
    this.layer = picture.target(TILE, TILE, false);
    this.light = packed.light && picture.texture({ type: "FLOAT_2D", ...packed.light }, packed.light.size, await texels(packed.light));
    this.photograph = packed.picture && (await texels(packed.picture));
    if (packed.floor) {
      const { directions, irradiance, size } = packed.floor;
      [this.directions, this.irradiance] = [await floats(directions), await floats(irradiance)];
      this.total = [0, 1, 2].map((channel) => this.irradiance.filter((_, at) => at % 3 === channel).reduce((sum, each) => sum + each, 0));
      this.shadow = picture.target(size, size, true);
      this.floor = gl.createVertexArray();
      gl.bindVertexArray(this.floor);
      picture.attribute(0, 3, gl.FLOAT, new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]));
    }
  }

  // The photograph, as large as a frame.
  plateOf({ width, height }) {
    if (this.plate?.width !== width || this.plate.height !== height) {
      if (this.plate) {
        this.picture.gl.deleteTexture(this.plate.made);
      }
      const values = fitted(this.photograph, this.packed.picture.size, width, height);
      const made = this.picture.texture({ type: "FLOAT_2D", half: false }, [width, height, 0], values);
      this.plate = { ...made, width, height };
    }
    return this.plate;
  }

  // Puts all this under a tile of the objects, and returns what then holds both.
  under(page, tile, samples) {
    const { picture, packed } = this;
    const gl = picture.gl;
    const hasBackground = Boolean(this.light || this.photograph);
    const scale = ["uniform1f", 2 ** page.backgroundExposure];
    const lookups = this.light ? Math.min(samples, packed.samples) : 1;
    if (this.light) {
      picture.aim(picture.tile, tile.width * lookups, tile.height * lookups);
      const place = ["uniformMatrix4fv", false, lightFromClip(page, tile, packed.angle)];
      picture.pass("backdrop", { environment: this.light }, { environment_from_clip: place, scale });
    } else if (this.photograph) {
      const { width, height } = tile.frame;
      picture.aim(picture.tile, tile.width, tile.height);
      const size = ["uniform2f", tile.width / width / 2, tile.height / height / 2];
      const middle = ["uniform2f", (tile.x + tile.width / 2) / width, (tile.y + tile.height / 2) / height];
      picture.pass("picture_backdrop", { picture: this.plateOf(tile.frame) }, { size, middle, scale });
    }
    picture.aim(this.behind, tile.width, tile.height);
    if (hasBackground) {
      picture.pass("means", { samples: picture.tile }, { per_axis: ["uniform1i", lookups] });
    }
    if (packed.floor) {
      this.takeShadow(page, tile, hasBackground);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.behind.framebuffer);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    picture.pass("layer", { layer: picture.part }, { scale: ["uniform1f", 1] });
    gl.disable(gl.BLEND);
    return this.behind;
  }

  takeShadow(page, tile, hasBackground) {
    const { picture } = this;
    const gl = picture.gl;
    const { height, extent } = this.packed.floor;
    const [x, y, , radius] = picture.content.fit;
    const half = (extent * radius) / picture.content.fill;
    if (this.shadowAt !== page.turn) {
      this.cast(page.turn, half);
    }
    picture.aim(this.layer, tile.width, tile.height);
    const { eye, view } = page.camera.of(picture.content.fit);
    if (eye[2] > eye[3] * height) {
      const projection = page.camera.projection(tile.frame, tile, 3 * extent);
      const model = [half, 0, 0, 0, 0, half, 0, 0, 0, 0, 1, 0, x, y, height, 1];
      const floorFromWorld = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -height, 1];
      picture.fill(0, drawBlock(model, view, projection, STILL, eye));
      picture.fill(1, new Float32Array([...floorFromWorld, 0, 0, half, 0, ...this.total, 0]));
      gl.bindVertexArray(this.floor);
      picture.use("caught_shadow", { shadow: this.shadow }, { samples_in_half: ["uniform2f", tile.width / 2, tile.height / 2] });
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.behind.framebuffer);
    gl.enable(gl.BLEND);
    gl.blendFunc(...(hasBackground ? [gl.DST_COLOR, gl.ZERO] : [gl.ONE, gl.ONE_MINUS_SRC_ALPHA]));
    picture.pass("matte_layer", { layer: this.layer }, { on_nothing: ["uniform1f", hasBackground ? 0 : 1] });
    gl.disable(gl.BLEND);
  }

  // The irradiance that the objects take from the floor: device/floor_shadow.py.
  cast(turn, half) {
    const { picture } = this;
    const gl = picture.gl;
    const { height, size } = this.packed.floor;
    const [x, y] = picture.content.fit;
    const [cosine, sine] = [Math.cos(turn), Math.sin(turn)];
    const count = this.directions.length / 3;
    picture.aim(this.shadow, size, size);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    picture.use("floor_shadow", {}, { samples_in_half: ["uniform2f", size / 2, size / 2] });
    for (let lamp = 0; lamp < count; lamp++) {
      const [east, north, up] = this.directions.subarray(3 * lamp, 3 * lamp + 3);
      const slope = [-(cosine * east - sine * north) / up, -(sine * east + cosine * north) / up];
      const flattened = [1, 0, 0, 0, 0, 1, 0, 0, ...slope, 0, 0, 0, 0, 0, 1];
      const above = [1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 0, 0, 0, 0, 0.9 - (1.8 * lamp) / count, 1];
      picture.fill(1, new Float32Array([...this.irradiance.subarray(3 * lamp, 3 * lamp + 3), 0]));
      for (const { mesh, model, slots } of picture.objects) {
        const placed = [...model.slice(0, 12), model[12] - x, model[13] - y, model[14] - height, 1];
        picture.fill(0, drawBlock(placed, flattened, above, STILL, [0, 0, 1, 0]));
        gl.bindVertexArray(mesh);
        gl.drawElements(gl.TRIANGLES, slots[slots.length - 1][1], gl.UNSIGNED_INT, 0);
      }
    }
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.shadowAt = turn;
  }
}

// From a tile's clip coordinates to the directions of the light: device/backdrop.py.
function lightFromClip({ camera, turn }, tile, angle) {
  const seen = Object.assign(new Camera(camera.viewDir, camera.angle ?? angle, camera.fill), { zoom: camera.zoom });
  const p = seen.projection(tile.frame, tile);
  const rays = [
    [1 / p[0], 0, 0, 0],
    [0, 1 / p[5], 0, 0],
    [0, 0, 0, 1 / p[14]],
    [p[8] / p[0], p[9] / p[5], -1, p[10] / p[14]],
  ];
  const [back, view] = [turnedBy(-turn), camera.view];
  // The view's rows are the camera's axes in the world
  const axes = [0, 1, 2].map((axis) => {
    const [east, north, up] = [view[axis], view[4 + axis], view[8 + axis]];
    return [back[0] * east + back[4] * north, back[1] * east + back[5] * north, up];
  });
  return rays.flatMap(([x, y, z, w]) => [...[0, 1, 2].map((row) => x * axes[0][row] + y * axes[1][row] + z * axes[2][row]), w]);
}

// The middle of a picture, each pixel the mean over its part: core/pictures/matte.py `fitted`.
function fitted(values, [width, height], across, up) {
  const side = Math.min(width / across, height / up);
  const sums = (first, count, texels, step, rows, rowStep, from) => {
    const made = new Float32Array(4 * count * rows).fill(1);
    for (let row = 0; row < rows; row++) {
      for (let pixel = 0; pixel < count; pixel++) {
        const [low, high] = [first + pixel * side, first + (pixel + 1) * side];
        for (let channel = 0; channel < 3; channel++) {
          let sum = 0;
          for (let texel = Math.floor(low); texel < high && texel < texels; texel++) {
            const share = Math.min(high, texel + 1) - Math.max(low, texel);
            sum += share * from[4 * (row * rowStep + texel * step) + channel];
          }
          made[4 * (row * count + pixel) + channel] = sum / side;
        }
      }
    }
    return made;
  };
  const [left, bottom] = [Math.floor((width - across * side) / 2), Math.floor((height - up * side) / 2)];
  const narrow = sums(left, across, width, 1, height, width, values);
  const turned = sums(bottom, up, height, across, across, 1, narrow);
  const made = new Float32Array(turned.length);
  for (let texel = 0; texel < across * up; texel++) {
    const [column, row] = [Math.floor(texel / up), texel % up];
    made.set(turned.subarray(4 * texel, 4 * texel + 4), 4 * (row * across + column));
  }
  return made;
}
