import { Ring } from "#live/ring";
import { Trigger } from "#live/trigger";
import { element, nextFrame } from "#page/dom";
import { groups, Plot } from "#page/plot";
import { View } from "#page/view";

const mostSamples = 2 ** 23; // that are kept of all signals: 64 MB
const most = 2 ** 19; // of one: nearly nine minutes of 1 kHz
const seconds = 20; // that are drawn while time goes on

/** The plots of the signals that come in a stream. */
export class Scope {
  #run = null;
  #view = null;
  #plots = [];
  #draws = false;
  #redraw = nextFrame(() => this.#draw());
  trigger = new Trigger();
  held = false;

  /** `changed` is called when it holds or follows, and when cursors or the trigger change. */
  constructor(parent, changed) {
    this.parent = parent;
    this.changed = changed;
    new ResizeObserver(nextFrame(() => this.#plots.forEach((plot) => plot.resize()))).observe(parent);
  }

  get signals() {
    return this.#run?.signals ?? [];
  }

  get cursors() {
    return this.#view?.cursors;
  }

  /** Begins anew unless the signals are those that are drawn: then what comes is what follows. */
  begin(signals) {
    const names = (list) => list.map(({ name }) => name).join();
    if (this.#run && names(this.#run.signals) === names(signals)) return;
    const room = Math.min(most, Math.floor(mostSamples / (signals.length + 1)));
    this.#run = { index: 0, label: "the machine", times: new Ring(room), expectations: [],
                  signals: signals.map((signal) => ({ ...signal, values: new Ring(room) })) };
    this.#view = new View(0, 1);
    this.#view.listen((change) => this.#viewChanged(change));
    this.parent.replaceChildren();
    this.#plots = groups([this.#run]).map((group) => new Plot(this.parent, group, this.#view));
    const width = this.#plots[0]?.chart.clientWidth;
    for (const plot of this.#plots) plot.draw(width);
    this.trigger.disarm();
    this.hold(false);
  }

  add({ time, values }) {
    if (this.#run.times.length > 0 && time[0] < this.#run.times.at(this.#run.times.length - 1)) this.#forgetAll();
    const { times, signals } = this.#run;
    const watched = signals.findIndex(({ name }) => name === this.trigger.signal);
    time.forEach((each, i) => {
      times.push(each);
      signals.forEach((signal, k) => signal.values.push(values[k][i] === null ? NaN : Number(values[k][i])));
      if (watched >= 0 && this.trigger.look(each, Number(values[watched][i]))) this.#triggered();
    });
    if (!this.held) this.#redraw();
  }

  arm(settings) {
    this.trigger.arm(settings);
    this.hold(false);
  }

  hold(held) {
    this.held = held;
    this.changed();
    if (!held) this.#redraw();
  }

  changeTheme() {
    this.#view?.tell("theme");
  }

  /** What is kept, as a trace is written. */
  csv() {
    const { times, signals } = this.#run;
    this.#refresh();
    const lines = [["time", ...signals.map(({ name }) => name)].join()];
    for (let i = 0; i < times.length; ++i)
      lines.push([times.at(i), ...signals.map(({ values }) => values.at(i))].join());
    return `${lines.join("\n").replaceAll("NaN", "")}\n`;
  }

  /** Another machine is there, whose time has begun anew. */
  #forgetAll() {
    const signals = this.#run.signals.map(({ values, ...signal }) => signal);
    this.#run = null;
    this.begin(signals);
  }

  /** Whoever looks at another stretch than the last seconds wants it to stay. */
  #viewChanged(change) {
    if (change === "range" && !this.#draws) {
      this.#refresh();
      this.hold(true);
    }
    if (change === "cursors") this.changed();
  }

  #triggered() {
    this.#refresh();
    this.hold(true);
    this.#show(...this.trigger.range);
    this.#view.setCursor(0, this.trigger.time);
    this.#view.setCursor(1, this.trigger.range[1]);
  }

  /** What was read of the rings before may be gone. */
  #refresh() {
    const { times, signals } = this.#run;
    for (const column of [times, ...signals.map(({ values }) => values)]) column.forget();
    this.#view.whole = { from: times.at(0), to: times.at(times.length - 1) };
  }

  #show(from, to) {
    this.#draws = true;
    this.#view.show(from, to);
    this.#draws = false;
  }

  #draw() {
    const { times } = this.#run;
    if (times.length < 2 || this.held) return;
    this.#refresh();
    const { from, to } = this.#view.whole;
    this.#show(Math.max(from, to - seconds), to);
  }
}

export const download = (name, text) => {
  const link = element("a", { href: URL.createObjectURL(new Blob([text])), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
};
