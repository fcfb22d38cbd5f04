import { readout } from "#page/cursors";
import { unpack } from "#page/decode";
import { dashes, element, nextFrame } from "#page/dom";
import { eventList } from "#page/events";
import { expectationList } from "#page/expectations";
import { Path } from "#page/path";
import { groups, Plot } from "#page/plot";
import { showStudy } from "#page/study";
import { followTheme } from "#page/theme";
import { View } from "#page/view";

const byId = (id) => document.getElementById(id);

/** A run of the report with its samples unpacked. */
async function unpackRun(run, index) {
  const { times, values } = await unpack(run);
  const signals = run.signals.map((signal, k) => ({ ...signal, values: values[k] }));
  return { ...run, index, times, signals };
}

/** File names instead of paths, where they tell the runs apart. */
function shortenLabels(runs) {
  const names = runs.map(({ label }) => label.split("/").pop());
  if (new Set(names).size < runs.length) return;
  runs.forEach((run, k) => { run.label = names[k]; });
}

/** What made a run; of several, where they differ. */
function makers(run, runs) {
  const differs = ([what, value]) => runs.length === 1 || runs.some(({ made_by }) => made_by[what] !== value);
  return Object.entries(run.made_by).filter(differs).map(([what, value]) => `${what}: ${value}`);
}

function describeRuns(runs) {
  return runs.map((run) => {
    const style = `<svg width="26" height="8"><line x1="0" y1="4" x2="26" y2="4"
      stroke="currentColor" stroke-width="2" stroke-dasharray="${dashes(run.index)}"/></svg>`;
    const facts = [`${run.rows} rows`, run.program && `program ${run.program}`,
                   run.version && `lineshaft ${run.version}`, ...makers(run, runs)].filter(Boolean);
    return element("div", { className: "run" },
                   element("span", { innerHTML: runs.length > 1 ? style : "" }),
                   element("b", {}, run.label), ` ${facts.join(", ")}`);
  });
}

/** A plot of each path's deviation, which follows its circle. */
function deviationPlot(parent, path, view) {
  if (!path.circle) return [];
  const [{ signal }] = path.deviationCurves();
  const group = { unit: signal.unit, type: "real", curves: path.deviationCurves() };
  const plot = new Plot(parent, group, view);
  path.onCircle(() => {
    view.show(view.range.from, view.range.to);
    view.tell("cursors");
  });
  return [plot];
}

function showRuns(parent, report, runs) {
  const ends = runs.map(({ times }) => times.at(times.length - 1));
  const view = new View(Math.min(...runs.map(({ times }) => times.at(0))), Math.max(...ends));
  for (const run of runs)
    parent.append(...[run.expectations.length > 0 && expectationList(run, view),
                      run.events.length > 0 && eventList(run, view)].filter(Boolean));
  const paths = report.paths.map((pair) => new Path(parent, pair, runs, view, report));
  const plots = paths.flatMap((path) => deviationPlot(parent, path, view));
  plots.push(...groups(runs).map((group) => new Plot(parent, group, view)));
  const width = plots[0]?.chart.clientWidth; // of all of them
  for (const plot of plots) plot.draw(width);
  new ResizeObserver(nextFrame(() => [...paths, ...plots].forEach((p) => p.resize()))).observe(parent);
  return view;
}

function connectToolbar(view) {
  byId("whole").onclick = () => view.reset();
  byId("between").onclick = () => view.show(Math.min(...view.cursors), Math.max(...view.cursors));
  byId("gather").onclick = () => view.gatherCursors();
  const write = () => { byId("readout").textContent = readout(view.cursors); };
  view.listen((change) => { if (change === "cursors") write(); });
  write();
  document.querySelector(".toolbar").hidden = false;
  document.querySelector("footer").hidden = false;
}

/** Leaves a mark in the browser's performance timeline once what was asked for has been drawn. */
function markFrame(name) {
  requestAnimationFrame(() => setTimeout(() => performance.mark(name)));
}

async function start() {
  const report = JSON.parse(byId("report").textContent);
  const main = document.querySelector("main");
  document.querySelector("h1").textContent = report.title;
  let view = null;
  followTheme(byId("theme"), () => view?.tell("theme"));
  const runs = await Promise.all(report.runs.map(unpackRun));
  shortenLabels(runs);
  byId("runs").append(...describeRuns(runs));
  main.replaceChildren();
  for (const study of report.studies) showStudy(main, study);
  if (runs.length > 0) {
    view = showRuns(main, report, runs);
    connectToolbar(view);
    view.listen((change) => markFrame(`lineshaft:${change}`));
  }
  markFrame("lineshaft:drawn");
}

start().catch((error) => {
  document.querySelector("main").replaceChildren(
    element("p", { className: "bad" },
            `The page cannot be shown: ${error.message}. It needs a browser of 2023 or later.`));
});
