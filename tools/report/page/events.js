import { element } from "#page/dom";
import { duration } from "#page/format";
import { lastAtOrBefore } from "#page/samples";

function show(view, run, { time }) {
  const at = Math.max(lastAtOrBefore(run.times, time), 0);
  const near = (step) => run.times.at(Math.min(Math.max(at + step, 0), run.times.length - 1));
  view.show(near(-100), near(100));
  view.setCursor(0, near(0));
}

/** The list of a run's events; a click shows the place in the plots. `title` is said before their number. */
export function eventList(run, view, title = "") {
  const lines = run.events.map((event) => {
    const where = event.task ? ` in scan ${event.scan} of ${event.task}` : "";
    const text = `${duration(event.time)} ${event.kind}${where}: ${event.text}`;
    return element("li", {}, element("button", { className: "link", onclick: () => show(view, run, event) }, text));
  });
  const summary = `${title}${lines.length === 1 ? "1 event" : `${lines.length} events`}`;
  return element("details", { className: "events" }, element("summary", {}, summary),
                 element("ul", {}, ...lines));
}
