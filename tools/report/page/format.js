const digits = new Intl.NumberFormat("en", { maximumSignificantDigits: 8, useGrouping: false });

/** A number as a person reads it, to eight digits. */
export function number(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e9)) return value.toExponential(4).replace("-", "−");
  return digits.format(value).replace("-", "−");
}

/** A time in the unit that suits it. */
export function duration(seconds) {
  const size = Math.abs(seconds);
  if (size === 0 || size >= 1) return `${number(seconds)} s`;
  return size >= 1e-3 ? `${number(seconds * 1e3)} ms` : `${number(seconds * 1e6)} µs`;
}

/** What one sample of a signal says. */
export function sample(signal, value) {
  if (signal.type === "boolean" && !Number.isNaN(value)) return value ? "true" : "false";
  return signal.names?.[value] ?? number(value);
}

export const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);
