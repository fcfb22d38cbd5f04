const format = (digits) =>
  new Intl.NumberFormat("en", { maximumSignificantDigits: digits, useGrouping: false });
/** Nine digits. */
export const exact = format(9);
const rounded = format(6);

/** A number as a person reads it, to six digits. */
export function number(value, formatted = rounded) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e12)) return value.toExponential(3).replace("-", "−");
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
  return size >= 1e-3 ? `${number(seconds * 1e3, exact)} ms` : `${number(seconds * 1e6, exact)} µs`;
}

/** What one sample of a signal says. */
export function sample(signal, value) {
  if (signal.type === "boolean" && !Number.isNaN(value)) return value ? "true" : "false";
  return signal.names?.[value] ?? number(value);
}

export const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);
