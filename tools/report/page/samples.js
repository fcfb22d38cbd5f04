/** The least and the greatest of numbers one after another. */
class Extremes {
  low = Infinity;
  high = -Infinity;
  rises = true;

  add(values, first, end) {
    let low = this.low;
    let high = this.high;
    let rises = this.rises;
    for (let i = first; i < end; ++i) {
      const value = values[i];
      if (value < low) {
        low = value;
        rises = false;
      }
      if (value > high) {
        high = value;
        rises = true;
      }
    }
    this.low = low;
    this.high = high;
    this.rises = rises;
  }

  /** The one that came first; NaN if all numbers are missing. */
  get former() {
    return this.low > this.high ? NaN : this.rises ? this.low : this.high;
  }

  get latter() {
    return this.low > this.high ? NaN : this.rises ? this.high : this.low;
  }
}

/**
 * Numbers that are read by `at` as an array's are, but are worked out when they are asked for, a
 * block at a time, by a derived class's `read(first, values)`: `values` are those from `first` on.
 * The extremes of all chunks are worked out once, unless the derived class knows them.
 */
export class Blocks {
  static size = 1024;
  static chunk = 256; // as tools/lineshaft/packing.hpp has it
  #block = { first: -Blocks.size, values: new Float64Array(Blocks.size) };
  #chunks = null;

  constructor(length) {
    this.length = length;
  }

  /** What has been read is no longer so. */
  forget() {
    this.#block.first = -Blocks.size;
    this.#chunks = null;
  }

  at(index) {
    const block = this.block(index);
    return block.values[index - block.first];
  }

  /** The block that a number lies in, until another one is asked for. */
  block(index) {
    const block = this.#block;
    if (index < block.first || index >= block.first + Blocks.size) {
      block.first = index - (index % Blocks.size);
      this.read(block.first, block.values);
    }
    return block;
  }

  /** `count` of the numbers, from one on every so many. */
  every(step, first, count) {
    const result = new Float64Array(count);
    for (let k = 0, i = first; k < count; ) {
      const { first: start, values } = this.block(i);
      for (; k < count && i < start + Blocks.size; ++k, i += step) result[k] = values[i - start];
    }
    return result;
  }

  /** Of the numbers [first, end), of which whole chunks are not read. */
  extremes(first, end) {
    const found = new Extremes();
    const begin = Math.ceil(first / Blocks.chunk);
    const behind = end === this.length ? Math.ceil(end / Blocks.chunk) : Math.floor(end / Blocks.chunk);
    if (begin >= behind) return this.#add(found, first, end);
    this.#add(found, first, begin * Blocks.chunk);
    this.#chunks ??= this.chunkExtremes();
    found.add(this.#chunks, 2 * begin, 2 * behind);
    return this.#add(found, behind * Blocks.chunk, end);
  }

  /** Two of each chunk, in the order in which they come. */
  chunkExtremes() {
    const chunks = new Float64Array(2 * Math.ceil(this.length / Blocks.chunk));
    for (let k = 0, first = 0; first < this.length; first += Blocks.chunk) {
      const { former, latter } =
        this.#add(new Extremes(), first, Math.min(first + Blocks.chunk, this.length));
      chunks[k++] = former;
      chunks[k++] = latter;
    }
    return chunks;
  }

  #add(found, first, end) {
    for (let i = first; i < end; ) {
      const block = this.block(i);
      const next = Math.min(block.first + Blocks.size, end);
      found.add(block.values, i - block.first, next - block.first);
      i = next;
    }
    return found;
  }
}

/** The index of the first of the rising `times` that is not below `time`; their number if none. */
export function firstAtOrAfter(times, time) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (times.at(middle) < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The index of the last of the rising `times` that is not above `time`; -1 if none. */
export function lastAtOrBefore(times, time) {
  const index = firstAtOrAfter(times, time);
  return index < times.length && times.at(index) === time ? index : index - 1;
}

/** The samples seen in a view, with one neighbour on either side: [first, end). */
export function seen(times, view) {
  const first = Math.max(0, firstAtOrAfter(times, view.from) - 1);
  const end = Math.min(times.length, lastAtOrBefore(times, view.to) + 2);
  return [first, Math.max(first, end)];
}

/**
 * `count` slices of [first, end) as their borders; a slice a sample if there are few samples, whole
 * chunks if there are many.
 */
export function slices(first, end, count) {
  const many = Math.min(count, end - first);
  const grain = end - first >= 2 * Blocks.chunk * many ? Blocks.chunk : 1;
  const border = (k) => Math.floor((first + (k * (end - first)) / many) / grain) * grain;
  return Array.from({ length: many + 1 }, (_, k) => (k === 0 ? first : k === many ? end : border(k)));
}

/** Two times a slice: its first and its last sample's; one where a slice is a sample. */
export function slicedTimes(times, borders) {
  const result = [];
  for (let k = 0; k + 1 < borders.length; ++k) {
    result.push(times.at(borders[k]));
    if (borders[k + 1] - borders[k] > 1) result.push(times.at(borders[k + 1] - 1));
  }
  return result;
}

/** Two values a slice, its extremes, so that no peak is lost however narrow it is; as slicedTimes. */
export function slicedValues(samples, borders) {
  const result = [];
  for (let k = 0; k + 1 < borders.length; ++k) {
    const { former, latter } = samples.extremes(borders[k], borders[k + 1]);
    result.push(Number.isNaN(former) ? null : former);
    if (borders[k + 1] - borders[k] > 1) result.push(Number.isNaN(latter) ? null : latter);
  }
  return result;
}
