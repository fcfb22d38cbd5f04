const format = (digits) =>
  new Intl.NumberFormat("en", { maximumSignificantDigits: digits, useGrouping: false });
/** Nine digits. */
export const exact = format(9);
const rounded = format(6);

/** A number as a person reads it, to six digits. */
export function number(value, formatted = rounded) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e12))
    return (+value.toPrecision(4)).toExponential().replaceAll("-", "−");
  return formatted.format(value).replace("-", "−");
}

/** A number beside an axis: with all digits that tell it from its neighbours. */
export function tick(value) {
  const size = Math.abs(value);
  const text = size !== 0 && size < 1e-4 ? (+value.toPrecision(9)).toExponential() : exact.format(value);
  return text.replaceAll("-", "−");
}

/** A time in the unit that suits it. */
export function duration(seconds) {
  const size = Math.abs(seconds);
  if (size === 0 || size >= 1) return `${number(seconds, exact)} s`;
  if (size >= 1e-3) return `${number(seconds * 1e3, exact)} ms`;
  return size >= 1e-6 ? `${number(seconds * 1e6, exact)} µs` : `${number(seconds * 1e9, exact)} ns`;
}

/** A rate in the unit that suits it, to four digits. */
export function frequency(hertz) {
  const [unit, factor] = [["MHz", 1e6], ["kHz", 1e3], ["Hz", 1]].find(([, f]) => hertz >= f) ?? ["mHz", 1e-3];
  return `${number(+(hertz / factor).toPrecision(4))} ${unit}`;
}

const secondsIn = { s: 1, ms: 1e-3, us: 1e-6, µs: 1e-6, ns: 1e-9 };

/** Whether values of this unit are durations. */
export const isTime = (unit) => unit in secondsIn;

/** Durations beside an axis, all in the unit that suits the greatest: `0 ms`, `500 ms`. */
export function timeTicks(values, unit) {
  const greatest = Math.max(...values.map(Math.abs)) * secondsIn[unit];
  const shown = ["s", "ms", "µs", "ns"].find((each) => greatest >= secondsIn[each] * (1 - 1e-9)) ?? "s";
  const factor = secondsIn[unit] / secondsIn[shown];
  return values.map((value) => `${tick(+(value * factor).toPrecision(12))} ${shown}`);
}

/** The numbers of an enumeration's names. */
export const numbersOf = ({ names, numbers }) => numbers ?? names.map((_, place) => place);

/** Where the name of an enumeration's number stands in the list. */
const placeOf = ({ numbers }, value) => (numbers ? numbers.indexOf(value) : value);

/** Numbers with their first names, from the least on. */
export const statesOf = (signal) =>
  numbersOf(signal).map((value, place) => ({ value, name: signal.names[place] }))
    .filter(({ value }, place, all) => all.findIndex((other) => other.value === value) === place)
    .sort((a, b) => a.value - b.value);

/** What one sample of a signal says. */
export function sample(signal, value) {
  if (isTime(signal.unit) && !Number.isNaN(value)) return duration(value * secondsIn[signal.unit]);
  if (signal.type === "boolean" && !Number.isNaN(value)) return value ? "true" : "false";
  return signal.names?.[placeOf(signal, value)] ?? number(value);
}

export const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);
