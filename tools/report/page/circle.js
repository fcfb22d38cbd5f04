/**
 * The circle that fits points best, algebraic least squares: x² + y² = 2 a x + 2 b y + c with centre
 * (a, b) and radius √(c + a² + b²). `use(i)` picks the points. Null when they lie on a line.
 */
export function fitCircle(xs, ys, use = () => true) {
  let [n, mx, my] = [0, 0, 0];
  for (let i = 0; i < xs.length; ++i) {
    if (!use(i)) continue;
    n += 1;
    mx += xs[i];
    my += ys[i];
  }
  if (n < 3) return null;
  [mx, my] = [mx / n, my / n];
  let [uu, uv, vv, uz, vz, z] = [0, 0, 0, 0, 0, 0];
  for (let i = 0; i < xs.length; ++i) {
    if (!use(i)) continue;
    const [u, v] = [xs[i] - mx, ys[i] - my];
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
export const band = 0.05;

/**
 * The deviation from the circle, sample by sample; not a number where a sample lies elsewhere, or
 * where `condition`, if there is one, is not true.
 */
export function deviations(circle, { x, y, condition }) {
  return x.map((value, i) => {
    const by = condition && condition[i] !== 1 ? NaN : deviation(circle, value, y[i]);
    return Math.abs(by) <= band * circle.radius ? by : NaN;
  });
}

/**
 * The circle that most of a path lies on, whatever the rest of the path is: a fit, repeated without
 * what lies farther from it than most. Null when the path is no circle.
 */
export function findCircle(path) {
  const every = Math.ceil(path.x.length / 5000);
  const [xs, ys] = [path.x, path.y].map((values) => values.filter((_, i) => i % every === 0));
  let circle = fitCircle(xs, ys);
  for (let round = 0; circle && round < 20; ++round) {
    const sizes = xs.map((x, i) => Math.abs(deviation(circle, x, ys[i])));
    const middle = Float64Array.from(sizes).sort()[sizes.length >> 1];
    const limit = Math.max(3 * middle, 1e-9 * circle.radius);
    circle = fitCircle(xs, ys, (i) => sizes[i] <= limit);
  }
  if (!circle) return null;
  const on = deviations(circle, { x: xs, y: ys }).filter((value) => !Number.isNaN(value)).length;
  return on > xs.length / 2 ? circle : null;
}

/** The circle that was meant: the found one with its centre and radius rounded to 1 % of the radius. */
export function nominal({ x, y, radius }) {
  const grain = 10 ** Math.floor(Math.log10(radius) - 1);
  const round = (value) => Math.round(value / grain) * grain + 0;
  return { x: round(x), y: round(y), radius: round(radius) };
}

/** Of the samples [first, end): offset of the fitted centre, mean and greatest |deviation|. */
export function figures(circle, track, on, [first, end]) {
  const use = (i) => i >= first && i < end && !Number.isNaN(on[i]);
  const fitted = fitCircle(track.x, track.y, use);
  let [count, sum, worst] = [0, 0, -1];
  on.forEach((value, i) => {
    if (!use(i)) return;
    count += 1;
    sum += Math.abs(value);
    if (worst < 0 || Math.abs(value) > Math.abs(on[worst])) worst = i;
  });
  if (!fitted || count === 0) return null;
  const offset = Math.hypot(fitted.x - circle.x, fitted.y - circle.y);
  return { fitted, offset, mean: sum / count, worst: { x: track.x[worst], y: track.y[worst], value: on[worst] } };
}
