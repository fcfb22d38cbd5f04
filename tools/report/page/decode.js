// Undoes runtime/trace/packing.cpp: base64, deflate, byte planes, zigzag, differences, scale.

async function inflate(base64) {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/** The whole numbers behind byte planes, lowest byte first: 0, 1, 2, 3 stand for 0, -1, 1, -2. */
export function joinPlanes(planes, width, count) {
  const values = new Float64Array(count);
  const none = new Uint8Array(count);
  const plane = (k) => (k < width ? planes.subarray(k * count, (k + 1) * count) : none);
  const [p0, p1, p2] = [plane(0), plane(1), plane(2)];
  for (let i = 0; i < count; ++i) {
    const low = p0[i] | (p1[i] << 8) | (p2[i] << 16);
    values[i] = (low >>> 1) ^ -(low & 1);
  }
  for (let k = 3; k < width; ++k) addPlane(values, plane(k), p0, 2 ** (8 * k - 1));
  return values;
}

/** Adds a higher plane, which is zero nearly everywhere; the lowest bit of all is the sign. */
function addPlane(values, plane, lowest, factor) {
  for (let i = 0; i < plane.length; ++i)
    if (plane[i] !== 0) values[i] += (lowest[i] & 1 ? -factor : factor) * plane[i];
}

/** Sums up in place, once for each seed: the last seed begins the last sum to be undone. */
export function integrate(values, seeds) {
  for (let order = seeds.length - 1; order >= 0; --order) {
    let sum = seeds[order];
    for (let i = order; i < values.length; ++i) {
      if (i > order) sum += values[i];
      values[i] = sum;
    }
  }
  return values;
}

/** The samples of one packed column; a missing sample is NaN. */
export async function unpack(packed) {
  const values = joinPlanes(await inflate(packed.planes), packed.width, packed.count);
  integrate(values, packed.seeds);
  if (packed.scale !== 1) for (let i = 0; i < values.length; ++i) values[i] *= packed.scale;
  for (const [first, count] of packed.missing) values.fill(NaN, first, first + count);
  return values;
}
