import { element } from "#page/dom";
import { exact, number, withUnit } from "#page/format";

/** Four digits; whole numbers as they are. */
const short = (value) =>
  value === null ? "" : number(Number.isInteger(value) ? value : +value.toPrecision(4), exact);

/** The settings that differ between the rows of a study. */
function varying(rows) {
  const names = [...new Set(rows.flatMap(({ set }) => Object.keys(set)))];
  return names.filter((name) => new Set(rows.map(({ set }) => set[name])).size > 1);
}

/** A bar from zero, on the side that its value asks for. */
function bar(kind, value, extent) {
  const width = (100 * Math.abs(value)) / (extent.greatest - extent.least);
  const zero = (-100 * extent.least) / (extent.greatest - extent.least);
  const left = value < 0 ? zero - width : zero;
  return element("div", { className: `bar ${kind}`, style: `left: ${left}%; width: ${width}%`,
                          title: `${kind} ${number(value)}` });
}

function bars(row, extent) {
  const cell = element("td", { className: "bars" });
  if (row.paper !== null) cell.append(bar("paper", row.paper, extent));
  if (row.ours !== null) cell.append(bar("ours", row.ours, extent));
  return cell;
}

function difference(row) {
  if (row.paper === null || row.ours === null) return "";
  const by = row.ours - row.paper;
  if (row.unit === "%" || row.paper === 0) return `${by > 0 ? "+" : ""}${short(by)}`;
  const share = (by / Math.abs(row.paper)) * 100;
  return `${share > 0 ? "+" : ""}${number(+share.toPrecision(2))} %`;
}

/** One scale for all rows of a signal, zero included. */
function extents(rows) {
  const found = new Map();
  for (const row of rows) {
    const extent = found.get(row.signal) ?? { least: 0, greatest: 1e-300 };
    for (const value of [row.paper, row.ours]) {
      extent.least = Math.min(extent.least, value ?? 0);
      extent.greatest = Math.max(extent.greatest, value ?? 0);
    }
    found.set(row.signal, extent);
  }
  return found;
}

function table(rows, title) {
  const names = varying(rows);
  const scales = extents(rows);
  const heads = [...names, title, "paper", "ours", "difference", "paper and ours", ""];
  const lines = rows.map((row) => {
    const cells = [...names.map((name) => row.set[name] ?? ""), row.signal,
                   short(row.paper), withUnit(short(row.ours), row.unit), difference(row)];
    return element("tr", { className: row.ok ? "" : "bad" },
                   ...cells.map((cell) => element("td", {}, cell)), bars(row, scales.get(row.signal)),
                   element("td", {}, row.ok ? "" : "FAILED"));
  });
  return element("table", { className: "study" },
                 element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {}, head)))),
                 element("tbody", {}, ...lines));
}

/** A study's table, the paper's figures beside ours, as numbers and as bars; then its claims. */
export function showStudy(parent, study) {
  const section = element("section", { className: "wide" }, element("h2", {}, study.title),
    element("p", { className: study.ok ? "good" : "bad" },
            study.ok ? "all bounds hold" : "some bounds do not hold"),
    element("p", { className: "key" }, element("span", { className: "bar paper" }), "paper",
            element("span", { className: "bar ours" }), "ours; one scale for each signal"));
  if (study.rows.length > 0) section.append(table(study.rows, "signal"));
  if (study.claims.length > 0) section.append(table(study.claims, "claim"));
  for (const text of [...(study.deviations ?? []), ...(study.faults ?? [])])
    section.append(element("p", { className: "bad" }, text));
  parent.append(section);
}
