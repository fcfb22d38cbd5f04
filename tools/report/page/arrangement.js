import { curveOf } from "#page/formula";
import { groups } from "#page/plot";

const keys = ["plots", "own_axis", "hide", "curves", "paths"];

/** `name` of one run of several, as an entry of `hide`. */
export const ofRun = (name, run) => `${name} of ${run.label}`;

/**
 * Which curves each plot has, and which are hidden or have an axis of their own: the keys that a
 * program's `report:` has. What is changed is kept in the page's address, so that a link or a
 * bookmark shows it again. Listeners are called when plots have to be made anew.
 */
export class Arrangement {
  #listeners = [];

  /** `said` is what the program says, `paths` are those that the report was made with. */
  constructor(runs, said, paths) {
    this.runs = runs;
    this.initial = { plots: [], own_axis: [], hide: [], curves: {}, ...said, paths };
    const kept = new URLSearchParams(location.hash.slice(1)).get("report");
    this.#take(kept ? { ...this.initial, ...this.#parsed(kept) } : this.initial);
  }

  listen(listener) {
    this.#listeners.push(listener);
  }

  /** Groups of curves, a plot each. */
  get plots() {
    const named = this.#state.plots.map((names) => this.#group(names)).filter(({ curves }) => curves.length > 0);
    const seen = new Set(this.#state.plots.flat());
    const rest = this.runs.map((run) => ({ ...run, signals: this.signalsOf(run).filter(({ name }) => !seen.has(name)) }));
    return [...named, ...groups(rest).map((group) => ({ ...group, curves: this.#own(group.curves) }))];
  }

  get paths() {
    return this.#state.paths;
  }

  /** Names of all signals and curves. */
  get names() {
    return [...new Set(this.runs.flatMap((run) => this.signalsOf(run).map(({ name }) => name)))];
  }

  signalsOf(run) {
    return [...run.signals, ...this.#curves.get(run).values()];
  }

  isHidden({ run, signal }) {
    const { hide } = this.#state;
    return hide.includes(signal.name) || hide.includes(ofRun(signal.name, run));
  }

  hide({ run, signal }, hidden) {
    const own = this.runs.length > 1 ? ofRun(signal.name, run) : signal.name;
    const without = this.#state.hide.filter((each) => each !== own && each !== signal.name);
    const others = this.#state.hide.includes(signal.name) && !hidden
      ? this.runs.filter((each) => each.index !== run.index).map((each) => ofRun(signal.name, each)) : [];
    this.#change({ hide: hidden ? [...without, own] : [...without, ...others] }, false);
  }

  hasOwnAxis(name) {
    return this.#state.own_axis.includes(name);
  }

  setOwnAxis(name, own) {
    const without = this.#state.own_axis.filter((each) => each !== name);
    this.#change({ own_axis: own ? [...without, name] : without });
  }

  /** Puts a signal into the plot of that index; into a new one behind all others. */
  move(name, index) {
    const plots = this.plots.map(({ curves }) => [...new Set(curves.map(({ signal }) => signal.name))].filter((each) => each !== name));
    if (index < plots.length) plots[index].push(name);
    else plots.push([name]);
    this.#change({ plots: plots.filter((names) => names.length > 0) });
  }

  /** Throws an error that says what is wrong with the formula. */
  addCurve(name, formula) {
    if (!name || this.names.includes(name)) throw new Error(name ? `there is a curve '${name}' already` : "a curve needs a name");
    const runs = this.runs.filter((run) => this.#canWork(name, formula, run));
    if (runs.length === 0) curveOf(name, formula, this.runs[0]);
    this.#change({ curves: { ...this.#state.curves, [name]: formula } });
  }

  removeCurve(name) {
    const { [name]: _, ...curves } = this.#state.curves;
    this.#change({ curves });
  }

  addPath(x, y) {
    this.#change({ paths: [...this.#state.paths, { x, y }] });
  }

  removePath(path) {
    this.#change({ paths: this.#state.paths.filter((each) => each !== path) });
  }

  reset() {
    this.#change(this.initial);
  }

  /** What a program says to have this arrangement. */
  get yaml() {
    const { paths, hide, ...rest } = this.#state;
    const labels = this.runs.map(({ label }) => ` of ${label}`);
    const said = { ...this.initial, ...rest, hide: hide.filter((name) => !labels.some((label) => name.endsWith(label))),
                   paths: paths.map(({ x, y }) => [x, y]) };
    if (said.circle) said.circle = [said.circle.x, said.circle.y, said.circle.radius];
    if (said.band) said.band = [said.band.table, said.band.within];
    const lines = Object.entries(said).filter(([, value]) => value && Object.keys(value).length !== 0);
    return ["report:", ...lines.map(([key, value]) => `  ${key}: ${JSON.stringify(value).replaceAll('":', '": ')}`)].join("\n");
  }

  #state;
  #curves;

  #take(state) {
    this.#state = Object.fromEntries(keys.map((key) => [key, state[key]]));
    this.#curves = new Map(this.runs.map((run) => [run, new Map()]));
    for (const [name, formula] of Object.entries(this.#state.curves))
      for (const run of this.runs)
        if (this.#canWork(name, formula, run)) this.#curves.get(run).set(name, curveOf(name, formula, run));
  }

  /** A curve is drawn of those runs that have its signals. */
  #canWork(name, formula, run) {
    try {
      return Boolean(curveOf(name, formula, run));
    } catch {
      return false;
    }
  }

  /** What an address says, as far as it can be meant. */
  #parsed(text) {
    try {
      const said = JSON.parse(text);
      const isNames = (list) => Array.isArray(list) && list.every((each) => typeof each === "string");
      const good = { plots: (list) => Array.isArray(list) && list.every(isNames), own_axis: isNames, hide: isNames,
                     curves: (map) => map && Object.values(map).every((each) => typeof each === "string"),
                     paths: (list) => Array.isArray(list) && list.every(({ x, y }) => isNames([x, y])) };
      return Object.fromEntries(Object.entries(said).filter(([key, value]) => good[key]?.(value)));
    } catch {
      return {};
    }
  }

  #change(to, anew = true) {
    this.#take({ ...this.#state, ...to });
    const changed = Object.fromEntries(keys.filter((key) => JSON.stringify(this.#state[key]) !== JSON.stringify(this.initial[key]))
                                           .map((key) => [key, this.#state[key]]));
    const hash = Object.keys(changed).length > 0 ? `#${new URLSearchParams({ report: JSON.stringify(changed) })}` : "#";
    history.replaceState(null, "", hash);
    for (const listener of this.#listeners) listener(anew);
  }

  #own(curves) {
    return curves.map(({ run, signal }) => ({ run: this.runs[run.index], signal }));
  }

  #group(names) {
    const curves = names.flatMap((name) => this.runs.flatMap((run) =>
      this.signalsOf(run).filter((signal) => signal.name === name).map((signal) => ({ run, signal }))));
    const [first] = curves.map(({ signal }) => signal);
    return { unit: first?.unit, type: first?.type, names: first?.names, curves };
  }
}
