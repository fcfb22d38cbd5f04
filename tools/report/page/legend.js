import { afterwards, dashes, element, nextFrame, palette, row } from "#page/dom";
import { number, sample } from "#page/format";
import { lastAtOrBefore } from "#page/samples";

/** A stroke as the curve has it. */
function swatch(lane, run) {
  const line = `<line x1="0" y1="5" x2="22" y2="5" stroke="${palette(lane)}" stroke-width="2"
    stroke-dasharray="${dashes(run).join(" ")}"/>`;
  return element("span", { className: "swatch",
                           innerHTML: `<svg width="22" height="10">${line}</svg>` });
}

/** Names of a plot's curves, and their values under the mouse, at both cursors, and the difference. */
export class Legend {
  constructor(parent, curves, view) {
    this.curves = curves;
    this.view = view;
    this.rows = curves.map((curve) => this.#row(curve));
    const head = element("tr", {}, ...["", "here", "A", "B", "B − A"].map((title) =>
      element("th", {}, title)));
    parent.append(element("table", { className: "legend" }, element("thead", {}, head),
                          element("tbody", {}, ...this.rows)));
    this.update = this.update.bind(this);
    this.write = nextFrame(() => this.#write());
    afterwards(() => this.#write())();
  }

  update(change) {
    if (change === "theme") this.#recolour();
    if (change === "cursors" || change === "hover") this.write();
  }

  #row({ run, signal, lane }) {
    const made = row("", "", "", "", "");
    made.cells[0].append(swatch(lane, run.index), signal.name);
    made.cells[0].title = `${signal.name} of ${run.label}`;
    return made;
  }

  #recolour() {
    this.curves.forEach(({ run, lane }, index) =>
      this.rows[index].querySelector(".swatch").replaceWith(swatch(lane, run.index)));
  }

  #write() {
    this.curves.forEach(({ run, signal }, index) => {
      const valueAt = (time) => {
        const at = time === null ? -1 : lastAtOrBefore(run.times, time);
        return at < 0 ? NaN : signal.values.at(at);
      };
      const [here, a, b] = [this.view.hover, ...this.view.cursors].map(valueAt);
      const differs = signal.type === "real" || signal.type === "integer";
      const texts = [...[here, a, b].map((value) => sample(signal, value)),
                     differs ? number(b - a) : ""];
      texts.forEach((text, k) => { this.rows[index].cells[k + 1].textContent = text; });
    });
  }
}
