// Puts page/, or page/ and live/, and uPlot into one page and writes its bytes for the compiler:
//   node bundle.mjs page|live OUTPUT.inc
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const [, , which, output] = process.argv;
const folder = fileURLToPath(new URL(".", import.meta.url));
const folders = which === "live" ? ["page", "live"] : ["page"];
const read = (path) => readFileSync(folder + path, "utf8");
const uplot = (path) => read(`node_modules/uplot/${path}`);

/** `#page/plot` -> the module's text as a data: address, so that one file holds all modules. */
function modules() {
  const imports = {};
  for (const part of folders)
    for (const name of readdirSync(folder + part).filter((each) => each.endsWith(".js")).sort()) {
      const text = Buffer.from(read(`${part}/${name}`)).toString("base64");
      imports[`#${part}/${name.slice(0, -3)}`] = `data:text/javascript;base64,${text}`;
    }
  return JSON.stringify({ imports });
}

const { version } = JSON.parse(uplot("package.json"));
const parts = {
  which,
  title: which === "live" ? "lineshaft" : "{{title}}",
  body: read(`${which}/${which}.html`),
  licence: `Curves are drawn by uPlot ${version}, under its licence:\n\n${uplot("LICENSE")}`,
  style: uplot("dist/uPlot.min.css") + folders.map((part) => read(`${part}/${part}.css`)).join(""),
  uplot: uplot("dist/uPlot.iife.min.js"),
  modules: modules(),
};
const page = read("page/frame.html").replace(/\{\{(\w+)\}\}/g, (marker, name) => parts[name] ?? marker);
writeFileSync(output, `${Buffer.from(page).join(",").replace(/(.{1,95},)/g, "$1\n")}\n`);
