import { CursorLines } from "#page/cursors";
import { colour, dashes, element, palette } from "#page/dom";
import { drawExpectations, failedBounds } from "#page/expectations";
import { isTime, numbersOf, statesOf, tick, timeTicks } from "#page/format";
import { Legend } from "#page/legend";

const least = 64; // width of an axis
const labelWidth = 20;
const laneHeight = 34;
const axisHeight = 62;
const stateHeight = 17;
const font = "12px system-ui, sans-serif";
const strips = "strips"; // the scale of a plot of booleans only

/** The plots of a page: one for each unit, one for each enumeration, one of strips for booleans. */
export function groups(runs) {
  const found = new Map();
  for (const run of runs)
    for (const signal of run.signals) {
      const key = signal.type === "enumeration" ? `=${signal.name}` : `${signal.type === "boolean"}${signal.unit}`;
      if (!found.has(key))
        found.set(key, { unit: signal.unit, type: signal.type, names: signal.names, curves: [] });
      found.get(key).curves.push({ run, signal });
    }
  const areStrips = (group) => (group.type === "boolean" ? 1 : 0);
  return [...found.values()].sort((a, b) => areStrips(a) - areStrips(b));
}

function padded(least, greatest) {
  if (least === null || least === undefined) return [0, 1];
  const room = greatest > least ? (greatest - least) * 0.06 : Math.abs(least) * 0.1 || 1;
  return [least - room, greatest + room];
}

const ruler = document.createElement("canvas").getContext("2d");

/** Width of a text beside an axis. */
function widthOf(text) {
  ruler.font = font;
  return Math.ceil(ruler.measureText(text).width);
}

/** A name on lines that are no wider than half of a narrow page. */
function broken(name, widest) {
  if (widthOf(name) <= widest) return name;
  const lines = [""];
  for (const part of name.split(/(?<=[_.])|(?<=\p{Ll})(?=\p{Lu})/u)) {
    if (lines.at(-1) !== "" && widthOf(lines.at(-1) + part) > widest) lines.push("");
    lines[lines.length - 1] += part;
  }
  return lines.join("\n");
}

const isShown = ({ hidden, run }) => !hidden && !run.hidden;

/** The curves that share an axis: of one unit, of one enumeration, or one alone. */
function scaleOf({ signal }, arranged) {
  if (arranged?.hasOwnAxis(signal.name)) return `own ${signal.name}`;
  if (signal.type === "boolean") return "boolean";
  return signal.type === "enumeration" ? `states ${signal.names.join()} ${numbersOf(signal).join()}` : `unit ${signal.unit}`;
}

/**
 * Curves over time, with their legend. `arranged` is the page's Arrangement if it has one, `index`
 * the plot's in it.
 */
export class Plot {
  constructor(parent, group, view, arranged = null, index = 0) {
    this.view = view;
    this.arranged = arranged;
    this.index = index;
    const names = [...new Set(group.curves.map(({ signal }) => signal.name))];
    this.isStrips = group.curves.every((curve) => curve.signal.type === "boolean" && !arranged?.hasOwnAxis(curve.signal.name));
    const runs = arranged?.runs.length ?? 1;
    this.curves = group.curves.map((curve) => {
      const lane = names.indexOf(curve.signal.name);
      return { ...curve, lane, stroke: runs > 1 ? curve.run.index : lane, dash: lane * runs + curve.run.index,
               scale: this.isStrips ? strips : scaleOf(curve, arranged), hidden: arranged?.isHidden(curve) ?? false };
    });
    this.lanes = names.length;
    this.scales = [...new Set(this.curves.map(({ scale }) => scale))];
    this.chart = element("div", { className: "chart" });
    const side = element("div", { className: "side" });
    this.section = element("section", { className: "plot" }, this.chart, side);
    parent.append(this.section);
    this.legend = new Legend(side, this);
  }

