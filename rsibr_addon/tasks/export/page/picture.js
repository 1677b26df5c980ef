// Draws the mesh into a picture of radiance, tile by tile, and brings that to the canvas: device/preview.py.

const TILE = 1024; // Samples along a tile's side
const DISPLAY_NODES = 96;

class Missing extends Error {}

class Picture {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (!gl) {
      throw new Missing("This page needs WebGL 2, and this browser has none, or has it switched off.");
    }
    const floats = gl.getExtension("EXT_color_buffer_float");
    if (!floats && !gl.getExtension("EXT_color_buffer_half_float")) {
      throw new Missing("This page draws to float textures, which this device does not allow.");
    }
    this.format = floats ? gl.RGBA32F : gl.RGBA16F;
    this.gl = gl;
    this.canvas = canvas;
  }

  async load(content) {
    const gl = this.gl;
    this.programs = {};
    for (const [name, sources] of Object.entries(content.programs)) {
      this.programs[name] = this.built(name, sources);
    }
    const filled = {};
    for (const [name, packed] of Object.entries(content.textures)) {
      filled[name] = packed.summed ? null : await texels(packed);
    }
    this.textures = {};
    for (const [name, packed] of Object.entries(content.textures)) {
      const size = packed.summed && content.textures[packed.summed].size;
      const values = size ? sums(filled[packed.summed], size, packed.unit) : filled[name];
      this.textures[name] = this.texture(packed, size ? [size[0] - 1, size[1] - 1, 3] : packed.size, values);
    }
    this.split = { ...this.textures };
    for (const [name, packed] of Object.entries(content.split)) {
      this.split[name] = this.texture(packed, packed.size, await texels(packed));
    }
    await this.loadMesh(content.mesh);
    this.buffers = ["DrawBlock", "LookBlock"].map((name, slot) => {
      const program = this.programs.surface;
      gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, name), slot);
      const buffer = gl.createBuffer();
      gl.bindBufferBase(gl.UNIFORM_BUFFER, slot, buffer);
      return buffer;
    });
    this.tile = this.target(TILE, TILE, true);
    this.part = this.target(TILE, TILE, false);
    this.screen = gl.createVertexArray();
    gl.bindVertexArray(this.screen);
    this.attribute(0, 2, gl.FLOAT, new Float32Array([-1, -1, 3, -1, -1, 3]));
  }

  async loadMesh(mesh) {
    const gl = this.gl;
    this.mesh = gl.createVertexArray();
    gl.bindVertexArray(this.mesh);
    this.attribute(0, 3, gl.SHORT, transposed(await integers(mesh.positions, true)));
    this.attribute(1, 3, gl.SHORT, transposed(await integers(mesh.normals || mesh.positions, true)));
    const corners = transposed(await integers(mesh.triangles, false));
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    this.corners = corners.length;
  }

  attribute(place, width, type, values) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, width, type, true, 0, 0);
  }

  built(name, sources) {
    const gl = this.gl;
    const program = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((type, number) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, sources[number]);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
        throw new Missing(`The graphics driver refuses a shader (${name}): ${gl.getShaderInfoLog(shader)}`);
      }
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Missing(`The graphics driver refuses a program (${name}): ${gl.getProgramInfoLog(program)}`);
    }
    return program;
  }

  texture({ type, half }, [width, height, layers], values) {
    const gl = this.gl;
    const deep = type === "FLOAT_3D";
    const most = gl.getParameter(deep ? gl.MAX_3D_TEXTURE_SIZE : gl.MAX_TEXTURE_SIZE);
    const mostLayers = deep ? most : gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS);
    if (Math.max(width, height) > most || layers > mostLayers) {
      throw new Missing(`This page has a texture of ${width} x ${height} x ${layers || 1}, too large for this device.`);
    }
    const format = half ? gl.RGBA16F : gl.RGBA32F;
    const target = layers ? (deep ? gl.TEXTURE_3D : gl.TEXTURE_2D_ARRAY) : gl.TEXTURE_2D;
    const made = this.bound(target, gl.NEAREST); // Shaders interpolate
    if (layers) {
      gl.texImage3D(target, 0, format, width, height, layers, 0, gl.RGBA, gl.FLOAT, values);
    } else {
      gl.texImage2D(target, 0, format, width, height, 0, gl.RGBA, gl.FLOAT, values);
    }
    return { target, made };
  }

  bound(target, filter) {
    const gl = this.gl;
    const made = gl.createTexture();
    gl.bindTexture(target, made);
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, filter);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
      gl.texParameteri(target, axis, gl.CLAMP_TO_EDGE);
    }
    return made;
  }

  async show(packed) {
    const gl = this.gl;
    const planes = await integers(packed, false);
    const count = DISPLAY_NODES ** 3;
    const colours = new Uint8Array(4 * count);
    for (let number = 0; number < 3 * count; number++) {
      colours[4 * (number % count) + Math.floor(number / count)] = planes[number];
    }
    if (this.display) {
      gl.deleteTexture(this.display.made);
    }
    const size = [DISPLAY_NODES, DISPLAY_NODES, DISPLAY_NODES];
    const made = this.bound(gl.TEXTURE_3D, gl.NEAREST);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA8, ...size, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
    this.display = { target: gl.TEXTURE_3D, made };
  }

  target(width, height, deep) {
    const gl = this.gl;
    const radiance = this.bound(gl.TEXTURE_2D, gl.NEAREST);
    gl.texStorage2D(gl.TEXTURE_2D, 1, this.format, width, height);
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, radiance, 0);
    if (deep) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, gl.createRenderbuffer());
      gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, gl.getParameter(gl.RENDERBUFFER_BINDING));
    }
    return { target: gl.TEXTURE_2D, made: radiance, framebuffer, width, height };
  }

  // A picture of the canvas's size.
  fit(width, height) {
    if (this.radiance && this.radiance.width === width && this.radiance.height === height) {
      return;
    }
    if (this.radiance) {
      this.gl.deleteTexture(this.radiance.made);
      this.gl.deleteFramebuffer(this.radiance.framebuffer);
    }
    this.radiance = this.target(width, height, false);
    [this.canvas.width, this.canvas.height] = [width, height];
  }

  // The tiles of a picture with so many samples along each side of a pixel. Beside, the object has the left half of
  // the picture, and the right one by the split sum.
  tiles(samples, beside) {
    const side = TILE / samples;
    const height = this.radiance.height;
    const width = beside ? Math.max(Math.floor(this.radiance.width / 2), 1) : this.radiance.width;
    const found = [];
    for (let place = 0; place < (beside ? 2 : 1); place++) {
      const frame = { left: place * width, width, height, textures: place ? this.split : this.textures };
      for (let y = 0; y < height; y += side) {
        for (let x = 0; x < width; x += side) {
          found.push({ frame, x, y, width: Math.min(side, width - x), height: Math.min(side, height - y) });
        }
      }
    }
    return found;
  }

  draw({ camera, turn, block }, tile, samples) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.tile.framebuffer);
    gl.viewport(0, 0, tile.width * samples, tile.height * samples);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    this.fill(0, this.drawBlock(camera, turn, tile));
    this.fill(1, block);
    this.use("surface", tile.frame.textures, {});
    gl.bindVertexArray(this.mesh);
    gl.drawElements(gl.TRIANGLES, this.corners, gl.UNSIGNED_INT, 0);
    gl.disable(gl.DEPTH_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.part.framebuffer);
    gl.viewport(0, 0, tile.width, tile.height);
    this.pass("means", { samples: this.tile }, { per_axis: ["uniform1i", samples] });
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.radiance.framebuffer);
    const left = tile.frame.left + tile.x;
    const [right, top] = [left + tile.width, tile.y + tile.height];
    gl.blitFramebuffer(0, 0, tile.width, tile.height, left, tile.y, right, top, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  // device/drawing.py `Draw.block`. The light turns by `turn`, so the map set sees the mesh turned back.
  drawBlock(camera, turn, tile) {
    const back = turnedBy(-turn);
    const eye = camera.eye;
    const turned = [0, 1, 2].map((row) => back[row] * eye[0] + back[4 + row] * eye[1] + back[8 + row] * eye[2]);
    const projection = camera.projection(tile.frame, tile);
    return new Float32Array([...turnedBy(0), ...camera.view, ...projection, ...back, ...turned, eye[3], 1, 0, 0, 0]);
  }

  fill(slot, values) {
    const gl = this.gl;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffers[slot]);
    gl.bufferData(gl.UNIFORM_BUFFER, values, gl.DYNAMIC_DRAW);
  }

  use(name, textures, uniforms) {
    const gl = this.gl;
    const program = this.programs[name];
    gl.useProgram(program);
    Object.entries(textures).forEach(([sampler, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(texture.target, texture.made);
      gl.uniform1i(gl.getUniformLocation(program, sampler), unit);
    });
    for (const [uniform, [setter, value]] of Object.entries(uniforms)) {
      gl[setter](gl.getUniformLocation(program, uniform), value);
    }
  }

  pass(name, textures, uniforms) {
    this.use(name, textures, uniforms);
    this.gl.bindVertexArray(this.screen);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  present(exposure) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.radiance.width, this.radiance.height);
    const scale = ["uniform1f", 2 ** exposure];
    this.pass("display", { picture: this.radiance, display: this.display }, { scale });
  }

  // Radiance times coverage, and coverage, from the lowest row up.
  read() {
    const gl = this.gl;
    const { width, height, framebuffer } = this.radiance;
    const pixels = new Float32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    return { width, height, pixels };
  }
}

// Corners or vertices one after the other, of a row for each of three coordinates.
function transposed(rows) {
  const count = rows.length / 3;
  return rows.map((_, number) => rows[(number % 3) * count + Math.floor(number / 3)]);
}
