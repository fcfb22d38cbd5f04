/** The index of the first of the rising `times` that is not below `time`; their number if none. */
export function firstAtOrAfter(times, time) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The index of the last of the rising `times` that is not above `time`; -1 if none. */
export function lastAtOrBefore(times, time) {
  const index = firstAtOrAfter(times, time);
  return index < times.length && times[index] === time ? index : index - 1;
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
    result.push(times[borders[k]]);
    if (borders[k + 1] - borders[k] > 1) result.push(times[borders[k + 1] - 1]);
  }
  return result;
}

/**
 * The least and the greatest sample of each slice, in their order, so that no peak is lost however
 * narrow it is; null where all are missing.
 */
export function slicedValues(values, borders) {
  const result = [];
  for (let k = 0; k + 1 < borders.length; ++k) {
    const [first, end] = [borders[k], borders[k + 1]];
    let least = first;
    let greatest = first;
    for (let i = first; i < end; ++i) {
      const value = values[i];
      if (!(value >= values[least])) least = value === value ? i : least;
      if (!(value <= values[greatest])) greatest = value === value ? i : greatest;
    }
    const drawn = (i) => (Number.isNaN(values[i]) ? null : values[i]);
    result.push(drawn(Math.min(least, greatest)));
    if (end - first > 1) result.push(drawn(Math.max(least, greatest)));
  }
  return result;
}
