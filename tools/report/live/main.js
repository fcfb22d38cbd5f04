import { get, post } from "#live/api";
import { Axes } from "#live/axes";
import { download, Scope } from "#live/scope";
import { conditions } from "#live/trigger";
import { Values } from "#live/values";
import { readout } from "#page/cursors";
import { element, nextFrame, row } from "#page/dom";
import { duration, numbersOf } from "#page/format";
import { followTheme } from "#page/theme";

const byId = (id) => document.getElementById(id);
const retry = 1000; // ms
const scope = new Scope(byId("plots"), nextFrame(showScope));
let chosen = new Set();
let stream = null;
let state = null;
let rows = new Map(); // of the table of signals
let axes = null;

function tell(text) {
  byId("message").textContent = text;
  byId("message").hidden = !text;
}

/** What was typed, as a number where it is one; an integer that a number here would round stays what was typed. */
function typed({ value }) {
  const text = value.trim();
  const number = Number(text);
  const isRounded = /^[-+]?\d+$/.test(text) && !Number.isSafeInteger(number);
  return text !== "" && Number.isFinite(number) && !isRounded ? number : text;
}

/** Does what a click asks for, and says why not. */
const attempt = (task) => async (event) => {
  event?.preventDefault();
  try {
    tell("");
    const answer = await task(event);
    if (answer?.pace) show(answer);
  } catch (error) {
    tell(error.message);
  }
};

function show(now) {
  state = now;
  document.title = `${now.program} – lineshaft`;
  document.querySelector("h1").textContent = now.program;
  byId("time").textContent = `${now.time_s.toFixed(now.paused ? 6 : 3)} s`;  // a step may be shorter than 1 ms
  byId("pause").textContent = now.paused ? "Go on" : "Pause";
  const late = now.pace.overruns > 0 ? `, ${now.pace.overruns} overruns` : "";
  byId("status").textContent = `${now.paused ? "paused" : `speed ${now.speed}`}${late}`;
  const head = ["task", "scans", "p50", "p99", "greatest", "overruns"];
  const us = (time) => duration(time / 1e6);
  byId("tasks").replaceChildren(
    element("tr", {}, ...head.map((title) => element("th", {}, title))),
    ...now.pace.tasks.map(({ name, scans, overruns, lateness_us: late_us }) =>
      row(name, String(scans), us(late_us.p50), us(late_us.p99), us(late_us.greatest), String(overruns))));
  axes?.update();
  for (const [name, { force }] of rows) {
    const is = name in now.forced;
    force.textContent = is ? `release ${now.forced[name]}` : "force";
    force.ariaLabel = is ? `release ${name} from ${now.forced[name]}` : `force ${name}`;
    force.classList.toggle("forced", is);
  }
}

/** What the scope does, where its cursors are, what it waits for. */
function showScope() {
  byId("hold").textContent = scope.held ? "Follow" : "Hold";
  byId("readout").textContent = scope.held ? readout(scope.cursors) : "";
  const { state: is, time } = scope.trigger;
  byId("armed").textContent = is === "off" ? "" : time === null ? is : `${is} at ${duration(time)}`;
  byId("arm").textContent = is === "armed" ? "Disarm" : "Arm";
}

/** The signals that are drawn may be waited for. */
function offerTriggers() {
  const { signal } = byId("trigger");
  const before = signal.value;
  signal.replaceChildren(...scope.signals.map(({ name }) => element("option", {}, name)));
  if (chosen.has(before)) signal.value = before;
  offerConditions();
}

function offerConditions() {
  const { signal, condition, level } = byId("trigger");
  const { type } = scope.signals.find(({ name }) => name === signal.value) ?? {};
  condition.replaceChildren(...conditions(type).map((name) => element("option", {}, name)));
  level.hidden = type === "boolean";
}

/** Or lets it be, when it is armed. */
function arm(form) {
  if (scope.trigger.state === "armed") {
    scope.trigger.disarm();
    return showScope();
  }
  const { signal, condition, level, before, after } = form;
  const found = scope.signals.find(({ name }) => name === signal.value);
  const { type, names } = found;
  const value = names.length > 0 ? numbersOf(found)[names.indexOf(level.value.trim())] : Number(level.value.trim() || NaN);
  if (value === undefined) throw new Error(`expected one of ${names.join(", ")}`);
  if (type !== "boolean" && Number.isNaN(value)) throw new Error("expected a number to compare with");
  if (![before, after].every((each) => Number(each.value) >= 0)) throw new Error("expected times in seconds");
  scope.arm({ signal: signal.value, condition: condition.value, level: value,
              before: Number(before.value), after: Number(after.value) });
  return showScope();
}

