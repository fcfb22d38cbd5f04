// Undoes runtime/trace/packing.cpp: base64, deflate, byte planes, zigzag, differences, scale.

async function inflate(base64) {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/** The whole numbers behind byte planes, lowest byte first: 0, 1, 2, 3 stand for 0, -1, 1, -2. */
export function joinPlanes(planes, width, count) {
  const values = new Float64Array(count);
  const plane = (k) => (k < width ? planes.subarray(k * count, (k + 1) * count) : undefined);
  const [p0, p1, p2, p3, p4, p5, p6] = [0, 1, 2, 3, 4, 5, 6].map(plane);
  for (let i = 0; i < count; ++i) {
    let low = p0 ? p0[i] : 0;
    if (p1) low |= p1[i] << 8;
    if (p2) low |= p2[i] << 16;
    let magnitude = low >>> 1;
    if (p3) magnitude += p3[i] * 2 ** 23;
    if (p4) magnitude += p4[i] * 2 ** 31;
    if (p5) magnitude += p5[i] * 2 ** 39;
    if (p6) magnitude += p6[i] * 2 ** 47;
    values[i] = low & 1 ? -magnitude - 1 : magnitude;
  }
  return values;
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
