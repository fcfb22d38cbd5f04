/** When a condition begins to hold, of one sample and the one before. */
const begins = {
  rising: (last, now) => last === 0 && now === 1,
  falling: (last, now) => last === 1 && now === 0,
  above: (last, now, level) => !(last > level) && now > level,
  below: (last, now, level) => !(last < level) && now < level,
  equals: (last, now, level) => last !== level && now === level,
};

/** The conditions that a signal of this type can have, as a program's trace has them. */
export const conditions = (type) =>
  ({ boolean: ["rising", "falling"], enumeration: ["equals"] })[type] ?? ["above", "below", "equals"];

/**
 * Waits for a condition of a signal, and for as long after it as is to be shown: `state` is "off",
 * "armed", "triggered" or "hold". Looks at samples as they come.
 */
export class Trigger {
  state = "off";
  time = null; // when the condition began to hold [s]
  #last = NaN;

  arm({ signal, condition, level, before, after }) {
    Object.assign(this, { signal, condition, level, before, after, state: "armed", time: null });
    this.#last = NaN;
  }

  disarm() {
    this.state = "off";
  }

  /** Stretch of time that is shown when all of it has come [s]. */
  get range() {
    return [this.time - this.before, this.time + this.after];
  }

  /** True when a sample is the last one of what is to be shown. */
  look(time, value) {
    if (this.state === "armed" && !Number.isNaN(this.#last) &&
        begins[this.condition](this.#last, value, this.level))
      Object.assign(this, { state: "triggered", time });
    this.#last = value;
    if (this.state !== "triggered" || time < this.time + this.after) return false;
    this.state = "hold";
    return true;
  }
}
