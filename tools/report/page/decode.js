// Undoes tools/lineshaft/packing.cpp: base64, deflate, outliers, differences, scale.
import { Blocks } from "#page/samples";

const nanoseconds = 1e9; // in a second

const bytesOf = (base64) =>
  Uint8Array.fromBase64?.(base64) ?? Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

async function inflate(base64) {
  const inflater = new DecompressionStream("deflate");
  const plain = new Response(inflater.readable).arrayBuffer();
  const writer = inflater.writable.getWriter();
  await Promise.all([writer.write(bytesOf(base64)), writer.close()]);
  return new Uint8Array(await plain);
}

/** Numbers of `width` bytes whose bytes of one significance stand side by side, the lowest first. */
function joinPlanes(bytes, width) {
  if (width === 1) return bytes.slice().buffer;
  const count = bytes.length / width;
  const joined = new Uint8Array(bytes.length);
  for (let k = 0; k < width; ++k)
    for (let i = 0; i < count; ++i) joined[width * i + k] = bytes[k * count + i];
  return joined.buffer;
}

const wholeNumbers = { 1: Int8Array, 2: Int16Array, 4: Int32Array };

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

/**
 * The samples of one packed column; a missing sample is NaN. They stay packed but for one block:
 * a browser takes several times as long to get new memory than to unpack what goes into it.
 */
class Samples extends Blocks {
  /** Before each block, as far as it is known: sums, the next outlier, the next missing stretch. */
  #states = [{ sums: [0, 0, 0], outlier: 0, missing: 0 }];

  #packedExtremes;

  /** Of `packed` inflated to `bytes`; `divisor` for what is no whole number times a scale. */
  constructor(packed, bytes, divisor, packedExtremes) {
    super(packed.count);
    this.#packedExtremes = packedExtremes;
    const { width, outliers } = packed;
    this.packed = packed;
    this.divisor = divisor;
    this.outliers = new Float64Array(joinPlanes(bytes.subarray(0, 8 * outliers), 8));
    this.places = new Uint32Array(joinPlanes(bytes.subarray(8 * outliers, 12 * outliers), 4));
    for (let k = 1; k < outliers; ++k) this.places[k] += this.places[k - 1];
    this.differences = width > 0 ? new wholeNumbers[width](joinPlanes(bytes.subarray(12 * outliers), width)) : null;
  }

  read(first, values) {
    const index = first / Blocks.size;
    while (this.#states.length <= index) this.#unpack(this.#states.length - 1, values);
    this.#unpack(index, values);
  }

  /** As the page has them: of all chunks the former one, then of all the latter one. */
  chunkExtremes() {
    const packed = this.#packedExtremes;
    if (!packed) return super.chunkExtremes();
    const values = packed.every(1, 0, packed.length);
    const chunks = new Float64Array(values.length);
    const count = values.length / 2;
    for (let k = 0; k < count; ++k) {
      chunks[2 * k] = values[k];
      chunks[2 * k + 1] = values[count + k];
    }
    return chunks;
  }

  #unpack(index, block) {
    const first = index * Blocks.size;
    const values = block.subarray(0, this.length - first);
    if (this.differences) values.set(this.differences.subarray(first, first + values.length));
    else values.fill(0);
    const state = this.#states[index];
    const outlier = this.#placeOutliers(state.outlier, first, values);
    const sums = integrate(values, this.packed, state.sums);
    if (this.divisor !== 1) for (let i = 0; i < values.length; ++i) values[i] /= this.divisor;
    const missing = this.#forget(state.missing, first, values);
    this.#states[index + 1] ??= { sums, outlier, missing };
  }

  /** What a sample is that is drawn as missing but is not: "INF", "-INF" or "NaN". */
  textAt(index) {
    const found = this.packed.not_finite?.find(([first, count]) => index >= first && index < first + count);
    return found?.[2];
  }

  /** From outlier `k` on; returns the first behind the block. */
  #placeOutliers(k, first, values) {
    for (; this.places[k] < first + values.length; ++k) values[this.places[k] - first] = this.outliers[k];
    return k;
  }

  /** From the missing stretch `k` on; returns the first that ends behind the block. */
  #forget(k, first, values) {
    for (const { missing } = this.packed; k < missing.length; ++k) {
      const [begin, end] = [missing[k][0] - first, missing[k][0] + missing[k][1] - first];
      if (begin < values.length) values.fill(NaN, Math.max(begin, 0), end);
      if (end > values.length) break;
    }
    return k;
  }
}

/** Times [s] and values of a run's signals. */
export async function unpack(run) {
  const bytes = await inflate(run.bytes);
  let at = 0;
  const next = (packed, divisor = 1) => {
    const own = bytes.subarray(at, (at += 12 * packed.outliers + packed.width * packed.count));
    return new Samples(packed, own, divisor, packed.extremes && next(packed.extremes));
  };
  return { times: next(run.time, nanoseconds), values: run.signals.map(({ data }) => next(data)) };
}
