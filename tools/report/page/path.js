import { farthest } from "#page/band";
import { deviation, Deviations, figures, findCircle, isNear, nominal } from "#page/circle";
import { afterwards, colour, dashes, element, nextFrame, palette, stroke } from "#page/dom";
import { number, withUnit } from "#page/format";
import { lastAtOrBefore, seen } from "#page/samples";

const wanted = 500;
const near = 0.25; // pixels between points that count as one

/** The greatest of 1, 2, 5, 10, ... up to `wanted` that keeps a magnified path off the centre. */
function magnification(circle, tracks, view) {
  let worst = 0;
  for (const { run, deviations } of tracks)
    for (const value of view.slicedValues(run, deviations))
      worst = Math.max(worst, Math.abs(value));
  const steps = [500, 200, 100, 50, 20, 10, 5, 2];
  return steps.find((step) => step <= wanted && step * worst < 0.8 * circle.radius) ?? 1;
}

/** Round numbers about `count` to the range. */
function ticks(from, to, count) {
  const rough = (to - from) / count;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= rough);
  const result = [];
  for (let k = Math.ceil(from / step); k * step <= to; ++k) result.push(k * step + 0); // no -0
  return result;
}

/** Paths of positions in the plane, equal axes, beside a circle and with the deviation magnified, or in a band. */
export class Path {
  /** Of the runs that have both signals of `pair`. */
  constructor(parent, pair, view, arrangement, { circle: given, band, while: condition }) {
    this.view = view;
    this.pair = pair;
    this.arrangement = arrangement;
    this.tracks = arrangement.runs.flatMap((run) => {
      const find = (name) => arrangement.signalsOf(run).find((signal) => signal.name === name);
      const [x, y] = [find(pair.x), find(pair.y)];
      return x && y ? [{ run, x: x.values, y: y.values, units: [x.unit, y.unit], condition: find(condition)?.values }] : [];
    });
    [this.unit, this.unitY] = this.tracks[0].units;
    this.isPlane = this.unit === this.unitY && this.unit !== "" && pair.x !== pair.y;
    this.#choosePoints();
    this.circle = this.isPlane && given ? { ...given } : this.isPlane && !band ? this.#guess() : null;
    this.band = this.isPlane && !this.circle ? band : null;
    for (const track of this.circle ? this.tracks : [])
      track.deviations = new Deviations(this.circle, track);
    this.magnify = this.circle ? magnification(this.circle, this.tracks, view) : 1;
    this.canvas = element("canvas", { className: "path" });
    this.figures = element("table", { className: "figures" });
    this.section = element("section", { className: "plot" },
                           element("div", { className: "chart square" }, this.canvas),
                           element("div", { className: "side" }, this.#controls(), this.figures));
    this.canvas.role = "img";
    this.canvas.ariaLabel = `${pair.y} over ${pair.x}`;
    parent.append(this.section);
    this.redraw = nextFrame(() => this.#draw());
    this.writeLater = afterwards(() => this.#write());
    this.stop = view.listen((change) => this.#changed(change));
    this.refresh();
  }

  /** The deviation of each run's path from the circle as signals of a plot over time. */
  deviationCurves() {
    const name = "deviation δ";
    return this.tracks.map(({ run, deviations: values }) =>
      ({ run, signal: { name, unit: this.unit, type: "real", values } }));
  }

  /** `listener` is called when the circle has been changed. */
  onCircle(listener) {
    this.circleListener = listener;
  }

  remove() {
    this.stop();
    this.section.remove();
  }

  refresh() {
    this.writeLater();
    this.redraw();
  }

  resize() {
    if (this.canvas.clientWidth !== this.width) this.redraw();
  }

  #guess() {
    const found = findCircle(this.tracks[0].points);
    return found && nominal(found);
  }

  #changed(change) {
    if (change === "hover") return;
    if (change === "runs") this.writeLater();
    if (change === "range") {
      this.#choosePoints();
      this.writeLater();
    }
    this.redraw();
  }

  #controls() {
    const field = (label, value, set) => {
      const input = element("input", { type: "number", step: "any", value, onchange: () => {
        if (Number.isFinite(input.valueAsNumber)) set(input.valueAsNumber);
        for (const { deviations } of this.tracks) deviations.forget();
        this.refresh();
        this.circleListener?.();
      } });
      return element("label", {}, label, input);
    };
    const title = element("h2", {}, this.isPlane ? `Path of ${this.pair.x}, ${this.pair.y}` : `${this.pair.y} over ${this.pair.x}`);
    const remove = element("button", { onclick: () => this.arrangement.removePath(this.pair) }, "Remove");
    if (!this.circle) return element("div", { className: "controls" }, title, this.#key(), remove);
    const { circle } = this;
    return element("div", { className: "controls" }, title, this.#key(),
      field("deviation ×", this.magnify, (value) => { this.magnify = value; }),
      field(`centre x [${this.unit}]`, circle.x, (value) => { circle.x = value; }),
      field(`centre y [${this.unit}]`, circle.y, (value) => { circle.y = value; }),
      field(`radius [${this.unit}]`, circle.radius, (value) => { if (value > 0) circle.radius = value; }), remove);
  }

  /** Which stroke is which run's. */
  #key() {
    if (this.tracks.length < 2) return "";
    return element("p", { className: "key" }, ...this.tracks.map(({ run }) =>
      element("span", { className: "run-key" }, stroke(run.index, run.index), run.label)));
  }

  #write() {
    if (this.band) this.#writeDistances();
    if (!this.circle) return;
    const rows = this.#shown.map((track) => {
      const { run } = track;
      const f = figures(this.circle, track, track.deviations, seen(run.times, this.view.range));
      if (!f) return [run.label, "–", "–", "–", "–"];
      const at = `${number(+f.worst.x.toPrecision(4))}, ${number(+f.worst.y.toPrecision(4))}`;
      return [run.label, ...[f.mean, f.worst.value, f.offset].map((v) => number(+v.toPrecision(4))), at];
    });
    this.#tabulate(["mean |δ|", "greatest δ", "centre offset", "greatest at"], rows);
  }

  /** How far each run is from the middle of the band at most, among the points that are drawn. */
  #writeDistances() {
    this.#tabulate(["farthest from the points", "farthest at"], this.#shown.map(({ run, points }) => {
      const worst = farthest(this.#line, points);
      if (!worst) return [run.label, "–", "–"];
      return [run.label, number(+worst.away.toPrecision(4)), `${number(+worst.x.toPrecision(4))}, ${number(+worst.y.toPrecision(4))}`];
    }));
  }

  #tabulate(names, rows) {
    const heads = ["in view", ...names.map((name) => withUnit(name, `[${this.unit}]`))];
    const lines = rows.map((cells) => element("tr", {}, ...cells.map((cell) => element("td", {}, cell))));
    this.figures.replaceChildren(element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {}, head)))),
                                 element("tbody", {}, ...lines));
  }

  /** The middle of the band: from where the first run begins, through the points of the table. */
  get #line() {
    const [{ x, y }] = this.tracks;
    return [[x.at(0), y.at(0)], ...this.band.points];
  }

  /** Tracks of the runs that are drawn. */
  get #shown() {
    return this.tracks.filter(({ run }) => !run.hidden);
  }

  get #centre() {
    return this.circle ?? { x: 0, y: 0 };
  }

  /** By what a sample's distance from the circle's centre is drawn longer. */
  #stretch(x, y) {
    const { circle, magnify } = this;
    if (!circle || magnify === 1) return 1;
    const by = deviation(circle, x, y);
    return Math.max(circle.radius + magnify * by, 0) / (circle.radius + by);
  }

  /** Of the points of all tracks, and of the circle with some room. */
  #extent(tracks) {
    const reach = this.circle ? this.circle.radius * 1.02 : -Infinity;
    const { x, y } = this.#centre;
    const extent = { x: [x - reach, x + reach], y: [y - reach, y + reach] };
    for (const points of tracks)
      for (const [axis, values] of Object.entries(points))
        for (let i = 0; i < values.length; ++i) {
          if (values[i] < extent[axis][0]) extent[axis][0] = values[i];
          if (values[i] > extent[axis][1]) extent[axis][1] = values[i];
        }
    return extent;
  }

  /** About 20,000 of the samples in view. */
  #choosePoints() {
    for (const track of this.tracks) {
      const [first, end] = seen(track.run.times, this.view.range);
      const step = Math.max(1, Math.floor((end - first) / 20000));
      const [x, y, condition] = [track.x, track.y, track.condition].map((samples) =>
        samples?.every(step, first, Math.ceil((end - first) / step)));
      track.points = { x, y, condition };
    }
  }

  /** A track's points where they are drawn; NaN where the line is broken. */
  #placed({ points: { x, y, condition } }) {
    const placed = { x: new Float64Array(x.length), y: new Float64Array(x.length) };
    const { x: a, y: b } = this.#centre;
    for (let k = 0; k < x.length; ++k) {
      const off = this.magnify !== 1 && (!isNear(this.circle, x[k], y[k]) || (condition && condition[k] !== 1));
      const factor = off ? NaN : this.#stretch(x[k], y[k]);
      placed.x[k] = a + (x[k] - a) * factor;
      placed.y[k] = b + (y[k] - b) * factor;
    }
    return placed;
  }

  #draw() {
    const width = this.canvas.clientWidth;
    this.width = width;
    if (width === 0) return;
    const pixel = devicePixelRatio;
    this.canvas.width = width * pixel;
    this.canvas.height = this.canvas.clientHeight * pixel;
    const ctx = this.canvas.getContext("2d");
    ctx.scale(pixel, pixel);
    const shown = this.#shown;
    const tracks = shown.map((track) => this.#placed(track));
    const map = this.#map(width, this.canvas.clientHeight, this.#extent(tracks));
    this.#drawAxes(ctx, map);
    ctx.save();
    ctx.beginPath();
    ctx.rect(map.left, map.top, map.width, map.height);
    ctx.clip();
    if (this.band) this.#drawBand(ctx, map);
    if (this.circle) this.#drawCircle(ctx, map);
    tracks.forEach((points, index) => this.#drawTrack(ctx, map, points, shown[index].run));
    this.#drawCursors(ctx, map);
    ctx.restore();
  }

  /** Where points are drawn. In a plane one scale for both directions, the path in the middle. */
  #map(width, height, { x, y }) {
    const box = { left: 76, top: 10, width: width - 86, height: height - 56 };
    const fitting = [0.94 * box.width / (x[1] - x[0] || 1), 0.94 * box.height / (y[1] - y[0] || 1)];
    const [across, up] = this.isPlane ? fitting.map(() => Math.min(...fitting)) : fitting;
    const middle = [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
    return { ...box,
             x: (value) => box.left + box.width / 2 + (value - middle[0]) * across,
             y: (value) => box.top + box.height / 2 - (value - middle[1]) * up,
             scale: across,
             xs: [middle[0] - box.width / 2 / across, middle[0] + box.width / 2 / across],
             ys: [middle[1] - box.height / 2 / up, middle[1] + box.height / 2 / up] };
  }

  #drawAxes(ctx, map) {
    ctx.font = "12px system-ui, sans-serif";
    ctx.fillStyle = colour("muted");
    ctx.strokeStyle = colour("grid");
    ctx.textAlign = "center";
    const line = (x1, y1, x2, y2) => {
      ctx.beginPath();
      ctx.moveTo(x1, y1);
      ctx.lineTo(x2, y2);
      ctx.stroke();
    };
    const bottom = map.top + map.height;
    for (const tick of ticks(...map.xs, Math.min(7, map.width / 70))) {
      line(map.x(tick), map.top, map.x(tick), bottom);
      ctx.fillText(number(tick), map.x(tick), bottom + 18);
    }
    ctx.fillText(withUnit(this.pair.x, this.unit && `[${this.unit}]`), map.left + map.width / 2, bottom + 38);
    ctx.textAlign = "right";
    for (const tick of ticks(...map.ys, 7)) {
      line(map.left, map.y(tick), map.left + map.width, map.y(tick));
      ctx.fillText(number(tick), map.left - 6, map.y(tick) + 4);
    }
    ctx.save();
    ctx.translate(14, map.top + map.height / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.textAlign = "center";
    ctx.fillText(withUnit(this.pair.y, this.unitY && `[${this.unitY}]`), 0, 0);
    ctx.restore();
  }

  #drawBand(ctx, map) {
    ctx.save();
    ctx.beginPath();
    for (const [x, y] of this.#line) ctx.lineTo(map.x(x), map.y(y));
    ctx.strokeStyle = colour("muted");
    ctx.lineJoin = ctx.lineCap = "round";
    ctx.globalAlpha = 0.25;
    ctx.lineWidth = Math.max(2 * this.band.within * map.scale, 1);
    ctx.stroke();
    ctx.restore();
  }

  #drawCircle(ctx, map) {
    ctx.strokeStyle = colour("muted");
    ctx.lineWidth = 1;
    ctx.setLineDash([4, 4]);
    ctx.beginPath();
    ctx.arc(map.x(this.circle.x), map.y(this.circle.y), this.circle.radius * map.scale, 0, 2 * Math.PI);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  #drawTrack(ctx, map, points, run) {
    ctx.strokeStyle = palette(run.index);
    ctx.lineWidth = 1.5;
    ctx.setLineDash(dashes(run.index));
    ctx.beginPath();
    let [joined, lastX, lastY] = [false, 0, 0];
    for (let i = 0; i < points.x.length; ++i) {
      const x = map.x(points.x[i]);
      const y = map.y(points.y[i]);
      const drawn = !Number.isNaN(x) && !Number.isNaN(y);
      if (drawn && joined && Math.abs(x - lastX) < near && Math.abs(y - lastY) < near) continue;
      if (drawn && joined) ctx.lineTo(x, y);
      else if (drawn) ctx.moveTo(x, y);
      [joined, lastX, lastY] = [drawn, x, y];
    }
    ctx.stroke();
    ctx.setLineDash([]);
  }

  #drawCursors(ctx, map) {
    ["A", "B"].forEach((name, index) => {
      const [track] = this.#shown;
      if (!track) return;
      const { run, x, y } = track;
      const at = lastAtOrBefore(run.times, this.view.cursors[index]);
      if (at < 0) return;
      const { x: a, y: b } = this.#centre;
      const factor = this.#stretch(x.at(at), y.at(at));
      const [px, py] = [map.x(a + (x.at(at) - a) * factor), map.y(b + (y.at(at) - b) * factor)];
      ctx.textAlign = "left";
      ctx.fillStyle = colour(`cursor-${name}`);
      ctx.beginPath();
      ctx.arc(px, py, 5, 0, 2 * Math.PI);
      ctx.fill();
      ctx.fillText(name, px + 9, py + 4);
    });
  }
}
