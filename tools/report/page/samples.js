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
 * Of each chunk of a block that has been asked for them, the extremes are kept.
 */
export class Blocks {
  static size = 1024;
  static chunk = 256;
  #block = { first: -Blocks.size, values: new Float64Array(Blocks.size) };
  #extremes;
  #known;

  constructor(length) {
    this.length = length;
    this.forget();
  }

  /** What has been read is no longer so. */
  forget() {
    const chunks = Math.ceil(this.length / Blocks.chunk);
    this.#block.first = -Blocks.size;
    this.#extremes = new Float64Array(2 * chunks);
    this.#known = new Uint8Array(chunks);
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

  /** Of the numbers [first, end). */
  extremes(first, end) {
    const found = new Extremes();
    for (let begin = first; begin < end; ) {
      const chunk = Math.floor(begin / Blocks.chunk);
      const next = Math.min((chunk + 1) * Blocks.chunk, end);
      if (next - begin === Blocks.chunk) found.add(this.#extremesOf(chunk), 2 * chunk, 2 * chunk + 2);
      else this.#add(found, begin, next);
      begin = next;
    }
    return found;
  }

  #add(found, first, end) {
    const block = this.block(first);
    found.add(block.values, first - block.first, end - block.first);
  }

  /** Those of all chunks, of which at least this one is known. */
  #extremesOf(chunk) {
    if (!this.#known[chunk]) {
      const found = new Extremes();
      this.#add(found, chunk * Blocks.chunk, (chunk + 1) * Blocks.chunk);
      this.#extremes[2 * chunk] = found.former;
      this.#extremes[2 * chunk + 1] = found.latter;
      this.#known[chunk] = 1;
    }
    return this.#extremes;
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
