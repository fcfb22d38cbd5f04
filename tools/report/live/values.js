import { get } from "#live/api";
import { number, withUnit } from "#page/format";

const pause = 500; // ms
const mostCharacters = 6000; // of names, for the address of a request

/** The values of the signals in the table that can be seen, asked for now and then. */
export class Values {
  #rows;
  #scroll;

  /** `rows`: by name, each with its `made` row, its `value` cell and its `signal`. */
  constructor(rows, scroll) {
    this.#rows = rows;
    this.#scroll = scroll;
    this.#update();
  }

  #seen() {
    const { top, bottom } = this.#scroll.getBoundingClientRect();
    let characters = 0;
    return [...this.#rows].filter(([name, { made }]) => {
      if (made.hidden) return false;
      const place = made.getBoundingClientRect();
      if (place.bottom < top || place.top > bottom) return false;
      return (characters += encodeURIComponent(name).length + 3) < mostCharacters;
    }).map(([name]) => name);
  }

  async #update() {
    try {
      const names = document.hidden ? [] : this.#seen();
      if (names.length > 0) {
        const { values } = await get(`values?signals=${encodeURIComponent(names.join())}`);
        for (const name of names) this.#show(name, values[name]);
      }
    } catch {
      // the stream tells that the machine has gone
    }
    setTimeout(() => this.#update(), pause);
  }

  #show(name, value) {
    const { value: cell, signal } = this.#rows.get(name);
    const text = typeof value === "number" ? withUnit(number(value), signal.unit) : String(value ?? "–");
    if (cell.textContent !== text) cell.textContent = text;
  }
}
