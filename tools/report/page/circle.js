import { Blocks } from "#page/samples";

/**
 * The circle that fits points best, algebraic least squares: x² + y² = 2 a x + 2 b y + c with centre
 * (a, b) and radius √(c + a² + b²). `use(i)` picks from the points [first, end). Null when they lie on
 * a line.
 */
export function fitCircle(xs, ys, use = () => true, [first, end] = [0, xs.length]) {
  let [n, mx, my] = [0, 0, 0];
  for (let i = first; i < end; ++i) {
    if (!use(i)) continue;
    n += 1;
    mx += xs.at(i);
    my += ys.at(i);
  }
  if (n < 3) return null;
  [mx, my] = [mx / n, my / n];
  let [uu, uv, vv, uz, vz, z] = [0, 0, 0, 0, 0, 0];
  for (let i = first; i < end; ++i) {
    if (!use(i)) continue;
    const [u, v] = [xs.at(i) - mx, ys.at(i) - my];
    const square = u * u + v * v;
    uu += u * u;
    uv += u * v;
    vv += v * v;
    uz += u * square;
    vz += v * square;
    z += square;
  }
  const determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-12 * (uu + vv) ** 2)) return null;
  const a = (uz * vv - vz * uv) / determinant / 2;
  const b = (vz * uu - uz * uv) / determinant / 2;
  return { x: mx + a, y: my + b, radius: Math.sqrt(z / n + a * a + b * b) };
}

/** Distance of a point from the circle, above 0 outside; Math.hypot takes several times as long. */
export function deviation(circle, x, y) {
  const [u, v] = [x - circle.x, y - circle.y];
  return Math.sqrt(u * u + v * v) - circle.radius;
}

/** Samples farther from the circle than this share of its radius do not belong to it. */
const band = 0.05;

export const isNear = (circle, x, y) => Math.abs(deviation(circle, x, y)) <= band * circle.radius;

/**
 * The deviation from the circle, sample by sample; not a number where a sample lies elsewhere, or
 * where `condition`, if there is one, is not true.
 */
export class Deviations extends Blocks {
  constructor(circle, { x, y, condition }) {
    super(x.length);
    Object.assign(this, { circle, x, y, condition });
  }

  read(first, values) {
    const [x, y, condition] = [this.x, this.y, this.condition].map((each) => each?.block(first).values);
    const { x: a, y: b, radius } = this.circle; // no call for each sample: it takes a browser several times as long
    for (let i = 0; i < values.length; ++i) {
      const u = x[i] - a;
      const v = y[i] - b;
      const by = Math.sqrt(u * u + v * v) - radius;
      values[i] = Math.abs(by) <= band * radius ? by : NaN;
    }
    if (condition) for (let i = 0; i < values.length; ++i) if (condition[i] !== 1) values[i] = NaN;
  }
}

/**
 * The circle that most of a path lies on, whatever the rest of the path is: a fit, repeated without
 * what lies farther from it than most. Null when the path is no circle.
 */
export function findCircle(path) {
  const every = Math.ceil(path.x.length / 2000);
  const length = Math.ceil(path.x.length / every);
  const [xs, ys] = [path.x, path.y].map((values) =>
    Float64Array.from({ length }, (_, i) => values.at(i * every)));
  let circle = fitCircle(xs, ys);
  let last = null;
  for (let round = 0; circle && circle.radius !== last?.radius && round < 20; ++round) {
    last = circle;
    const sizes = xs.map((x, i) => Math.abs(deviation(circle, x, ys[i])));
    const middle = Float64Array.from(sizes).sort()[sizes.length >> 1];
    const limit = Math.max(3 * middle, 1e-9 * circle.radius);
    circle = fitCircle(xs, ys, (i) => sizes[i] <= limit);
  }
  if (!circle) return null;
  const on = xs.filter((x, i) => isNear(circle, x, ys[i]));
  return on.length > length / 2 ? circle : null;
}

/** The circle that was meant: the found one with its centre and radius rounded to 1 % of the radius. */
export function nominal({ x, y, radius }) {
  const grain = 10 ** Math.floor(Math.log10(radius) - 1);
  const round = (value) => Math.round(value / grain) * grain + 0;
  return { x: round(x), y: round(y), radius: round(radius) };
}

/** Of the samples [first, end): offset of the fitted centre, mean and greatest |deviation|. */
export function figures(circle, track, on, [first, end]) {
  const fitted = fitCircle(track.x, track.y, (i) => !Number.isNaN(on.at(i)), [first, end]);
  let [count, sum, worst, greatest] = [0, 0, -1, -1];
  for (let i = first; i < end; ++i) {
    const size = Math.abs(on.at(i));
    if (Number.isNaN(size)) continue;
    count += 1;
    sum += size;
    if (size > greatest) [worst, greatest] = [i, size];
  }
  if (!fitted || count === 0) return null;
  const offset = Math.hypot(fitted.x - circle.x, fitted.y - circle.y);
  return { fitted, offset, mean: sum / count, worst: { x: track.x.at(worst), y: track.y.at(worst), value: on.at(worst) } };
}
