import { element } from "#page/dom";

const field = (label, input) => element("label", {}, `${label} `, input);

/** A form that does `add` with its fields, and says why where that does not go. */
function form(title, fields, button, add) {
  const problem = element("p", { className: "bad", role: "alert" });
  const made = element("form", { className: "bench" }, element("h3", {}, title), ...fields,
                       element("button", {}, button), problem);
  made.onsubmit = (event) => {
    event.preventDefault();
    problem.textContent = "";
    try {
      add();
    } catch (error) {
      problem.textContent = error.message;
    }
  };
  return made;
}

function curveForm(arrangement) {
  const name = element("input", { name: "curve", size: 10, placeholder: "lag" });
  const formula = element("input", { name: "formula", size: 34, placeholder: "x.position - y.position" });
  return form("Another curve", [field("name", name), field("=", formula)], "Draw it",
              () => arrangement.addCurve(name.value.trim(), formula.value.trim()));
}

function pathForm(arrangement) {
  const choice = (name) => element("select", { name }, ...arrangement.names.map((each) => element("option", {}, each)));
  const [y, x] = [choice("y"), choice("x")];
  return form("One signal over another", [field("", y), field("over", x)], "Draw it",
              () => arrangement.addPath(x.value, y.value));
}

/** A place at the end of the page for a plot that is not there yet: signals are dropped on it. */
function newPlot(arrangement) {
  return droppable(element("p", { className: "new-plot" }, "Drop a signal here for a plot of its own."),
                   arrangement, () => arrangement.plots.length);
}

/** `target` takes signals that are dropped on it into the plot of the index that `place` says. */
export function droppable(target, arrangement, place) {
  target.addEventListener("dragover", (event) => {
    event.preventDefault();
    target.classList.add("target");
  });
  target.addEventListener("dragleave", () => target.classList.remove("target"));
  target.addEventListener("drop", (event) => {
    event.preventDefault();
    target.classList.remove("target");
    const name = event.dataTransfer.getData("text/plain");
    if (arrangement.names.includes(name)) arrangement.move(name, place());
  });
  return target;
}

/** What arranges the page: further curves and paths, and how a program keeps what was arranged. */
export function workbench(arrangement) {
  const text = element("textarea", { readOnly: true, rows: 4, spellcheck: false, ariaLabel: "report: of the program" });
  const kept = element("details", { className: "kept" },
                       element("summary", {}, "Keep this arrangement: the page's address has it, and this in the program"), text);
  kept.ontoggle = () => { text.value = arrangement.yaml; };
  const reset = element("button", { onclick: () => arrangement.reset() }, "As it was");
  return element("section", { className: "workbench" }, newPlot(arrangement),
                 element("div", { className: "benches" }, curveForm(arrangement), pathForm(arrangement)), kept, reset);
}
