// Puts page/ and uPlot into one page and writes its bytes for the compiler:
//   node bundle.mjs OUTPUT.inc
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const folder = fileURLToPath(new URL(".", import.meta.url));
const read = (path) => readFileSync(folder + path, "utf8");
const uplot = (path) => read(`node_modules/uplot/${path}`);

/** `#page/plot` -> the module's text as a data: address, so that one file holds all modules. */
function modules() {
  const imports = {};
  for (const name of readdirSync(`${folder}page`).filter((each) => each.endsWith(".js")).sort()) {
    const text = Buffer.from(read(`page/${name}`)).toString("base64");
    imports[`#page/${name.slice(0, -3)}`] = `data:text/javascript;base64,${text}`;
  }
  return JSON.stringify({ imports });
}

const { version } = JSON.parse(uplot("package.json"));
const parts = {
  licence: `Curves are drawn by uPlot ${version}, under its licence:\n\n${uplot("LICENSE")}`,
  style: uplot("dist/uPlot.min.css") + read("page/page.css"),
  uplot: uplot("dist/uPlot.iife.min.js"),
  modules: modules(),
};
const page = read("page/page.html").replace(/\{\{(\w+)\}\}/g, (marker, name) => parts[name] ?? marker);
writeFileSync(process.argv[2], `${Buffer.from(page).join(",").replace(/(.{1,95},)/g, "$1\n")}\n`);
