// Meshes out of their JSON: tasks/export/page/meshes.py.

const COORDINATE_STEPS = 32767;
const NORMAL_STEPS = 8191;

async function unpackedMesh({ positions, normals, triangles }) {
  const corners = transposed(await integers(triangles, false));
  const places = placed(corners, await integers(positions, true));
  const directions = normals ? directed(corners, places, await integers(normals, true)) : null;
  return { corners, places, directions };
}

// Corners one after the other, of a row for each of three.
function transposed(rows) {
  const count = rows.length / 3;
  return rows.map((_, number) => rows[(number % 3) * count + Math.floor(number / 3)]);
}

// Coordinates in steps, vertex after vertex, of what they differ by from their guesses.
function placed(corners, moves) {
  const count = moves.length / 3;
  const found = new Int16Array(moves.length); // which takes values modulo 2^16
  const across = new Map();
  const edge = (a, b) => Math.min(a, b) * count + Math.max(a, b);
  let known = 0;
  for (let first = 0; first < corners.length; first += 3) {
    const triangle = [...corners.subarray(first, first + 3)];
    triangle.forEach((vertex, corner) => {
      if (vertex !== known) {
        return;
      }
      const [a, b] = [triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]];
      const opposite = across.get(edge(a, b));
      const near = [a, b].find((each) => each < known) ?? known - 1;
      for (const axis of [0, 1, 2]) {
        const at = (each) => (each < 0 ? 0 : found[3 * each + axis]);
        const guess = opposite === undefined ? at(near) : at(a) + at(b) - at(opposite);
        found[3 * known + axis] = guess + moves[axis * count + known];
      }
      known += 1;
    });
    triangle.forEach((vertex, corner) => across.set(edge(triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]), vertex));
  }
  return found;
}

// Unit normals, one after the other, of what their places on the octahedron differ by from those of the normals that
// triangles make.
function directed(corners, places, moves) {
  const count = moves.length / 2;
  const made = madeNormals(corners, places);
  const found = new Float32Array(3 * count);
  for (let number = 0; number < count; number++) {
    const guess = onOctahedron(rounded(made.subarray(3 * number, 3 * number + 3)));
    let [x, y] = guess.map((place, axis) => (Math.round(NORMAL_STEPS * place) + moves[axis * count + number]) / NORMAL_STEPS);
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) {
      [x, y] = folded(x, y);
    }
    const size = Math.hypot(x, y, z);
    found.set([x / size, y / size, z / size], 3 * number);
  }
  return found;
}

function madeNormals(corners, places) {
  const found = new Float64Array(places.length);
  const vertex = (number) => [places[3 * number], places[3 * number + 1], places[3 * number + 2]];
  for (let first = 0; first < corners.length; first += 3) {
    const numbers = [corners[first], corners[first + 1], corners[first + 2]];
    const triangle = numbers.map(vertex);
    const side = (from, to) => triangle[to].map((place, axis) => place - triangle[from][axis]);
    const [u, v] = [side(0, 1), side(0, 2)];
    const area = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...area);
    numbers.forEach((number, corner) => {
      const [along, other] = [side(corner, (corner + 1) % 3), side(corner, (corner + 2) % 3)];
      const angle = Math.atan2(size, along[0] * other[0] + along[1] * other[1] + along[2] * other[2]);
      for (const axis of [0, 1, 2]) {
        found[3 * number + axis] += (angle * area[axis]) / Math.max(size, 1);
      }
    });
  }
  return found;
}

// To a unit vector of 9 decimals, which is on the same side of a fold as where the mesh was packed.
function rounded(vector) {
  const size = Math.max(Math.hypot(...vector), 1e-9);
  return [...vector].map((part) => Math.round((part / size) * 1e9) / 1e9);
}

// The unfolded octahedron: core/maps/octahedral.py.
function onOctahedron([x, y, z]) {
  const size = Math.abs(x) + Math.abs(y) + Math.abs(z);
  if (size === 0) {
    return [0, 0];
  }
  return z < 0 ? folded(x / size, y / size) : [x / size, y / size];
}

function folded(x, y) {
  return [(x < 0 ? -1 : 1) * (1 - Math.abs(y)), (y < 0 ? -1 : 1) * (1 - Math.abs(x))];
}
