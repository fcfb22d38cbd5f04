import { afterwards, element, nextFrame, row, stroke } from "#page/dom";
import { number, sample } from "#page/format";
import { lastAtOrBefore } from "#page/samples";

const heads = ["", "here", "A", "B", "B − A"];

/**
 * Names of a plot's curves, and their values under the mouse, at both cursors, and the difference. A
 * name hides its curve, and is dragged to another plot; a <button> could not be dragged in all browsers.
 */
export class Legend {
  constructor(parent, plot) {
    this.plot = plot;
    this.curves = plot.curves;
    this.view = plot.view;
    this.several = new Set(this.curves.map(({ run }) => run)).size > 1;
    this.canMove = Boolean(plot.arranged) && !plot.arranged.isFixed;
    this.rows = this.curves.map((curve) => this.#row(curve));
    const head = element("tr", {}, ...[...heads, ...(this.canMove ? [""] : [])].map((title) => element("th", {}, title)));
    parent.append(element("table", { className: "legend" }, element("thead", {}, head),
                          element("tbody", {}, ...this.rows)));
    this.update = this.update.bind(this);
    this.write = nextFrame(() => this.#write());
    afterwards(() => this.#write())();
  }

  update(change) {
    if (change === "cursors" || change === "hover") this.write();
  }

  #row(curve) {
    const { signal, run } = curve;
    const made = row("", "", "", "", "");
    const name = element("span", { className: "curve", role: "button", tabIndex: 0, draggable: this.canMove,
                                   title: `Show or hide ${signal.name} of ${run.label}` },
                         stroke(curve.stroke, curve.dash), this.#nameOf(curve));
    const show = () => {
      name.ariaPressed = String(!curve.hidden);
      made.classList.toggle("hidden-curve", curve.hidden);
    };
    name.onclick = () => {
      this.plot.toggle(curve);
      show();
    };
    name.onkeydown = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      name.click();
    };
    name.ondragstart = (event) => event.dataTransfer.setData("text/plain", signal.name);
    show();
    made.cells[0].append(name);
    heads.forEach((head, k) => { if (head) made.cells[k].dataset.head = head; });
    if (this.canMove) made.append(element("td", {}, this.#mover(signal)));
    return made;
  }

  #nameOf({ signal, run }) {
    const more = [signal.formula && `= ${signal.formula}`, this.several && run.label].filter(Boolean);
    return element("span", { className: "text" }, element("span", { className: "name" }, signal.name),
                   ...more.map((text) => element("span", { className: "of" }, ` ${text}`)));
  }

  /** Where the signal may go, for who does not drag; listed when it is wanted. */
  #mover(signal) {
    const select = element("select", { className: "mover", title: `Move ${signal.name}` }, element("option", {}, "⋮"));
    select.ariaLabel = `Move ${signal.name}`;
    select.dataset.signal = signal.name;
    let choices = [];
    select.onfocus = select.onpointerdown = () => {
      if (choices.length > 0) return;
      choices = this.#choices(signal);
      select.append(...choices.map(([text]) => element("option", {}, text)));
    };
    select.onchange = () => choices[select.selectedIndex - 1]?.[1]();
    return select;
  }

  #choices({ name, formula }) {
    const { arranged, index } = this.plot;
    const own = arranged.hasOwnAxis(name);
    const plots = arranged.plots.map((_, k) => [`to plot ${k + 1}`, () => arranged.move(name, k)]);
    return [...plots.filter((_, k) => k !== index),
            ["to a new plot", () => arranged.move(name, plots.length)],
            [own ? "to the shared axis" : "to an axis of its own", () => arranged.setOwnAxis(name, !own)],
            ...(formula ? [["remove", () => arranged.removeCurve(name)]] : [])];
  }

  #write() {
    this.curves.forEach(({ run, signal }, index) => {
      const indexAt = (time) => (time === null ? -1 : lastAtOrBefore(run.times, time));
      const valueAt = (index) => (index < 0 ? NaN : signal.values.at(index));
      const textAt = (index) => signal.values.textAt?.(index) ?? sample(signal, valueAt(index));
      const [here, a, b] = [this.view.hover, ...this.view.cursors].map(indexAt);
      const differs = signal.type === "real" || signal.type === "integer";
      const texts = [...[here, a, b].map(textAt),
                     differs ? sample({ unit: signal.unit }, valueAt(b) - valueAt(a)) : ""];
      texts.forEach((text, k) => { this.rows[index].cells[k + 1].textContent = text; });
    });
  }
}