/** Begins again by itself when the machine, or the way to it, is gone. */
function connect() {
  stream?.close();
  location.replace(`#${[...chosen].join()}`);
  if (chosen.size === 0) return;
  stream = new EventSource(`/api/stream?signals=${encodeURIComponent([...chosen].join())}`);
  const mine = stream;
  const listen = (name, task) => mine.addEventListener(name, ({ data }) => task(JSON.parse(data)));
  listen("signals", (signals) => {
    scope.begin(signals);
    offerTriggers();
  });
  listen("state", show);
  listen("rows", (samples) => {
    scope.add(samples);
    if (samples.lost > 0) byId("status").title = `${samples.lost} rows came too fast for this page`;
  });
  mine.onerror = () => {
    byId("status").textContent = "not connected, trying again …";
    if (mine.readyState === EventSource.CLOSED && mine === stream) setTimeout(connect, retry);
  };
}

function choose(name, is) {
  if (is) chosen.add(name);
  else chosen.delete(name);
  connect();
}

/** A field for a signal's value, and what is wrong with what was typed there. */
function valueField({ name, unit, names }) {
  const field = element("input", { type: "text", ariaLabel: `value of ${name}`, placeholder: names?.join(" | ") ?? unit });
  const wrong = element("span", { className: "bad wrong", role: "alert", hidden: true });
  const say = (text) => {
    wrong.textContent = text;
    wrong.hidden = !text;
    field.ariaInvalid = String(Boolean(text));
  };
  field.oninput = () => say("");
  const value = () => ({ true: true, false: false })[field.value.trim()] ?? typed(field);
  return { cell: element("span", { className: "typed" }, field, wrong), value, say };
}

function signalRow(signal) {
  const { name, settable } = signal;
  const { cell, value: typedValue, say } = valueField(signal);
  const tried = (task) => attempt(async () => {
    try {
      say("");
      return await task();
    } catch (error) {
      say(error.message);
      throw error;
    }
  });
  const set = element("button", { hidden: !settable, ariaLabel: `set ${name}` }, "set");
  set.onclick = tried(() => post("set", { [name]: typedValue() }));
  const force = element("button", { ariaLabel: `force ${name}` }, "force");
  force.onclick = tried(async () => {
    const isForced = name in (state?.forced ?? {});
    await (isForced ? post("release", { signals: [name] }) : post("force", { [name]: typedValue() }));
    return get("state");
  });
  const drawn = element("input", { type: "checkbox", checked: chosen.has(name), id: `draw ${name}`, ariaLabel: `draw ${name}` });
  drawn.onchange = () => choose(name, drawn.checked);
  const value = element("span", { className: "value" }, "–");
  const made = row(drawn, element("label", { htmlFor: drawn.id }, name), value, cell, set, force);
  made.dataset.name = name;
  return [name, { made, force, drawn, value, signal }];
}

/** Those of the address, else the program's trace, else a few. */
function firstChoice(signals) {
  const wanted = decodeURIComponent(location.hash.slice(1)).split(",");
  const named = signals.filter(({ name }) => wanted.includes(name));
  const traced = signals.filter((signal) => signal.traced);
  const some = signals.filter(({ type }) => type === "real").slice(0, 3);
  return new Set([named, traced, some].find((list) => list.length > 0)?.map(({ name }) => name));
}

function connectToolbar() {
  byId("pause").onclick = attempt(() => post(state?.paused ? "resume" : "pause"));
  byId("step").onclick = attempt(() => post("step"));
  byId("until").onsubmit = attempt((event) => post("run_until", { time: typed(event.target.time) }));
  byId("speed").onsubmit = attempt((event) => post("speed", { speed: typed(event.target.speed) }));
  byId("hold").onclick = () => scope.hold(!scope.held);
  byId("trigger").onsubmit = attempt((event) => arm(event.target));
  byId("trigger").signal.onchange = offerConditions;
  byId("save").onclick = () => download("lineshaft.csv", scope.csv());
  byId("filter").oninput = ({ target }) => {
    for (const [name, { made }] of rows) made.hidden = !name.includes(target.value);
  };
}

async function start() {
  try {
    const signals = await get("signals");
    chosen = firstChoice(signals);
    axes = new Axes(byId("axes"), signals);
    rows = new Map(signals.map(signalRow));
    byId("signals").replaceChildren(...[...rows.values()].map(({ made }) => made));
    new Values(rows, document.querySelector(".scroll"));
    connect();
  } catch {
    byId("status").textContent = "not connected, trying again …";
    setTimeout(start, retry);
  }
}

followTheme(byId("theme"), () => scope.changeTheme());
connectToolbar();
start();
