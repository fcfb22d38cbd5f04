const root = document.documentElement;
const system = matchMedia("(prefers-color-scheme: dark)");

const apply = (theme) => {
  root.dataset.theme = theme;
};

/** Follows the system's choice until the button is pressed; `changed` is called after each change. */
export function followTheme(button, changed) {
  let chosen = false;
  const set = (theme) => {
    apply(theme);
    changed();
  };
  apply(system.matches ? "dark" : "light");
  system.addEventListener("change", () => {
    if (!chosen) set(system.matches ? "dark" : "light");
  });
  button.addEventListener("click", () => {
    chosen = true;
    set(root.dataset.theme === "dark" ? "light" : "dark");
  });
}
