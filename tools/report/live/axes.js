import { get } from "#live/api";
import { element, row } from "#page/dom";
import { number, withUnit } from "#page/format";

const isStateOfAxis = ({ name, names }) => name.endsWith(".state") && names?.includes("discrete_motion");

/** A table of the program's axes: what they do and where they are, asked for now and then. */
export class Axes {
  #axes;
  #signals;
  #asks = false;

  constructor(parent, signals) {
    this.table = parent.querySelector("table");
    this.#signals = new Map(signals.map((signal) => [signal.name, signal]));
    this.#axes = signals.filter(isStateOfAxis).map(({ name }) => name.slice(0, -".state".length));
    parent.hidden = this.#axes.length === 0;
  }

  async update() {
    if (this.#asks || this.#axes.length === 0) return;
    this.#asks = true;
    try {
      const names = this.#axes.flatMap((axis) => ["state", "position", "velocity", "error_id"].map((of) => `${axis}.${of}`));
      const { values } = await get(`values?signals=${encodeURIComponent(names.join())}`);
      this.#show(values);
    } catch {
      // the stream tells that the machine has gone
    } finally {
      this.#asks = false;
    }
  }

  #show(values) {
    const quantity = (name) => withUnit(number(values[name]), this.#signals.get(name).unit);
    const line = (axis) => {
      const error = values[`${axis}.error_id`];
      const made = row(axis, values[`${axis}.state`], quantity(`${axis}.position`), quantity(`${axis}.velocity`),
                       error === "none" ? "" : error);
      made.classList.toggle("bad", error !== "none");
      return made;
    };
    const head = ["axis", "state", "position", "velocity", "error"].map((title) => element("th", {}, title));
    this.table.replaceChildren(element("tr", {}, ...head), ...this.#axes.map(line));
  }
}
