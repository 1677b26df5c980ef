// Arrays out of their JSON: files/packed_arrays.py, core/companded.py and core/antialiased/summed_area.py.

const STEPS = 256;

async function inflated(text) {
  const stored = bytesOf(text);
  const stream = new Blob([stored]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer().catch(() => {
    throw new Error("a part of it cannot be unpacked. Ask for it again.");
  });
}

// 13 bits in two letters, or 5 at the end in one.
function bytesOf(text) {
  const pairs = text.length >> 1;
  const bytes = new Uint8Array((13 * pairs + 5 * (text.length % 2)) >> 3);
  let [held, count, filled] = [0, 0, 0];
  for (let place = 0; place < text.length; place += 2) {
    const paired = place + 1 < text.length;
    held = paired ? (held << 13) | (91 * digit(text, place) + digit(text, place + 1)) : (held << 5) | digit(text, place);
    for (count += paired ? 13 : 5; count >= 8; filled++) {
      count -= 8;
      bytes[filled] = held >> count;
    }
    held &= (1 << count) - 1;
  }
  return bytes;
}

// Of the letters from ! on, without ", < and \.
function digit(text, place) {
  const code = text.charCodeAt(place);
  return code - 33 - (code > 34) - (code > 60) - (code > 92);
}

async function floats(packed) {
  return new Float32Array(await inflated(packed.data));
}

// Whole numbers: bytes by significance, differences along axes.
async function integers({ shape, bits, along, data }, signed) {
  const count = shape.reduce((product, length) => product * length);
  const bytes = new Uint8Array(await inflated(data));
  const types = { 8: Uint8Array, 16: signed ? Int16Array : Uint16Array, 32: Uint32Array };
  const numbers = new types[bits](count); // which takes values modulo 2^bits
  for (let number = 0; number < count; number++) {
    let folded = 0;
    for (let place = bits / 8 - 1; place >= 0; place--) {
      folded = folded * 256 + bytes[place * count + number];
    }
    numbers[number] = folded % 2 ? -(folded + 1) / 2 : folded / 2;
  }
  for (const axis of along) {
    const stride = shape.slice(axis + 1).reduce((product, length) => product * length, 1);
    for (let number = stride; number < count; number++) {
      if (Math.floor(number / stride) % shape[axis]) {
        numbers[number] += numbers[number - stride];
      }
    }
  }
  return numbers;
}

// Texels of four channels.
async function texels(packed) {
  if (packed.floats) {
    return floats(packed.floats);
  }
  const [width, height, layers] = packed.size;
  const found = new Float32Array(4 * width * height * (layers || 1)).fill(1);
  let begin = 0;
  for (const part of packed.parts) {
    const codes = await integers(part.codes, true);
    const size = codes.length / 3;
    const decoded = part.unit === null ? halfFloat : (code) => part.unit * Math.sinh(code / STEPS);
    const values = Float32Array.from({ length: 65536 }, (_, place) => decoded(place - 32768));
    for (let channel = 0; channel < 3; channel++) {
      for (let texel = 0; texel < size; texel++) {
        let code = codes[channel * size + texel];
        if (part.relative && channel !== 1) {
          code = ((code + codes[size + texel]) << 16) >> 16;
        }
        found[4 * (begin + texel) + channel] = values[code + 32768];
      }
    }
    begin += size;
  }
  return found;
}

// From its bits, as a number with a sign.
function halfFloat(bits) {
  const [exponent, fraction] = [(bits >> 10) & 31, (bits & 1023) / 1024];
  const size = exponent ? 2 ** (exponent - 15) * (1 + fraction) : 2 ** -14 * fraction;
  return bits < 0 ? -size : size;
}

// Sums of a latitude-longitude map within a border of one texel, in three digits of 21 bits.
function sums(bordered, [width, height], unit) {
  const DIGIT = 2097152;
  const [columns, rows] = [width - 2, height - 2];
  const stride = 4 * (columns + 1);
  const layer = stride * (rows + 1);
  const found = new Float32Array(3 * layer);
  for (let row = 0; row < rows; row++) {
    const band = Math.cos((Math.PI * (rows - row - 1)) / rows) - Math.cos((Math.PI * (rows - row)) / rows);
    const angle = (band * 2 * Math.PI) / columns;
    for (let channel = 0; channel < 3; channel++) {
      const along = [0, 0, 0];
      for (let column = 0; column < columns; column++) {
        let power = Math.round((bordered[4 * ((row + 1) * width + column + 1) + channel] * angle) / unit[channel]);
        const at = stride * (row + 1) + 4 * (column + 1) + channel;
        let carried = 0;
        for (let digit = 0; digit < 3; digit++) {
          along[digit] += power % DIGIT;
          power = Math.floor(power / DIGIT);
          const sum = found[digit * layer + at - stride] + along[digit] + carried;
          carried = Math.floor(sum / DIGIT);
          found[digit * layer + at] = sum - carried * DIGIT;
        }
      }
    }
  }
  return found;
}
