/** How far a point is from a line through points, `[[x, y], ...]`. */
export function distance(line, x, y) {
  let least = Infinity;
  for (let i = 0; i < line.length; ++i) {
    const [ax, ay] = line[Math.max(i - 1, 0)];
    const [bx, by] = line[i];
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const share = square > 0 ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / square, 0), 1) : 0;
    const [u, v] = [x - ax - share * dx, y - ay - share * dy];
    least = Math.min(least, u * u + v * v);
  }
  return Math.sqrt(least);
}

/** The point of a path that is farthest from the line; null where the path has none. */
export function farthest(line, { x, y }) {
  let worst = null;
  for (let i = 0; i < x.length; ++i) {
    const away = distance(line, x[i], y[i]);
    if (!worst || away > worst.away) worst = { away, x: x[i], y: y[i] };
  }
  return worst;
}
