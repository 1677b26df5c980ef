// Draws the mesh into a picture of radiance, tile by tile, and brings that to the canvas: device/preview.py.

const TILE = 1024; // Samples along a tile's side
const DISPLAY_NODES = 96;

class Missing extends Error {}

class Picture {
  constructor(canvas, content) {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (!gl) {
      throw new Missing("This page needs WebGL 2, and this browser has none, or has it switched off.");
    }
    const floats = gl.getExtension("EXT_color_buffer_float");
    if (!floats && !gl.getExtension("EXT_color_buffer_half_float")) {
      throw new Missing("This page draws to float textures, which this device does not allow.");
    }
    this.translucent = content.materials.some((material) => !material.opaque);
    const blends = !(this.translucent || content.matte) || gl.getExtension("EXT_float_blend");
    this.format = floats && blends ? gl.RGBA32F : gl.RGBA16F;
    this.gl = gl;
    this.content = content;
    this.canvas = canvas;
  }

  async load() {
    const { gl, content } = this;
    this.programs = {};
    const programs = JSON.parse(new TextDecoder().decode(await inflated(content.programs)));
    for (const [name, sources] of Object.entries(programs)) {
      if (name !== "translucent" || this.translucent) {
        this.programs[name] = this.built(name, sources);
      }
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
    const images = [];
    for (const image of content.images) {
      images.push(await this.image(image));
    }
    const none = this.bound(gl.TEXTURE_2D, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.images = content.materials.map((material) => {
      const places = Array.from({ length: content.most_images }, (_, place) => place);
      const sampled = (place) => images[material.images[place]] || { target: gl.TEXTURE_2D, made: none };
      return Object.fromEntries(places.map((place) => [`image_${place}`, sampled(place)]));
    });
    this.objects = [];
    for (const object of content.objects) {
      this.objects.push({ ...object, mesh: await this.loadMesh(object.mesh) });
    }
    this.buffers = ["DrawBlock", "LookBlock"].map((name, slot) => {
      for (const program of Object.values(this.programs)) {
        const place = gl.getUniformBlockIndex(program, name);
        if (place !== gl.INVALID_INDEX) {
          gl.uniformBlockBinding(program, place, slot);
        }
      }
      const buffer = gl.createBuffer();
      gl.bindBufferBase(gl.UNIFORM_BUFFER, slot, buffer);
      return buffer;
    });
    this.tile = this.target(TILE, TILE, true);
    this.matte = content.matte && new Matte(this, content.matte);
    this.part = this.target(TILE, TILE, false);
    this.screen = gl.createVertexArray();
    gl.bindVertexArray(this.screen);
    this.attribute(0, 2, gl.FLOAT, new Float32Array([-1, -1, 3, -1, -1, 3]));
    await this.matte?.load();
  }

  async loadMesh(mesh) {
    const gl = this.gl;
    const { corners, places, directions } = await unpackedMesh(mesh);
    const made = gl.createVertexArray();
    gl.bindVertexArray(made);
    this.attribute(0, 3, gl.SHORT, places);
    if (directions) {
      this.attribute(1, 3, gl.FLOAT, directions);
    } else {
      this.attribute(1, 3, gl.SHORT, places);
    }
    for (const [place, name] of [[2, "tangent"], [3, "uv_a"], [4, "uv_b"]]) {
      gl.vertexAttrib4f(place, 0, 0, 0, 0);
      if (mesh[name]) {
        this.attribute(place, 4, gl.FLOAT, await floats(mesh[name]));
      }
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    return made;
  }

  // An image of a material, which has mips.
  async image(packed) {
    const gl = this.gl;
    const made = this.bound(gl.TEXTURE_2D, packed.closest ? gl.NEAREST : gl.LINEAR);
    if (packed.png) {
      const stored = Uint8Array.from(atob(packed.png), (letter) => letter.charCodeAt(0));
      const asStored = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
      const bitmap = await createImageBitmap(new Blob([stored], { type: "image/png" }), asStored);
      gl.bindTexture(gl.TEXTURE_2D, made);
      const format = packed.srgb ? gl.SRGB8_ALPHA8 : gl.RGBA8;
      gl.texImage2D(gl.TEXTURE_2D, 0, format, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    } else {
      const values = await texels(packed);
      gl.bindTexture(gl.TEXTURE_2D, made);
      const [width, height] = packed.size;
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    }
    const extend = { REPEAT: gl.REPEAT, EXTEND: gl.CLAMP_TO_EDGE, MIRRORED_REPEAT: gl.MIRRORED_REPEAT }[packed.extend];
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, extend);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, extend);
    if (!packed.closest) {
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
      gl.generateMipmap(gl.TEXTURE_2D);
    }
    return { target: gl.TEXTURE_2D, made };
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

  // Has draws go to the empty corner of a target.
  aim({ framebuffer }, width, height) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  draw(page, tile, samples) {
    const gl = this.gl;
    const { camera, turn, blocks } = page;
    this.aim(this.tile, tile.width * samples, tile.height * samples);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    const half = { samples_in_half: ["uniform2fv", [tile.width * samples * 0.5, tile.height * samples * 0.5]] };
    this.drawSlots("surface", camera, turn, tile, blocks, half);
    if (this.translucent) {
      // What covers all, then what covers in part: device/kinds/kernel_pyramid.py
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      for (const whole of [1, 0]) {
        this.drawSlots("translucent", camera, turn, tile, blocks, { ...half, whole: ["uniform1f", whole] });
      }
      gl.disable(gl.BLEND);
    }
    gl.disable(gl.DEPTH_TEST);
    this.aim(this.part, tile.width, tile.height);
    this.pass("means", { samples: this.tile }, { per_axis: ["uniform1i", samples] });
    const whole = this.matte ? this.matte.under(page, tile, samples) : this.part;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, whole.framebuffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.radiance.framebuffer);
    const left = tile.frame.left + tile.x;
    const [right, top] = [left + tile.width, tile.y + tile.height];
    gl.blitFramebuffer(0, 0, tile.width, tile.height, left, tile.y, right, top, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  // The slots of all objects that a program draws.
  drawSlots(program, camera, turn, tile, blocks, uniforms) {
    const gl = this.gl;
    for (const { mesh, model, slots } of this.objects) {
      gl.bindVertexArray(mesh);
      this.fill(0, this.placed(camera, turn, tile, model));
      for (const [begin, end, material] of slots) {
        if (this.content.materials[material].opaque === (program === "surface")) {
          this.fill(1, blocks[material]);
          this.use(program, { ...tile.frame.textures, ...this.images[material] }, uniforms);
          gl.drawElements(gl.TRIANGLES, end - begin, gl.UNSIGNED_INT, 4 * begin);
        }
      }
    }
  }

  // The light turns by `turn`, so the map set sees the mesh turned back.
  placed(camera, turn, tile, model) {
    const back = turnedBy(-turn);
    const { eye, view } = camera.of(this.content.fit);
    const turned = [0, 1, 2].map((row) => back[row] * eye[0] + back[4 + row] * eye[1] + back[8 + row] * eye[2]);
    const projection = camera.projection(tile.frame, tile);
    return drawBlock(model, view, projection, back, [...turned, eye[3]]);
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
    for (const [uniform, [setter, ...values]] of Object.entries(uniforms)) {
      gl[setter](gl.getUniformLocation(program, uniform), ...values);
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

// device/drawing.py `Draw.block`
function drawBlock(model, view, projection, turn, eye) {
  return new Float32Array([...model, ...view, ...projection, ...turn, ...eye, 1, 0, 0, 0]);
}