  /** What its axes take beside the curves, [left, right]. */
  get margins() {
    const widths = this.scales.map((scale) => this.#axisSize(scale));
    return [widths[0], widths.slice(1).reduce((sum, width) => sum + width, 0)];
  }

  /** Draws the plot for the first time, so wide; its curves stand between margins of all plots. */
  draw(width, margins = this.margins) {
    this.outer = margins;
    this.uplot = new uPlot(this.#options(width), this.#data(), this.chart);
    this.cursors = new CursorLines(this.uplot, this.view, this.curves[0].run.times);
    this.#listenToMouse();
    this.stop = this.view.listen((change) => this.#changed(change));
  }

  remove() {
    this.stop();
    this.uplot.destroy();
    this.section.remove();
  }

  resize() {
    const width = this.chart.clientWidth;
    if (width > 0 && width !== this.uplot.width) this.uplot.setSize({ width, height: this.#height() });
    this.cursors.place();
  }

  /** Shows a curve, or does not. */
  toggle(curve) {
    curve.hidden = !curve.hidden;
    this.arranged?.hide(curve, curve.hidden);
    this.#showCurves();
  }

  #showCurves() {
    this.curves.forEach((curve, k) => {
      if (this.uplot.series[k + 1].show !== isShown(curve)) this.uplot.setSeries(k + 1, { show: isShown(curve) });
    });
  }

  #height() {
    if (this.isStrips) return this.lanes * laneHeight + axisHeight;
    const states = Math.max(0, ...this.curves.map(({ signal }) => signal.names?.length ?? 0));
    const plain = this.curves.every(({ signal }) => signal.type === "enumeration") ? 170 : 240;
    return Math.max(plain, states * stateHeight * (this.#lines ?? 1) + axisHeight);
  }

  /** Lines of the state's name that takes most. */
  get #lines() {
    return Math.max(1, ...this.curves.flatMap(({ signal }) => (signal.names ?? []).map((name) => this.#state(name).split("\n").length)));
  }

  #changed(change) {
    if (change === "range") this.uplot.setData(this.#data());
    if (change === "theme") this.uplot.redraw(false, true);
    if (change === "runs") this.#showCurves();
    if (change === "cursors") this.cursors.place();
    this.legend.update(change);
  }

  #data() {
    const tables = [];
    for (const run of new Set(this.curves.map((curve) => curve.run))) {
      const columns = this.curves
        .filter((curve) => curve.run === run)
        .map((curve) => this.#inLane(this.view.slicedValues(run, curve.signal.values), curve.lane));
      tables.push([this.view.slicedTimes(run), ...columns]);
    }
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  }

  #inLane(values, lane) {
    if (!this.isStrips) return values;
    const base = this.lanes - 1 - lane + 0.12;
    return values.map((value) => (value === null ? null : base + 0.45 * value));
  }

  #options(width) {
    const scales = Object.fromEntries(this.scales.map((scale) =>
      [scale, { range: (_, low, high) => this.#range(scale, low, high) }]));
    const right = this.outer[1] - this.margins[1] + 14;
    return {
      width: Math.max(width, 200),
      height: this.#height(),
      padding: [18, right, 0, this.outer[0] - this.margins[0]],
      legend: { show: false },
      scales: { x: { time: false, range: () => [this.view.range.from, this.view.range.to] }, ...scales },
      axes: [this.#timeAxis(), ...this.scales.map((scale, k) => this.#valueAxis(scale, k))],
      series: [{}, ...this.curves.map((curve) => this.#series(curve))],
      cursor: {
        sync: { key: "time", scales: ["x", null] },
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => this.view.reset() },
        points: { show: !this.isStrips, size: 6 },
      },
      hooks: {
        setSelect: [(u) => this.#zoomTo(u.select)],
        setCursor: [(u) => this.#hover(u)],
        draw: [(u) => this.#decorate(u), () => this.cursors?.place()], // only now uPlot has the new scale
      },
    };
  }

  #of(scale) {
    return this.curves.filter((curve) => curve.scale === scale);
  }

  #range(scale, low, high) {
    if (this.isStrips) return [0, this.lanes];
    const [{ signal }] = this.#of(scale);
    if (signal.type === "boolean") return [-0.1, 1.1];
    if (signal.type === "enumeration") {
      const known = [...numbersOf(signal), low ?? Infinity, high ?? -Infinity];
      return [Math.min(...known) - 0.5, Math.max(...known) + 0.5];
    }
    if (low === null || low === undefined) return padded(low, high);
    const bounds = failedBounds(this.#of(scale), this.view.range);
    return padded(Math.min(low, ...bounds), Math.max(high, ...bounds));
  }

  #axis() {
    return {
      font,
      labelFont: font,
      stroke: () => colour("muted"),
      grid: { stroke: () => colour("grid"), width: 1 },
      ticks: { stroke: () => colour("grid"), size: 4 },
      values: (_, ticks) => ticks.map(tick),
    };
  }

  #timeAxis() {
    return { ...this.#axis(), label: "time", labelSize: 18, size: 26, space: 80, values: (_, ticks) => timeTicks(ticks, "s") };
  }

  /** The names of an axis: of states, of false and true; none where numbers stand. */
  #namesOf(scale) {
    const [{ signal }] = this.#of(scale);
    if (signal.type === "boolean") return ["false", "true"];
    return signal.type === "enumeration" ? statesOf(signal).map(({ name }) => this.#state(name)) : null;
  }

  #state(name) {
    return broken(name, Math.max(least, 0.4 * (this.chart.clientWidth || 400)));
  }

  #axisSize(scale) {
    if (scale === strips) return least + labelWidth;
    const names = this.#namesOf(scale)?.flatMap((name) => name.split("\n")) ?? [];
    return Math.max(least, ...names.map((name) => widthOf(name) + 14)) + labelWidth;
  }

  /** The first axis stands on the left, all others on the right, in the colour of their curve if it is one. */
  #valueAxis(scale, place) {
    const curves = this.#of(scale);
    const [{ signal, stroke }] = curves;
    const alone = new Set(curves.map((curve) => curve.signal.name)).size === 1 && this.scales.length > 1;
    const name = alone ? `${signal.name} ` : "";
    const axis = { ...this.#axis(), scale, side: place === 0 ? 3 : 1, size: this.#axisSize(scale) - labelWidth, labelSize: labelWidth };
    if (alone) axis.stroke = () => palette(stroke);
    if (place > 0) axis.grid = { show: false };
    const names = this.#namesOf(scale);
    if (scale === strips) return { ...axis, label: "", splits: () => [], grid: { show: false } };
    if (names) {
      const numbers = signal.type === "enumeration" ? statesOf(signal).map(({ value }) => value) : [0, 1];
      return { ...axis, label: name, splits: () => numbers, values: () => names };
    }
    if (isTime(signal.unit)) return { ...axis, label: name, values: (_, ticks) => timeTicks(ticks, signal.unit) };
    return { ...axis, label: `${name}${signal.unit ? `[${signal.unit}]` : "no unit"}` };
  }

  #series(curve) {
    const { run, signal, lane, scale, stroke, dash } = curve;
    const stepped = signal.type !== "real";
    const base = this.lanes - 1 - lane + 0.12;
    return {
      label: signal.name,
      scale,
      show: isShown(curve),
      stroke: () => palette(stroke),
      width: run.index === 0 ? 1.5 : 1.25,
      dash: dashes(dash),
      paths: stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
      points: { show: false },
      fill: this.isStrips && run.index === 0 ? () => `${palette(stroke)}55` : undefined,
      fillTo: this.isStrips ? () => base : undefined,
    };
  }

  #decorate(u) {
    if (this.isStrips) this.#nameLanes(u);
    drawExpectations(u, this.curves.filter(isShown), (curve, value) =>
      this.isStrips ? this.#inLane([value], curve.lane)[0] : value);
  }

  #nameLanes(u) {
    const { ctx } = u;
    ctx.save();
    ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = "left";
    ctx.textBaseline = "top";
    ctx.fillStyle = colour("text");
    for (const [lane, { signal }] of new Map(this.curves.map((curve) => [curve.lane, curve])))
      ctx.fillText(signal.name, u.bbox.left + 6 * devicePixelRatio,
                   u.valToPos(this.lanes - lane, strips, true) + 2 * devicePixelRatio);
    ctx.restore();
  }

  #zoomTo({ left, width }) {
    const [from, to] = [left, left + width].map((position) => this.uplot.posToVal(position, "x"));
    this.uplot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    if (width > 3) this.view.show(from, to);
  }

  #hover(u) {
    this.view.setHover(u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : null);
  }

  #listenToMouse() {
    const { over } = this.uplot;
    const time = (event) => this.uplot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
    over.addEventListener("click", (event) => {
      if (event.detail === 1) this.view.setCursor(event.shiftKey ? 1 : 0, time(event));
    });
    over.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const { from, to } = this.view.range;
      const turn = (event.deltaY || event.deltaX) / 500;
      if (event.ctrlKey) this.view.zoom(time(event), 2 ** (3 * turn));
      else this.view.show(from + (to - from) * turn, to + (to - from) * turn);
    }, { passive: false });
  }
}
