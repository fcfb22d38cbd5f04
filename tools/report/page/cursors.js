import { element } from "#page/dom";
import { duration, frequency } from "#page/format";
import { firstAtOrAfter, lastAtOrBefore } from "#page/samples";

const names = ["A", "B"];

/** The two measuring cursors as lines over one plot, to be dragged or moved by the arrow keys. */
export class CursorLines {
  constructor(uplot, view, times) {
    this.uplot = uplot;
    this.view = view;
    this.times = times;
    this.lines = names.map((name, index) => this.#line(name, index));
    uplot.over.append(...this.lines);
    this.place();
  }

  place() {
    const { from, to } = this.view.range;
    this.lines.forEach((line, index) => {
      const time = this.view.cursors[index];
      line.hidden = time < from || time > to;
      line.style.transform = `translateX(${this.uplot.valToPos(time, "x")}px)`;
      line.ariaValueText = duration(time);
    });
  }

  #line(name, index) {
    const line = element("div", { className: `cursor cursor-${name}`, tabIndex: 0, role: "slider" },
                         element("span", {}, name));
    line.ariaLabel = `cursor ${name}`;
    for (const event of ["mousedown", "click"])
      line.addEventListener(event, (e) => e.stopPropagation());
    line.addEventListener("pointerdown", (e) => line.setPointerCapture(e.pointerId));
    line.addEventListener("pointermove", (e) => {
      if (line.hasPointerCapture(e.pointerId)) this.view.setCursor(index, this.#timeAt(e));
    });
    line.addEventListener("keydown", (e) => this.#step(e, index));
    return line;
  }

  #timeAt(event) {
    return this.uplot.posToVal(event.clientX - this.uplot.over.getBoundingClientRect().left, "x");
  }

  #step(event, index) {
    const direction = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!direction) return;
    event.preventDefault();
    const time = this.view.cursors[index];
    const near = direction > 0 ? lastAtOrBefore(this.times, time) : firstAtOrAfter(this.times, time);
    const next = near + direction * (event.shiftKey ? 10 : 1);
    this.view.setCursor(index, this.times.at(Math.min(Math.max(next, 0), this.times.length - 1)));
  }
}

/** Times of the cursors and what lies between, in words. */
export function readout([a, b]) {
  const between = b - a;
  const rate = between === 0 ? "" : ` (${frequency(1 / Math.abs(between))})`;
  return `A ${duration(a)}   B ${duration(b)}   B − A ${duration(between)}${rate}`;
}
