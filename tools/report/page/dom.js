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

/** Calls `task` once nobody has asked for it for a moment: for what may come after the curves. */
export function afterwards(task) {
  let waiting = 0;
  return () => {
    clearTimeout(waiting);
    waiting = setTimeout(task, 150);
  };
}

/** A colour of page.css, in the theme that is shown. */
export const colour = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

export const palette = (index) => colour(`line-${index % 8}`);

/** The dashes that tell the runs of one page apart. */
export const dashes = (run) => [[], [7, 4], [2, 3], [9, 3, 2, 3]][run % 4];
