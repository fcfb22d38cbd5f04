import { CursorLines } from "#page/cursors";
import { colour, dashes, element, palette } from "#page/dom";
import { drawExpectations, failedBounds } from "#page/expectations";
import { tick } from "#page/format";
import { Legend } from "#page/legend";

const axisWidth = 84;
const laneHeight = 34;
const axisHeight = 62;
const font = "12px system-ui, sans-serif";

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
  const strips = (group) => (group.type === "boolean" ? 1 : 0);
  return [...found.values()].sort((a, b) => strips(a) - strips(b));
}

function padded(least, greatest) {
  if (least === null || least === undefined) return [0, 1];
  const room = greatest > least ? (greatest - least) * 0.06 : Math.abs(least) * 0.1 || 1;
  return [least - room, greatest + room];
}

const shortened = (text) => (text.length > 12 ? `${text.slice(0, 11)}…` : text);

/** Curves over time that share a unit, with their legend. */
export class Plot {
  constructor(parent, group, view) {
    this.view = view;
    this.group = group;
    const names = [...new Set(group.curves.map(({ signal }) => signal.name))];
    this.curves = group.curves.map((curve) => ({ ...curve, lane: names.indexOf(curve.signal.name) }));
    this.lanes = names.length;
    this.chart = element("div", { className: "chart" });
    const side = element("div", { className: "side" });
    parent.append(element("section", { className: "plot" }, this.chart, side));
    this.legend = new Legend(side, this.curves, view);
  }

  /** Draws the plot for the first time, so wide. */
  draw(width) {
    this.uplot = new uPlot(this.#options(width), this.#data(), this.chart);
    this.cursors = new CursorLines(this.uplot, this.view, this.curves[0].run.times);
    this.#listenToMouse();
    this.view.listen((change) => this.#changed(change));
  }

  get isStrips() {
    return this.group.type === "boolean";
  }

  resize() {
    const width = this.chart.clientWidth;
    if (width > 0 && width !== this.uplot.width) this.uplot.setSize({ width, height: this.#height() });
    this.cursors.place();
  }

  #height() {
    if (this.isStrips) return this.lanes * laneHeight + axisHeight;
    return this.group.type === "enumeration" ? 170 : 240;
  }

  #changed(change) {
    if (change === "range") this.uplot.setData(this.#data());
    if (change === "theme") this.uplot.redraw(false, true);
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
    return {
      width: Math.max(width, 200),
      height: this.#height(),
      legend: { show: false },
      scales: {
        x: { time: false, range: () => [this.view.range.from, this.view.range.to] },
        y: { range: (_, least, greatest) => this.#range(least, greatest) },
      },
      axes: [this.#timeAxis(), this.#valueAxis()],
      series: [{}, ...this.curves.map((curve) => this.#series(curve))],
      cursor: {
        sync: { key: "time" },
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

  #range(least, greatest) {
    if (this.isStrips) return [0, this.lanes];
    if (this.group.type === "enumeration") return [-0.5, this.group.names.length - 0.5];
    if (least === null || least === undefined) return padded(least, greatest);
    const bounds = failedBounds(this.curves, this.view.range);
    return padded(Math.min(least, ...bounds), Math.max(greatest, ...bounds));
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
    return { ...this.#axis(), label: "time [s]", labelSize: 18, size: 26, space: 70 };
  }

  #valueAxis() {
    const axis = { ...this.#axis(), size: axisWidth - 20, labelSize: 20 };
    if (this.isStrips) return { ...axis, label: "", splits: () => [], grid: { show: false } };
    if (this.group.type !== "enumeration") {
      const quantity = this.group.unit ? `[${this.group.unit}]` : "no unit";
      return { ...axis, label: quantity };
    }
    const splits = this.group.names.map((_, index) => index);
    const values = () => this.group.names.map(shortened);
    return { ...axis, size: axisWidth, label: "", labelSize: 0, splits: () => splits, values };
  }

  #series({ run, signal, lane }) {
    const stepped = signal.type !== "real";
    const base = this.lanes - 1 - lane + 0.12;
    return {
      label: signal.name,
      stroke: () => palette(lane),
      width: run.index === 0 ? 1.5 : 1.25,
      dash: dashes(run.index),
      paths: stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
      points: { show: false },
      fill: this.isStrips && run.index === 0 ? () => `${palette(lane)}55` : undefined,
      fillTo: this.isStrips ? () => base : undefined,
    };
  }

  #decorate(u) {
    if (this.isStrips) this.#nameLanes(u);
    drawExpectations(u, this.curves, (curve, value) =>
      this.isStrips ? this.#inLane([value], curve.lane)[0] : value);
  }

  #nameLanes(u) {
    const { ctx } = u;
    ctx.save();
    ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = "left";
    ctx.textBaseline = "top";
    ctx.fillStyle = colour("text");
    for (const { signal, lane } of this.curves)
      ctx.fillText(signal.name, u.bbox.left + 6 * devicePixelRatio,
                   u.valToPos(this.lanes - lane, "y", true) + 2 * devicePixelRatio);
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
