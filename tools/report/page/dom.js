/** An element with properties and children: `element("td", {className: "name"}, "x")`. */
export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** A table row of cells. */
export const row = (...cells) => element("tr", {}, ...cells.map((cell) => element("td", {}, cell)));

/** Calls `task` at the next frame, once however often it is asked for until then. */
export function nextFrame(task) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      task();
    });
  };
}

/** Calls `task` a moment after the next frame, once nobody asks for it: for what may follow the curves. */
export function afterwards(task) {
  let waiting = 0;
  const wait = nextFrame(() => { waiting = setTimeout(task, 150); });
  return () => {
    clearTimeout(waiting);
    wait();
  };
}

const colours = new Map();

/** A colour of page.css, in the theme that is shown. A browser takes its time to say it. */
export function colour(name) {
  const root = document.documentElement;
  const key = `${root.dataset.theme} ${name}`;
  if (!colours.has(key)) colours.set(key, getComputedStyle(root).getPropertyValue(`--${name}`).trim());
  return colours.get(key);
}

export const palette = (index) => colour(`line-${index % 8}`);

/** The dashes that tell curves apart, for those who do not tell colours apart. */
export const dashes = (index) => [[], [7, 4], [2, 3], [9, 3, 2, 3], [14, 4], [1, 2], [9, 3, 2, 3, 2, 3], [4, 4]][index % 8];

/** A short line in the colour and the dashes of curves; it changes with the theme. */
export const stroke = (colourIndex, dash) =>
  element("span", { className: "swatch",
                    innerHTML: `<svg width="26" height="10" aria-hidden="true"><line x1="0" y1="5" x2="26" y2="5"
                      stroke="var(--line-${colourIndex % 8})" stroke-width="2" stroke-dasharray="${dashes(dash).join(" ")}"/></svg>` });
