import { seen, slicedTimes, slicedValues, slices } from "#page/samples";

const slicesAcross = 1200; // two points each: more than a plot has pixels on most screens

/**
 * What all plots of a page share: the stretch of time that is seen, the two measuring cursors, and
 * the time under the mouse. Listeners are called with what has changed: "range", "cursors", "hover"
 * or "theme".
 */
export class View {
  #listeners = [];
  #slices = new Map();

  constructor(from, to) {
    this.whole = { from, to };
    this.range = { from, to };
    this.cursors = [from + (to - from) / 3, from + ((to - from) * 2) / 3];
    this.hover = null;
  }

  /** Returns what ends it. */
  listen(listener) {
    this.#listeners.push(listener);
    return () => { this.#listeners = this.#listeners.filter((each) => each !== listener); };
  }

  tell(change) {
    for (const listener of this.#listeners) listener(change);
  }

  /** Shows a stretch of time, as much of it as there is. */
  show(from, to) {
    const whole = this.whole.to - this.whole.from;
    const length = Math.min(Math.max(to - from, whole * 1e-9), whole);
    const begin = Math.min(Math.max(from, this.whole.from), this.whole.to - length);
    this.range = { from: begin, to: begin + length };
    this.#slices.clear();
    this.tell("range");
  }

  reset() {
    this.show(this.whole.from, this.whole.to);
  }

  /** Zooms about a time that keeps its place; a factor below 1 shows less. */
  zoom(about, factor) {
    const { from, to } = this.range;
    this.show(about - (about - from) * factor, about + (to - about) * factor);
  }

  /** The times at which a run is drawn: the ends of slices of what is seen of it. */
  slicedTimes(run) {
    return this.#slicesOf(run).times;
  }

  /** What is drawn of a run's samples at these times. */
  slicedValues(run, samples) {
    const { borders, columns } = this.#slicesOf(run);
    if (!columns.has(samples)) columns.set(samples, slicedValues(samples, borders));
    return columns.get(samples);
  }

  #slicesOf({ times }) {
    if (!this.#slices.has(times)) {
      const borders = slices(...seen(times, this.range), slicesAcross);
      this.#slices.set(times, { borders, times: slicedTimes(times, borders), columns: new Map() });
    }
    return this.#slices.get(times);
  }

  setCursor(index, time) {
    this.cursors[index] = Math.min(Math.max(time, this.whole.from), this.whole.to);
    this.tell("cursors");
  }

  /** Brings the cursors to where they can be seen. */
  gatherCursors() {
    const { from, to } = this.range;
    this.cursors = [from + (to - from) / 3, from + ((to - from) * 2) / 3];
    this.tell("cursors");
  }

  setHover(time) {
    this.hover = time;
    this.tell("hover");
  }
}
