// The camera of core/geometry/camera.py, on an orbit with Z up; the sphere that it looks at has a share, `fill`, of the
// frame. Matrices are arrays of columns, as WebGL takes them.

class Camera {
  constructor(view, angle, fill) {
    const azimuth = view[0] || view[1] ? Math.atan2(view[1], view[0]) : Math.PI / 2;
    this.first = { azimuth, elevation: Math.asin(view[2]), zoom: 1 };
    this.angle = angle;
    this.fill = fill;
    this.reset();
  }

  reset() {
    Object.assign(this, this.first);
  }

  // By shares of the sphere's diameter.
  orbit(across, up) {
    this.azimuth -= across * Math.PI;
    this.elevation = Math.min(Math.max(this.elevation - up * Math.PI, -Math.PI / 2), Math.PI / 2);
  }

  magnify(factor) {
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.25), 16);
  }

  get viewDir() {
    const [flat, up] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    return [flat * Math.cos(this.azimuth), flat * Math.sin(this.azimuth), up];
  }

  get distance() {
    return this.angle === null ? 2 : 1 / Math.sin(this.angle / 2);
  }

  // Homogeneous: a direction where the projection is parallel.
  get eye() {
    const far = this.angle === null ? 1 : this.distance;
    return [...this.viewDir.map((part) => part * far), this.angle === null ? 0 : 1];
  }

  get view() {
    const z = this.viewDir;
    const x = [-Math.sin(this.azimuth), Math.cos(this.azimuth), 0];
    const y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]];
    return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, 0, 0, -this.distance, 1];
  }

  // Eye and view of a sphere in the world.
  of([x, y, z, size]) {
    const { eye, view } = this;
    const radius = size / this.fill;
    const moved = [x, y, z].map((part, axis) => part * eye[3] + radius ** eye[3] * eye[axis]);
    const scaled = view.map((part, place) => (place < 12 ? part / radius : part));
    for (const row of [0, 1, 2]) {
      scaled[12 + row] -= x * scaled[row] + y * scaled[4 + row] + z * scaled[8 + row];
    }
    return { eye: [...moved, eye[3]], view: scaled };
  }

  // Onto a tile of a picture, both in pixels; of what is within `reach` of the middle.
  projection(picture, tile, reach = 1.5) {
    let [near, far] = [this.distance - reach, this.distance + reach];
    const least = Math.min(picture.width, picture.height);
    const stretch = [(least / tile.width) * this.zoom, (least / tile.height) * this.zoom];
    const shift = [
      (picture.width - 2 * tile.x - tile.width) / tile.width,
      (picture.height - 2 * tile.y - tile.height) / tile.height,
    ];
    if (this.angle === null) {
      const depth = [-2 / (far - near), -(far + near) / (far - near)];
      return [stretch[0], 0, 0, 0, 0, stretch[1], 0, 0, 0, 0, depth[0], 0, shift[0], shift[1], depth[1], 1];
    }
    near = Math.max(near, 0.5 * (this.distance - 1));
    const scale = 1 / Math.tan(this.angle / 2);
    const depth = [-(far + near) / (far - near), (-2 * far * near) / (far - near)];
    return [
      ...[scale * stretch[0], 0, 0, 0, 0, scale * stretch[1], 0, 0],
      ...[-shift[0], -shift[1], depth[0], -1, 0, 0, depth[1], 0],
    ];
  }
}

// Columns of a turn about Z.
function turnedBy(angle) {
  const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
  return [cosine, sine, 0, 0, -sine, cosine, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
}
