import { Arrangement } from "#page/arrangement";
import { readout } from "#page/cursors";
import { unpack } from "#page/decode";
import { element, nextFrame, stroke } from "#page/dom";
import { eventList } from "#page/events";
import { expectationList } from "#page/expectations";
import { Path } from "#page/path";
import { Plot } from "#page/plot";
import { showStudy } from "#page/study";
import { followTheme } from "#page/theme";
import { View } from "#page/view";
import { droppable, workbench } from "#page/workbench";

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

/** The name of a run; of several with its stroke, as a button that hides the run. */
function runName(run, runs, changed) {
  if (runs.length === 1) return element("b", {}, run.label);
  const button = element("button", { className: "curve", title: `Show or hide ${run.label}`, ariaPressed: "true" },
                         stroke(run.index, run.index), element("b", {}, run.label));
  button.onclick = () => {
    run.hidden = !run.hidden;
    button.ariaPressed = String(!run.hidden);
    changed();
  };
  return button;
}

function describeRuns(runs, changed) {
  const notes = [...new Set(runs.flatMap((run) => run.notes))];
  const lines = runs.map((run) => {
    const facts = [`${run.rows} rows`, run.program && `program ${run.program}`,
                   run.version && `lineshaft ${run.version}`, ...makers(run, runs)].filter(Boolean);
    return element("div", { className: "run" }, runName(run, runs, changed), ` ${facts.join(", ")}`);
  });
  return [...lines, ...notes.map((note) => element("p", { className: "note" }, note))];
}

/** A plot of each path's deviation, which follows its circle. */
function deviationPlot(parent, path, view, arrangement) {
  if (!path.circle) return [];
  const [{ signal }] = path.deviationCurves();
  const group = { unit: signal.unit, type: "real", curves: path.deviationCurves() };
  const plot = new Plot(parent, group, view, { ...deviationPlots, runs: arrangement.runs });
  path.onCircle(() => {
    view.show(view.range.from, view.range.to);
    view.tell("cursors");
  });
  return [plot];
}

/** Deviations are no part of the arrangement: they stay where their path is. */
const deviationPlots = { hasOwnAxis: () => false, isHidden: () => false, hide: () => {}, isFixed: true };

/** Paths and plots, made anew when they are arranged in another way. */
class Board {
  constructor(parent, view, arrangement, report) {
    Object.assign(this, { parent, view, arrangement, report, paths: [], plots: [] });
    this.resize = nextFrame(() => [...this.paths, ...this.plots].forEach((part) => part.resize()));
    new ResizeObserver(this.resize).observe(parent);
    arrangement.listen((anew) => anew && this.build());
  }

  build() {
    const { signal } = document.activeElement?.dataset ?? {};
    for (const part of [...this.paths, ...this.plots]) part.remove();
    const { parent, view, arrangement } = this;
    const there = ({ x, y }) => [x, y].every((name) => arrangement.names.includes(name));
    this.paths = arrangement.paths.filter(there).map((pair) => new Path(parent, pair, view, arrangement, this.report));
    this.plots = this.paths.flatMap((path) => deviationPlot(parent, path, view, arrangement));
    const arranged = arrangement.plots.map((group, k) => new Plot(parent, group, view, arrangement, k));
    for (const plot of arranged) droppable(plot.section, arrangement, () => plot.index);
    this.plots.push(...arranged);
    this.#draw();
    if (signal) parent.querySelector(`select[data-signal="${CSS.escape(signal)}"]`)?.focus();
  }

  /** All curves stand one below the other, whatever their axes take, where there is room for that. */
  #draw() {
    const width = this.plots[0]?.chart.clientWidth;
    if (width < 600) return this.plots.forEach((plot) => plot.draw(width));
    const margins = this.plots.map((plot) => plot.margins);
    const widest = [0, 1].map((side) => Math.max(...margins.map((each) => each[side])));
    for (const plot of this.plots) plot.draw(width, widest);
  }
}

function showRuns(parent, report, runs) {
  const ends = runs.map(({ times }) => times.at(times.length - 1));
  const view = new View(Math.min(...runs.map(({ times }) => times.at(0))), Math.max(...ends));
  for (const run of runs) {
    const title = runs.length > 1 ? `${run.label}: ` : "";
    parent.append(...[run.expectations.length > 0 && expectationList(run, view, title),
                      run.events.length > 0 && eventList(run, view, title)].filter(Boolean));
  }
  const arrangement = new Arrangement(runs, report.arrangement, report.paths);
  const plots = element("div", {});
  parent.append(plots, workbench(arrangement));
  const board = new Board(plots, view, arrangement, report);
  board.build();
  printOnPaper(view, board);
  return view;
}

/** Paper is narrow and white. */
function printOnPaper(view, board) {
  const { dataset } = document.documentElement;
  let theme = "light";
  const change = (printing) => {
    document.body.classList.toggle("printing", printing);
    if (printing) theme = dataset.theme;
    dataset.theme = printing ? "light" : theme;
    for (const part of [...board.paths, ...board.plots]) part.resize();
    view.tell("theme");
  };
  addEventListener("beforeprint", () => change(true));
  addEventListener("afterprint", () => change(false));
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
  byId("runs").append(...describeRuns(runs, () => view?.tell("runs")));
  main.replaceChildren();
  const showStudies = (isFolded) => report.studies.forEach((study) => showStudy(main, study, isFolded));
  if (!report.runs_first) showStudies(false);
  if (runs.length > 0) {
    view = showRuns(main, report, runs);
    connectToolbar(view);
    view.listen((change) => markFrame(`lineshaft:${change}`));
  }
  if (report.runs_first) showStudies(true);
  markFrame("lineshaft:drawn");
}

start().catch((error) => {
  document.querySelector("main").replaceChildren(
    element("p", { className: "bad" },
            `The page cannot be shown: ${error.message}. It needs a browser of 2023 or later.`));
});
