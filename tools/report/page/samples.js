/**
 * Numbers that are read by `at` as an array's are, but are worked out when they are asked for, a
 * block at a time, by a derived class's `read(first, values)`: `values` are those from `first` on.
 */
export class Blocks {
  static size = 1024;
  #block = { first: -Blocks.size, values: new Float64Array(Blocks.size) };

  constructor(length) {
    this.length = length;
  }

  /** What has been read is no longer so. */
  forget() {
    this.#block.first = -Blocks.size;
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

/** `count` slices of [first, end) as their borders; a slice a sample if there are few samples. */
export function slices(first, end, count) {
  const many = Math.min(count, end - first);
  return Array.from({ length: many + 1 }, (_, k) => first + Math.floor((k * (end - first)) / many));
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

/** The least and the greatest of the samples [first, end), in their order; null if all are missing. */
function extremes(samples, first, end) {
  let low = Infinity;
  let high = -Infinity;
  let rises = true;
  for (let begin = first; begin < end; begin = (Math.floor(begin / Blocks.size) + 1) * Blocks.size) {
    const block = samples.block(begin);
    const { values } = block;
    const behind = Math.min(end - block.first, values.length);
    for (let i = begin - block.first; i < behind; ++i) {
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
  }
  const none = low > high;
  return [none ? null : rises ? low : high, none ? null : rises ? high : low];
}

/** Two values a slice, its extremes, so that no peak is lost however narrow it is; as slicedTimes. */
export function slicedValues(samples, borders) {
  const result = [];
  for (let k = 0; k + 1 < borders.length; ++k) {
    const [one, other] = extremes(samples, borders[k], borders[k + 1]);
    result.push(one);
    if (borders[k + 1] - borders[k] > 1) result.push(other);
  }
  return result;
}
