// Undoes runtime/trace/packing.cpp: base64, deflate, byte planes, outliers, zigzag, differences, scale.
import { Blocks, firstAtOrAfter, lastAtOrBefore } from "#page/samples";

const bytesOf = (base64) =>
  Uint8Array.fromBase64?.(base64) ?? Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

async function inflate(base64) {
  const inflater = new DecompressionStream("deflate");
  const plain = new Response(inflater.readable).arrayBuffer();
  const writer = inflater.writable.getWriter();
  await Promise.all([writer.write(bytesOf(base64)), writer.close()]);
  return new Uint8Array(await plain);
}

const split = (bytes, width, count) =>
  Array.from({ length: width }, (_, k) => bytes.subarray(k * count, (k + 1) * count));

/** The whole numbers behind byte planes, lowest byte first. */
function joinPlanes(planes, count) {
  const values = new Float64Array(count);
  planes.forEach((plane, k) => {
    const factor = 256 ** k;
    for (let i = 0; i < count; ++i) values[i] += factor * plane[i];
  });
  return values;
}

/** Zigzag undone: 0, 1, 2, 3 stand for 0, -1, 1, -2. */
const signed = (value) => (value % 2 === 0 ? value / 2 : -(value + 1) / 2);

/** The same of the numbers behind up to four byte planes, from their index `first` on. */
function joinSigned(planes, first, values) {
  const [p0, p1, p2, p3] = planes;
  const width = planes.length;
  for (let i = 0, k = first; i < values.length; ++i, ++k) {
    let bits = p0[k];
    if (width > 1) bits |= p1[k] << 8;
    if (width > 2) bits |= p2[k] << 16;
    if (width > 3) bits |= p3[k] << 24;
    values[i] = (bits >>> 1) ^ -(bits & 1);
  }
}

/**
 * Undoes differences of an order up to 3 and the scale, in place. `sums` are those before the first
 * value; returns those behind the last.
 */
function integrate(values, { order, scale }, sums) {
  let first = sums[0];
  let second = sums[1];
  let third = sums[2];
  for (let i = 0; i < values.length; ++i) {
    let value = values[i];
    if (order > 2) value = third += value;
    if (order > 1) value = second += value;
    if (order > 0) value = first += value;
    values[i] = value * scale;
  }
  return [first, second, third];
}

/** Differences that take more bytes than the others: where they stand, and what they are. */
function unpackOutliers(bytes, width, count) {
  const places = joinPlanes(split(bytes, width, count), count);
  for (let k = 1; k < count; ++k) places[k] += places[k - 1];
  const planes = split(bytes.subarray(width * count), width, count);
  return { places, values: joinPlanes(planes, count).map(signed) };
}

/**
 * The samples of one packed column; a missing sample is NaN. They stay packed but for one block:
 * a browser takes several times as long to get new memory than to unpack what goes into it.
 */
class Samples extends Blocks {
  #sums = [[0, 0, 0]]; // before each block, as far as they are known

  /** Of `packed` with its planes inflated; `divisor` for what is no whole number times a scale. */
  constructor(packed, bytes, divisor) {
    super(packed.count);
    this.packed = packed;
    this.divisor = divisor;
    this.planes = split(bytes, packed.width, packed.count);
    this.outliers = unpackOutliers(bytes.subarray(packed.width * packed.count), packed.outlierWidth, packed.outliers);
    this.missing = packed.missing.map(([first]) => first);
  }

  read(first, values) {
    const index = first / Blocks.size;
    while (this.#sums.length <= index) this.#unpack(this.#sums.length - 1, values);
    this.#unpack(index, values);
  }

  #unpack(index, block) {
    const first = index * Blocks.size;
    const values = block.subarray(0, this.length - first);
    if (this.planes.length > 0) joinSigned(this.planes, first, values);
    else values.fill(0);
    this.#placeOutliers(first, values);
    this.#sums[index + 1] = integrate(values, this.packed, this.#sums[index]);
    if (this.divisor !== 1) for (let i = 0; i < values.length; ++i) values[i] /= this.divisor;
    this.#forget(first, values);
  }

  #placeOutliers(first, values) {
    const { places, values: wide } = this.outliers;
    for (let k = firstAtOrAfter(places, first); places[k] < first + values.length; ++k)
      values[places[k] - first] = wide[k];
  }

  #forget(first, values) {
    for (let k = Math.max(lastAtOrBefore(this.missing, first), 0); this.missing[k] < first + values.length; ++k) {
      const begin = this.missing[k] - first;
      values.fill(NaN, Math.max(begin, 0), Math.max(begin + this.packed.missing[k][1], 0));
    }
  }
}

export async function unpack(packed, divisor = 1) {
  return new Samples(packed, await inflate(packed.planes), divisor);
}
