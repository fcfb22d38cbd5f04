import { Blocks } from "#page/samples";

/** Samples that are worked out of others: `fill(first, values)` writes those from `first` on. */
class Worked extends Blocks {
  constructor(length, unit, fill) {
    super(length);
    this.unit = unit;
    this.read = fill;
  }
}

const anyUnit = null; // of a plain number

/** Of what is added, or compared: one for all. */
function sameUnit(parts) {
  const units = [...new Set(parts.map(({ unit }) => unit).filter((unit) => unit !== anyUnit))];
  if (units.length > 1) throw new Error(`${units.map((unit) => unit || "a number without a unit").join(" and ")} cannot be put together`);
  return units.length === 0 ? anyUnit : units[0];
}

const productUnit = (a, b) => (a && b ? `${a}·${b}` : a || b);
const quotientUnit = (a, b) => (a === b ? "" : b ? `${a || "1"}/${b}` : a);

/** mm -> mm/s -> mm/s^2. */
function rateUnit(unit) {
  if (!unit) return "1/s";
  const [, of, power] = /^(.*)\/s(?:\^(\d))?$/.exec(unit) ?? [null, unit, 0];
  const next = Number(power ?? 1) + 1;
  return next === 1 ? `${of}/s` : `${of}/s^${next}`;
}

/** Of a plain number; an angle in rad is one. */
function plain(work) {
  const unit = (of) => {
    if (of && of !== "rad") throw new Error(`a plain number is needed here, not ${of}`);
    return "";
  };
  return { values: 1, work: ([a]) => work(a), unit };
}

const functions = {
  ...Object.fromEntries(["sin", "cos", "tan", "asin", "acos", "atan", "exp"].map((name) => [name, plain(Math[name])])),
  ln: plain(Math.log),
  abs: { values: 1, work: ([a]) => Math.abs(a) },
  sqrt: { values: 1, work: ([a]) => Math.sqrt(a), unit: (unit) => (unit ? `√(${unit})` : "") },
  min: { work: (all) => Math.min(...all) },
  max: { work: (all) => Math.max(...all) },
  mean: { work: (all) => all.reduce((sum, value) => sum + value, 0) / all.length },
};

/**
 * Reads what runtime/source/formula.cpp reads, over samples: + - * /, parentheses, numbers, names,
 * pi, abs, sqrt, exp, ln, sin and its like, min, max, mean, and derivative(x), the change since the sample before by time.
 */
class Reader {
  #at = 0;

  /** `signal(name)` is { values, unit } or undefined. */
  constructor(text, times, signal) {
    Object.assign(this, { text, times, signal });
  }

  whole() {
    const made = this.#sum();
    if (this.#peek() !== "") throw new Error(`'${this.#peek()}' is not expected here`);
    return made;
  }

  #peek() {
    while (this.text[this.#at] === " ") ++this.#at;
    return this.text[this.#at] ?? "";
  }

  #take(letter) {
    if (this.#peek() !== letter) return false;
    ++this.#at;
    return true;
  }

  #expect(letter) {
    if (!this.#take(letter)) throw new Error(`'${letter}' is missing`);
  }

  #sum() {
    let made = this.#product();
    while (true) {
      if (this.#take("+")) made = this.#two(made, this.#product(), sameUnit, (a, b) => a + b);
      else if (this.#take("-")) made = this.#two(made, this.#product(), sameUnit, (a, b) => a - b);
      else return made;
    }
  }

  #product() {
    let made = this.#factor();
    const units = (combine) => ([a, b]) => combine(a.unit ?? "", b.unit ?? "");
    while (true) {
      if (this.#take("*")) made = this.#two(made, this.#factor(), units(productUnit), (a, b) => a * b);
      else if (this.#take("/")) made = this.#two(made, this.#factor(), units(quotientUnit), (a, b) => a / b);
      else return made;
    }
  }

  #factor() {
    if (this.#take("-")) return this.#all([this.#factor()], ([a]) => -a);
    if (this.#take("(")) {
      const made = this.#sum();
      this.#expect(")");
      return made;
    }
    this.#peek();
    const number = /^(\d+\.?\d*|\.\d+)(e[+-]?\d+)?/i.exec(this.text.slice(this.#at))?.[0];
    if (number) {
      this.#at += number.length;
      return new Worked(this.times.length, anyUnit, (_, values) => values.fill(Number(number)));
    }
    return this.#name();
  }

  #name() {
    const name = /^[\p{L}_][\p{L}\d_.]*/u.exec(this.text.slice(this.#at))?.[0];
    if (!name) throw new Error("a number, a name or '(' is expected here");
    this.#at += name.length;
    if (this.#take("(")) return this.#call(name);
    const signal = this.signal(name);
    if (!signal && name === "pi") return new Worked(this.times.length, anyUnit, (_, values) => values.fill(Math.PI));
    if (!signal) throw new Error(`there is no signal '${name}'`);
    return new Worked(this.times.length, signal.unit, (first, values) =>
      values.set(signal.values.block(first).values));
  }

  #call(name) {
    const parts = [this.#sum()];
    while (this.#take(",")) parts.push(this.#sum());
    this.#expect(")");
    if (name === "derivative" && parts.length === 1) return this.#derivative(parts[0]);
    const known = functions[name];
    if (!known || (known.values && known.values !== parts.length))
      throw new Error(`there is no function '${name}' of ${parts.length}`);
    return this.#all(parts, known.work, known.unit);
  }

  #two(a, b, unit, work) {
    return new Worked(this.times.length, unit([a, b]), (first, values) => {
      const [left, right] = [a.block(first).values, b.block(first).values];
      for (let i = 0; i < values.length; ++i) values[i] = work(left[i], right[i]);
    });
  }

  #all(parts, work, unit = (same) => same) {
    return new Worked(this.times.length, unit(sameUnit(parts)), (first, values) => {
      const blocks = parts.map((part) => part.block(first).values);
      for (let i = 0; i < values.length; ++i) values[i] = work(blocks.map((block) => block[i]));
    });
  }

  #derivative(of) {
    return new Worked(this.times.length, rateUnit(of.unit), (first, values) => {
      let [before, time] = first > 0 ? [of.at(first - 1), this.times.at(first - 1)] : [NaN, NaN];
      const [samples, times] = [of.block(first).values, this.times.block(first).values];
      for (let i = 0; i < values.length; ++i) {
        values[i] = (samples[i] - before) / (times[i] - time);
        [before, time] = [samples[i], times[i]];
      }
    });
  }
}

/** A curve of a run: a signal like those of its trace. Throws an error that says what is wrong. */
export function curveOf(name, formula, run) {
  const values = new Reader(formula, run.times, (wanted) =>
    run.signals.find((signal) => signal.name === wanted && signal.type !== "enumeration")).whole();
  return { name, formula, unit: values.unit ?? "", type: "real", values };
}
