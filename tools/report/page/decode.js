// Undoes runtime/trace/packing.cpp: base64, deflate, byte planes, outliers, zigzag, differences, scale.

const outlierWidth = 7;

async function inflate(base64) {
  const letters = atob(base64);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
  const plain = new Response(bytes).body.pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/** The whole numbers behind `width` byte planes, lowest byte first. */
export function joinPlanes(planes, width, count) {
  const values = new Float64Array(count);
  for (let k = 0; k < width; ++k) {
    const plane = planes.subarray(k * count, (k + 1) * count);
    const factor = 256 ** k;
    for (let i = 0; i < count; ++i) values[i] += factor * plane[i];
  }
  return values;
}

/** Puts in their places what needs more bytes than the rest. */
export function placeOutliers(values, planes, outliers) {
  const gaps = joinPlanes(planes, outlierWidth, outliers);
  const wide = joinPlanes(planes.subarray(outlierWidth * outliers), outlierWidth, outliers);
  let place = 0;
  for (let k = 0; k < outliers; ++k) values[place += gaps[k]] = wide[k];
}

/** Undoes zigzag (0, 1, 2, 3 stand for 0, -1, 1, -2) and differences of an order up to 3, in place. */
export function integrate(values, order, scale) {
  let [first, second, third] = [0, 0, 0];
  for (let i = 0; i < values.length; ++i) {
    const half = Math.floor(values[i] / 2);
    let value = half * 2 === values[i] ? half : -1 - half;
    if (order > 2) value = third += value;
    if (order > 1) value = second += value;
    if (order > 0) value = first += value;
    values[i] = value * scale;
  }
}

/** The samples of one packed column; a missing sample is NaN. */
export async function unpack({ count, scale, order, width, outliers, missing, planes }) {
  const bytes = await inflate(planes);
  const values = joinPlanes(bytes, width, count);
  placeOutliers(values, bytes.subarray(width * count), outliers);
  integrate(values, order, scale);
  for (const [first, length] of missing) values.fill(NaN, first, first + length);
  return values;
}
