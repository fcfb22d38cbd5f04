import { element } from "#page/dom";
import { exact, number, withUnit } from "#page/format";

const mostNumbers = 16; // columns beside each other that have room for numbers
const decades = 100; // greatest over least value from which on a scale is logarithmic
const strongest = 45; // percent of colour behind a number that can still be read

/** Four digits; whole numbers as they are. */
export const short = (value) =>
  value === null ? "–" : number(Number.isInteger(value) ? value : +value.toPrecision(4), exact);

/** The settings that differ between the rows of a study. */
export function varying(rows) {
  const names = [...new Set(rows.flatMap(({ set }) => Object.keys(set)))];
  return names.filter((name) => new Set(rows.map(({ set }) => set[name])).size > 1);
}

/** Whether values are told apart by their logarithms only. */
export function spansDecades(values) {
  const sizes = values.filter((value) => value !== null);
  return sizes.length > 1 && sizes.every((value) => value > 0) && Math.max(...sizes) >= decades * Math.min(...sizes);
}

/** Where a value lies between the least and the greatest, 0 to 1. */
export function scaleOf(values) {
  const known = values.filter((value) => value !== null);
  const isLog = spansDecades(known);
  const place = (value) => (isLog ? Math.log(value) : value);
  const [low, high] = [place(Math.min(...known)), place(Math.max(...known))];
  return { isLog, of: (value) => (high > low ? (place(value) - low) / (high - low) : 0) };
}

/** The least and the greatest of repeats. */
export const range = (row) =>
  row.least === undefined ? "" : `${short(row.least)} .. ${short(row.greatest)}`;

function cell(row, scale, where) {
  if (!row) return element("td", {}, "");
  const made = element("td", { className: row.ok ? "" : "bad", title: `${where}: ${withUnit(short(row.ours), row.unit)}` },
                       short(row.ours));
  if (row.ours !== null) made.style.setProperty("--heat", `${(strongest * scale.of(row.ours)).toFixed(1)}%`);
  if (range(row)) made.append(element("div", { className: "range" }, range(row)));
  return made;
}

function table(caption, heads, lines, isDense) {
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col" }, text)));
  const made = element("table", { className: isDense ? "matrix dense" : "matrix" }, element("caption", {}, caption),
                       element("thead", {}, head), element("tbody", {}, ...lines));
  return element("div", { className: "scroll", tabIndex: 0 }, made);
}

const describe = (signal, unit, scale) =>
  `${withUnit(signal, unit && `[${unit}]`)}; ${scale.isLog ? "the colour goes with the logarithm" : "the deeper the colour, the greater"}`;

/** One signal, a setting downwards and the others across; null unless the rows are all combinations. */
function matrix(rows, names) {
  const across = names.slice(1);
  const columnOf = ({ set }) => across.map((name) => set[name] ?? "").join(", ");
  const rowOf = ({ set }) => set[names[0]] ?? "";
  const cells = new Map(rows.map((row) => [`${rowOf(row)}\n${columnOf(row)}`, row]));
  const [down, columns] = [rowOf, columnOf].map((of) => [...new Set(rows.map(of))]);
  if (cells.size !== rows.length || rows.length !== down.length * columns.length || down.length < 2 || columns.length < 2) return null;
  const scale = scaleOf(rows.map(({ ours }) => ours));
  const lines = down.map((name) => element("tr", {}, element("th", { scope: "row" }, name),
    ...columns.map((column) => cell(cells.get(`${name}\n${column}`), scale, `${names[0]} ${name}, ${across.join(", ")} ${column}`))));
  return table(describe(rows[0].signal, rows[0].unit, scale), [`${names[0]} \\ ${across.join(", ")}`, ...columns], lines,
               columns.length > mostNumbers);
}

/** A row a case, a column a signal. */
function wide(bySignal, names) {
  const signals = [...bySignal.keys()];
  const scales = signals.map((signal) => scaleOf(bySignal.get(signal).map(({ ours }) => ours)));
  const cases = [...new Set([...bySignal.values()].flat().map((row) => row.case))];
  const lines = cases.map((number) => {
    const own = signals.map((signal) => bySignal.get(signal).find((row) => row.case === number));
    const { set, name } = own.find(Boolean);
    const titles = names.length > 0 ? names.map((each) => set[each] ?? "") : [name];
    return element("tr", {}, ...titles.map((title) => element("th", { scope: "row" }, title)),
                   ...own.map((row, k) => cell(row, scales[k], `${titles.join(", ")}, ${signals[k]}`)));
  });
  const units = signals.map((signal) => withUnit(signal, bySignal.get(signal)[0].unit && `[${bySignal.get(signal)[0].unit}]`));
  const logs = signals.filter((_, k) => scales[k].isLog);
  const caption = `the deeper the colour, the greater in its column${logs.length > 0 ? `; by the logarithm: ${logs.join(", ")}` : ""}`;
  return table(caption, [...(names.length > 0 ? names : ["case"]), ...units], lines, false);
}

function grouped(rows) {
  const signals = [...new Set(rows.map(({ signal }) => signal))];
  return new Map(signals.map((signal) => [signal, rows.filter((row) => row.signal === signal)]));
}

/** Tables of cases without a paper's values; none when rows one below the other say as much. */
export function matrices(rows) {
  const names = varying(rows);
  const bySignal = grouped(rows);
  if (rows.some(({ paper }) => paper !== null) || rows.length < 2) return [];
  const made = names.length > 1 ? [...bySignal.values()].map((own) => matrix(own, names)) : [null];
  if (made.every(Boolean)) return made;
  return bySignal.size > 1 ? [wide(bySignal, names)] : [];
}
