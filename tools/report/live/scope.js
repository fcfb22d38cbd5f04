import { Ring } from "#live/ring";
import { element, nextFrame } from "#page/dom";
import { groups, Plot } from "#page/plot";
import { View } from "#page/view";

const room = 65536; // samples that are kept of a signal
const seconds = 60; // that are drawn while time goes on

/** The plots of the signals that come in a stream. */
export class Scope {
  #run = null;
  #view = null;
  #plots = [];
  held = false;

  constructor(parent) {
    this.parent = parent;
    this.#redraw = nextFrame(() => this.#draw());
    new ResizeObserver(nextFrame(() => this.#plots.forEach((plot) => plot.resize()))).observe(parent);
  }

  #redraw;

  /** Begins anew unless the signals are those that are drawn: then what comes is what follows. */
  begin(signals) {
    const names = (list) => list.map(({ name }) => name).join();
    if (this.#run && names(this.#run.signals) === names(signals)) return;
    this.#run = { index: 0, label: "the machine", times: new Ring(room), expectations: [],
                  signals: signals.map((signal) => ({ ...signal, values: new Ring(room) })) };
    this.#view = new View(0, 1);
    this.parent.replaceChildren();
    this.#plots = groups([this.#run]).map((group) => new Plot(this.parent, group, this.#view));
    const width = this.#plots[0]?.chart.clientWidth;
    for (const plot of this.#plots) plot.draw(width);
  }

  add({ time, values }) {
    const { times, signals } = this.#run;
    if (times.length > 0 && time[0] < times.at(times.length - 1)) return;
    for (const each of time) times.push(each);
    signals.forEach((signal, k) => {
      for (const value of values[k]) signal.values.push(value === null ? NaN : Number(value));
    });
    if (!this.held) this.#redraw();
  }

  hold(held) {
    this.held = held;
    if (!held) this.#redraw();
  }

  changeTheme() {
    this.#view?.tell("theme");
  }

  /** What is kept, as a trace is written. */
  csv() {
    const { times, signals } = this.#run;
    const lines = [["time", ...signals.map(({ name }) => name)].join()];
    for (let i = 0; i < times.length; ++i)
      lines.push([times.at(i), ...signals.map(({ values }) => values.at(i))].join());
    return `${lines.join("\n").replaceAll("NaN", "")}\n`;
  }

  #draw() {
    const { times, signals } = this.#run;
    if (times.length < 2) return;
    for (const column of [times, ...signals.map(({ values }) => values)]) column.forget();
    const end = times.at(times.length - 1);
    this.#view.whole = { from: times.at(0), to: end };
    this.#view.show(Math.max(times.at(0), end - seconds), end);
    performance.mark("lineshaft:range");
  }
}

export const download = (name, text) => {
  const link = element("a", { href: URL.createObjectURL(new Blob([text])), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
};
