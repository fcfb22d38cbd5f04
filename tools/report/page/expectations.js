import { colour, element } from "#page/dom";
import { firstAtOrAfter, lastAtOrBefore } from "#page/samples";

const timeOf = (expectation, run) => expectation.at ?? run.times.at(run.times.length - 1);

/** Bounds that were not kept, of a plot's curves: they must be seen where they were due. */
export function failedBounds(curves, range) {
  const bounds = [];
  for (const { run, signal } of curves)
    for (const e of run.expectations) {
      if (e.ok || e.signal !== signal.name) continue;
      const time = timeOf(e, run);
      if (!e.always && (time < range.from || time > range.to)) continue;
      bounds.push(...[e.low, e.high].filter((value) => value !== undefined));
    }
  return bounds;
}

function strike(ctx, x1, y1, x2, y2) {
  ctx.beginPath();
  ctx.moveTo(x1, y1);
  ctx.lineTo(x2, y2);
  ctx.stroke();
}

/** A bracket over the values that were allowed at an instant; open where there is no bound. */
function drawInstant(ctx, x, low, high, box, pixel) {
  const [top, bottom] = [high ?? box.top, low ?? box.top + box.height];
  const arm = 5 * pixel;
  if (Math.abs(bottom - top) < 2 * arm) {
    ctx.beginPath();
    ctx.arc(x, (top + bottom) / 2, arm, 0, 2 * Math.PI);
    ctx.stroke();
    return;
  }
  strike(ctx, x, top, x, bottom);
  if (high !== undefined) strike(ctx, x - arm, top, x + arm, top);
  if (low !== undefined) strike(ctx, x - arm, bottom, x + arm, bottom);
}

/** The first sample that breaks a bound which holds always; -1 if the trace has none. */
function firstBreach({ low = -Infinity, high = Infinity }, values) {
  for (let i = 0; i < values.length; ++i)
    if (values.at(i) < low || values.at(i) > high) return i;
  return -1;
}

function drawAlways(ctx, u, e, { run, signal }, pixel, place) {
  ctx.setLineDash([8 * pixel, 4 * pixel]);
  for (const bound of [e.low, e.high])
    if (bound !== undefined) {
      const y = place(bound);
      strike(ctx, u.bbox.left, y, u.bbox.left + u.bbox.width, y);
    }
  ctx.setLineDash([]);
  const breach = e.ok ? -1 : firstBreach(e, signal.values);
  if (breach < 0) return;
  const [x, y] = [u.valToPos(run.times.at(breach), "x", true), place(signal.values.at(breach))];
  drawInstant(ctx, x, y, y, u.bbox, pixel);
}

/** Draws what was expected of a plot's curves; red where it failed. `lift` places a value. */
export function drawExpectations(u, curves, lift) {
  const { ctx, bbox } = u;
  const pixel = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const curve of curves)
    for (const e of curve.run.expectations.filter((each) => each.signal === curve.signal.name)) {
      if (e.low === undefined && e.high === undefined) continue;
      const place = (value) =>
        value === undefined ? undefined : u.valToPos(lift(curve, value), curve.scale, true);
      ctx.strokeStyle = colour(e.ok ? "good" : "bad");
      ctx.lineWidth = (e.ok ? 1.25 : 2.5) * pixel;
      if (e.always) drawAlways(ctx, u, e, curve, pixel, place);
      else
        drawInstant(ctx, u.valToPos(timeOf(e, curve.run), "x", true), place(e.low), place(e.high),
                    bbox, pixel);
    }
  ctx.restore();
}

function show(view, run, e) {
  const at = e.always ? firstBreach(e, run.signals.find(({ name }) => name === e.signal)?.values ?? [])
                      : firstAtOrAfter(run.times, timeOf(e, run));
  if (at < 0) return;
  const shown = Math.min(at, run.times.length - 1);
  const near = (step) => run.times.at(Math.min(Math.max(shown + step, 0), run.times.length - 1));
  view.show(near(-100), near(100));
  view.setCursor(0, run.times.at(lastAtOrBefore(run.times, near(0))));
}

/** The list of a run's expectations; a click shows the place in the plots. `title` is said before their number. */
export function expectationList(run, view, title = "") {
  const lines = run.expectations.map((e) => {
    const button = element("button", { className: "link", onclick: () => show(view, run, e) }, e.text);
    const line = element("li", { className: e.ok ? "good" : "bad" }, button);
    if (e.deviation) line.append(element("div", { className: "deviation" }, e.deviation));
    return line;
  });
  const failed = run.expectations.filter((e) => !e.ok).length;
  const summary = title + (failed === 0 ? `all ${lines.length} expectations hold`
                                        : `${failed} of ${lines.length} expectations failed`);
  return element("details", { className: "expectations", open: failed > 0 },
                 element("summary", { className: failed ? "bad" : "good" }, summary),
                 element("ul", {}, ...lines));
}
