// Undo codec.py: base64, zlib, high bytes before low ones, differences in time.
async function inflate(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function decode(stream) {
  const planes = await inflate(stream.data);
  const row = stream.shape.slice(1).reduce((a, b) => a * b, 1);
  const count = stream.shape[0] * row;
  const wide = stream.bytes === 2;
  const numbers = wide ? new Uint16Array(count) : new Uint8Array(count);
  for (let k = 0; k < count; k++) numbers[k] = wide ? planes[k] * 256 + planes[count + k] : planes[k];
  for (let k = row; k < count; k++) numbers[k] += numbers[k - row]; // modulo the range of the kind
  return { numbers, row, frames: stream.shape[0], low: stream.low, step: stream.step, none: wide ? 65535 : 255, turn: !!stream.turn };
}

// Values of a stream at a place between two pictures, into `out`; NaN where they are not there.
function valuesAt(stream, frame, share, out) {
  const { numbers, row, low, step, none, turn } = stream;
  const width = low.length;
  const one = Math.min(frame, stream.frames - 1) * row;
  const two = Math.min(frame + 1, stream.frames - 1) * row;
  for (let k = 0; k < row; k++) {
    const a = numbers[one + k], b = numbers[two + k], c = k % width;
    let number = a;
    if (turn) number = a + share * ((((b - a + 32768) % 65536) + 65536) % 65536 - 32768);
    else if (a === none) number = NaN;
    else if (b !== none) number = a + share * (b - a);
    out[k] = low[c] + step[c] * number;
  }
  return out;
}
