import { element } from "#page/dom";
import { number, withUnit } from "#page/format";
import { matrices, range, short, spansDecades, varying } from "#page/matrix";

/** A bar from zero, on the side that its value asks for; of a logarithmic scale from its least end. */
function bar(kind, value, extent) {
  const at = (x) => (100 * (extent.place(x) - extent.least)) / (extent.greatest - extent.least);
  const [from, to] = [extent.isLog ? 0 : at(0), at(value)];
  return element("div", { className: `bar ${kind}`, title: `${kind} ${number(value)}`,
                          style: `left: ${Math.min(from, to)}%; width: ${Math.abs(to - from)}%` });
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

/** One scale for all rows of a signal: zero included, or from half of the least on by decades. */
function extents(rows) {
  const found = new Map();
  for (const signal of new Set(rows.map((row) => row.signal))) {
    const values = rows.filter((row) => row.signal === signal).flatMap(({ paper, ours }) => [paper, ours]).filter((value) => value !== null);
    const isLog = spansDecades(values);
    const ends = isLog ? [Math.min(...values) / 2, Math.max(...values)] : [Math.min(0, ...values), Math.max(1e-300, ...values)];
    const place = isLog ? Math.log : (value) => value;
    found.set(signal, { isLog, place, least: place(ends[0]), greatest: place(ends[1]) });
  }
  return found;
}

/** The columns of a table that have anything in them. */
function columnsOf(rows, title, scales) {
  const hasPaper = rows.some(({ paper }) => paper !== null);
  const signal = (row) => (scales.get(row.signal).isLog ? [row.signal, element("span", { className: "range" }, " log")] : [row.signal]);
  return [
    ...varying(rows).map((name) => [name, (row) => [row.set[name] ?? ""]]),
    [title, signal],
    ...(hasPaper ? [["paper", (row) => [row.paper === null ? "" : short(row.paper)]]] : []),
    ["ours", (row) => [withUnit(short(row.ours), row.unit)]],
    ...(hasPaper ? [["difference", (row) => [difference(row)]]] : []),
    ...(rows.some(range) ? [["least .. greatest", (row) => [range(row)]]] : []),
  ];
}

function table(rows, title) {
  const scales = extents(rows);
  const columns = columnsOf(rows, title, scales);
  const anyFailed = rows.some(({ ok }) => !ok);
  const lines = rows.map((row) =>
    element("tr", { className: row.ok ? "" : "bad" }, ...columns.map(([, cell]) => element("td", {}, ...cell(row))),
            bars(row, scales.get(row.signal)), ...(anyFailed ? [element("td", {}, row.ok ? "" : "FAILED")] : [])));
  const heads = [...columns.map(([head]) => head), "", ...(anyFailed ? [""] : [])];
  return element("table", { className: "study" },
                 element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {}, head)))),
                 element("tbody", {}, ...lines));
}

function key(rows) {
  const parts = [element("span", { className: "bar ours" }), "ours; one scale for each signal"];
  if (rows.some(({ paper }) => paper !== null)) parts.unshift(element("span", { className: "bar paper" }), "paper");
  if ([...extents(rows).values()].some(({ isLog }) => isLog)) parts.push("; log: logarithmic, from half of the least");
  return element("p", { className: "key" }, ...parts);
}

/** A study's title and whether it holds; of one that is folded the tables appear when that is clicked. */
function head(study, isFolded) {
  const said = { className: study.ok ? "good" : "bad" };
  const verdict = study.ok ? "all bounds hold" : "some bounds do not hold";
  if (!isFolded) return element("section", { className: "wide" }, element("h2", {}, study.title), element("p", said, verdict));
  return element("details", { className: "wide folded" },
                 element("summary", {}, element("b", {}, study.title), ": ", element("span", said, verdict)));
}

/** A study's matrices, or its rows with the paper's figures beside ours and as bars; then its claims. */
export function showStudy(parent, study, isFolded) {
  const section = head(study, isFolded);
  for (const note of study.notes ?? []) section.append(element("p", { className: "note" }, note));
  const tables = matrices(study.rows);
  section.append(...tables);
  if (study.rows.length > 0) {
    const rows = [key([...study.rows, ...study.claims]), table(study.rows, "signal")];
    section.append(...(tables.length > 0
      ? [element("details", {}, element("summary", {}, "the same as rows"), ...rows)] : rows));
  }
  if (study.claims.length > 0) section.append(table(study.claims, "claim"));
  for (const text of [...(study.deviations ?? []), ...(study.faults ?? [])])
    section.append(element("p", { className: "bad" }, text));
  parent.append(section);
}
