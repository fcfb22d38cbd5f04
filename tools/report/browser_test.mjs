// Loads pages that `lineshaft report` made from files into a headless Chromium and uses them.
//   node browser_test.mjs LINESHAFT PROJECT FOLDER [--bars]
// Pages and screenshots go to FOLDER; --bars also holds the drawing times against their bars, which
// needs a quiet machine. Exit 77: no Chromium, nothing tested.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { unpack } from "#page/decode";
import { slicedValues, slices } from "#page/samples";
import { colouredPixels, frame, withBrowser } from "./browser.mjs";

const [lineshaft, project, folder] = process.argv.slice(2, 5).map((path) => resolve(path));
const bars = process.argv[5];

/** Runs lineshaft; its exit code may be 1 where an expectation is meant to fail. */
function run(...command) {
  try {
    execFileSync(lineshaft, command, { cwd: project, stdio: ["ignore", "ignore", "pipe"] });
  } catch (error) {
    if (error.status !== 1) throw new Error(`${command.join(" ")}: ${error.stderr}`);
  }
}

const file = (name) => join(folder, name);

function circle(name, ...settings) {
  const options = settings.flatMap((setting) => ["--set", setting]);
  run("run", "programs/paper/wei2025_circle.yaml", ...options, "--quiet", "--trace", file(name));
}

function report(name, ...command) {
  run("report", ...command, "-o", file(name));
  return pathToFileURL(file(name)).href;
}

async function open(browser, address, { colorScheme = "light", width = 1400, before = () => {} } = {}) {
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
  await page.addInitScript(before);
  page.problems = [];
  page.on("pageerror", (error) => page.problems.push(String(error)));
  page.on("console", (message) => message.type() === "error" && page.problems.push(message.text()));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) page.problems.push(`asked for ${request.url()}`);
  });
  await page.goto(address);
  await page.waitForFunction(() => performance.getEntriesByName("lineshaft:drawn").length > 0);
  return page;
}

const mark = (page, name) =>
  page.evaluate((n) => performance.getEntriesByName(n).at(-1).startTime, `lineshaft:${name}`);

const readout = (page) => page.textContent("#readout");
const rowOf = (page, signal) => page.locator(".legend tr", { hasText: signal }).first().locator("td").allTextContents();

async function testCurves(page) {
  const plots = await page.locator(".plot").count();
  for (let k = 0; k < plots; ++k) {
    const count = await colouredPixels(page, `.plot >> nth=${k} >> canvas`);
    assert.ok(count > 300, `plot ${k} has ${count} coloured pixels`);
  }
  const units = await page.locator(".legend").allTextContents();
  assert.ok(units.some((text) => text.includes("x.position")));
}

/** Another circle gives other deviations, and the first one the first again. */
async function testAnotherCircle(page) {
  const radius = page.locator(".controls input").last();
  const picture = () => page.locator(".plot canvas").nth(1).evaluate((canvas) => canvas.toDataURL());
  const change = async (value) => {
    await radius.fill(value);
    await radius.press("Enter");
    await page.evaluate(frame);
    await page.evaluate(frame);
    return picture();
  };
  const before = await picture();
  assert.ok(await change("20.01") !== before, "another radius, another deviation");
  assert.ok(await change("20") === before);
}

async function testCursors(page) {
  const before = await rowOf(page, "x.position");
  const line = page.locator(".cursor-A").nth(1);
  await line.scrollIntoViewIfNeeded();
  const box = await line.boundingBox();
  await page.mouse.move(box.x + 5, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 105, box.y + 60, { steps: 5 });
  await page.mouse.up();
  await page.evaluate(frame);
  const after = await rowOf(page, "x.position");
  assert.notEqual(after[2], before[2], "dragging cursor A changes its value");
  assert.equal(after[3], before[3], "and leaves B");
  await line.focus();
  const shown = await readout(page);
  assert.doesNotMatch(shown, /\de[+-]/, "people write no exponents");
  await page.keyboard.press("ArrowRight");
  await page.evaluate(frame);
  assert.notEqual(await readout(page), shown, "an arrow key moves the cursor by a sample");
  const number = (text) => Number(text.replace("−", "-"));
  const [, , a, b, difference] = (await rowOf(page, "x.position")).map(number);
  const sixDigits = 5e-6 * (Math.abs(a) + Math.abs(b) + Math.abs(difference));
  assert.ok(Math.abs(b - a - difference) <= sixDigits, `${b} - ${a} = ${difference}`);
}

async function testZoom(page) {
  const over = page.locator(".u-over").nth(1);
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  const image = () => page.locator(".plot canvas").nth(2).evaluate((canvas) => canvas.toDataURL());
  const whole = await image();
  await page.mouse.move(box.x + box.width * 0.7, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.8, box.y + 100, { steps: 5 });
  await page.evaluate(frame);  // uPlot takes the mouse's place once a frame
  await page.mouse.up();
  await page.evaluate(frame);
  const part = await image();
  assert.ok(part !== whole, "another plot shows the part that was chosen in this one");
  await page.mouse.dblclick(box.x + box.width * 0.2, box.y + 100);
  await page.evaluate(frame);
  assert.equal(await page.evaluate(() => performance.getEntriesByName("lineshaft:range").length) >= 2, true);
  await page.mouse.move(0, 0);
  await page.evaluate(frame);
  assert.ok(await image() === whole, "a double click shows the whole run again");
}

async function testTheme(page) {
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.click("#theme");
  assert.notEqual(await background(), light);
  await page.click("#theme");
  assert.equal(await background(), light);
}

async function figure(page, title) {
  const heads = await page.locator(".figures th").allTextContents();
  const column = heads.findIndex((head) => head.includes(title)) + 1;
  const cells = await page.locator(`.figures td:nth-child(${column})`).allTextContents();
  return cells.map((text) => Number(text.replace("−", "-")));
}

/** What the page says of the path is what circle_fit found in the run. */
async function testPath(page) {
  await page.waitForSelector(".figures td");
  const runs = ["early", "immediate"].map((method) => JSON.parse(execFileSync(lineshaft,
    ["run", "programs/paper/wei2025_circle.yaml", "--set", `method=${method}`, "--json"], { cwd: project })));
  const means = await figure(page, "mean");
  const offsets = await figure(page, "offset");
  runs.forEach(({ signals }, k) => {
    const near = (ours, wanted, what) =>
      assert.ok(Math.abs(ours / wanted - 1) < 0.05, `${what} ${ours}, circle_fit ${wanted}`);
    near(means[k], signals["fit.mean_deviation"], "mean deviation");
    near(offsets[k], signals["fit.offset"], "centre offset");
  });
}

async function testExpectations(browser) {
  run("run", "tests/report/failing.yaml", "--quiet", "--trace", file("failing.csv"));
  const page = await open(browser, report("failing.html", file("failing.csv")));
  assert.match(await page.textContent(".expectations summary"), /2 of 4 expectations failed/);
  assert.equal(await page.locator(".expectations li.bad").count(), 2);
  await page.click(".events summary");
  await page.click(".events li:nth-child(2) button");
  assert.match(await page.textContent(".events li:nth-child(2)"), /1 s stimulus: inputs.ratio = 2/);
  assert.match(await readout(page), /^A 1 s/, "a click on an event puts cursor A there");
  const red = await page.$eval(".plot canvas", (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i] > 180 && data[i + 1] < 70 && data[i + 2] < 80) count += 1;
    return count;
  });
  assert.ok(red > 50, `failed expectations are drawn in red: ${red} pixels`);
  await page.screenshot({ path: file("failing.png") });
  assert.deepEqual(page.problems, []);
}

async function testStudy(browser) {
  const results = file("jerk_line.json");
  writeFileSync(results, execFileSync(lineshaft,
    ["study", "programs/paper/jerk_line_table1.yaml", "--json"], { cwd: project }));
  const page = await open(browser, report("study.html", results));
  assert.ok(await page.locator(".bar.ours").count() > 3);
  assert.ok(await page.locator(".bar.paper").count() > 3);
  await page.screenshot({ path: file("study.png") });
  assert.deepEqual(page.problems, []);
  await testTablesBelow(browser, results);
}

/** Of a trace and a study the trace comes first, the tables below it are folded. */
async function testTablesBelow(browser, results) {
  const page = await open(browser, report("trace_and_study.html", file("early.csv"), results));
  assert.ok(!(await page.locator("table.study").first().isVisible()), "tables are folded");
  const [plot, table] = await Promise.all(["canvas", ".folded summary"].map((part) => page.locator(part).first().boundingBox()));
  assert.ok(plot.y < table.y, "plots come first");
  await page.click(".folded summary");
  assert.ok(await page.locator("table.study").first().isVisible());
  assert.deepEqual(page.problems, []);
}

/** Each run says in what it differs from the other, and no more. */
async function testMakers(page) {
  const [early, immediate] = await page.locator(".run").allTextContents();
  assert.ok(early.includes("parameter method: early"), early);
  assert.ok(immediate.includes("parameter method: immediate"), immediate);
  assert.ok(!early.includes("seed"), early);
}

async function testCircle(browser) {
  circle("early.csv", "method=early");
  circle("immediate.csv", "method=immediate");
  const address = report("circle.html", file("early.csv"), file("immediate.csv"), "--circle", "0,0,20", "--while", "g_state.DiscreteMotion");
  const page = await open(browser, address);
  await testMakers(page);
  await testCurves(page);
  await page.screenshot({ path: file("circle.png") });
  await testPath(page);
  await testAnotherCircle(page);
  await testCursors(page);
  await testZoom(page);
  await testTheme(page);
  await page.screenshot({ path: file("circle_whole.png"), fullPage: true });
  assert.deepEqual(page.problems, []);
  const dark = await open(browser, address, {
    colorScheme: "dark",
    before: () => { delete Uint8Array.fromBase64; }, // browsers before 2025 have none
  });
  assert.equal(await dark.evaluate(() => document.documentElement.dataset.theme), "dark");
  await dark.screenshot({ path: file("circle_dark.png"), fullPage: true });
  assert.deepEqual(dark.problems, []);
}

/** Keeps what each canvas shows of texts, and where: `window.drawn`, a list of boxes in pixels of the page a canvas. */
function rememberTexts() {
  window.drawn = new Map();
  const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    window.drawn.set(this.canvas, []);
    clearRect.call(this, ...box);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...more) {
    const { actualBoundingBoxLeft: left, actualBoundingBoxRight: right, actualBoundingBoxAscent: up,
            actualBoundingBoxDescent: down } = this.measureText(text);
    const at = this.getTransform();
    const corners = [[x - left, y - up], [x + right, y - up], [x - left, y + down], [x + right, y + down]]
      .map(([a, b]) => at.transformPoint(new DOMPoint(a, b)));
    const [xs, ys] = ["x", "y"].map((axis) => corners.map((corner) => corner[axis] / devicePixelRatio));
    if (!window.drawn.has(this.canvas)) window.drawn.set(this.canvas, []);
    window.drawn.get(this.canvas).push({ text, left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) });
    fillText.call(this, text, x, y, ...more);
  };
}

/** Texts of canvases that reach beyond their canvas, or lie over each other; of the page that reach beyond their box. */
const badTexts = (page) => page.evaluate(() => {
  const found = [];
  for (const [canvas, texts] of window.drawn) {
    if (!canvas.isConnected) continue;
    const { clientWidth: width, clientHeight: height } = canvas;
    texts.forEach((a, k) => {
      if (a.left < -0.5 || a.top < -0.5 || a.right > width + 0.5 || a.bottom > height + 0.5) found.push(`cut: ${a.text}`);
      for (const b of texts.slice(0, k))
        if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) found.push(`${a.text} over ${b.text}`);
    });
  }
  for (const box of document.querySelectorAll("main *, header *, #runs *"))
    if (box.checkVisibility() && box.scrollWidth > box.clientWidth + 1 && box.clientWidth > 0 && !box.closest(".scroll, select, textarea, input, svg, .u-wrap, .uplot"))
      found.push(`wider than its box: ${box.className || box.tagName} ${box.textContent.slice(0, 40)}`);
  const width = document.documentElement.scrollWidth;
  if (width > innerWidth) found.push(`the page is ${width} wide`);
  return found;
});

const stateNames = ["disabled", "standstill", "homing", "stopping", "discrete_motion", "continuous_motion",
                    "synchronized_motion", "error_stop", "no_such_parameter", "limit_not_positive"];

/** Names stand whole, side by side, on a wide page and on a narrow one. */
async function testNames(page) {
  assert.deepEqual(await badTexts(page), []);
  const texts = await page.evaluate(() => [...window.drawn.values()].flat().map(({ text }) => text));
  for (const name of stateNames) assert.ok(texts.includes(name), `${name} is not drawn whole`);
  assert.ok(texts.includes("1 s") && !texts.some((text) => /0000000/.test(text)), "a duration in seconds, not in nanoseconds");
  const legend = await page.locator(".legend .name").allTextContents();
  assert.ok(legend.includes("carriage_of_the_upper_transfer_unit.position"));
}

/** What the program says under `report:` is how the page begins. */
async function testProgramsArrangement(page) {
  const plots = await page.locator("section.plot:has(.legend)").evaluateAll((sections) =>
    sections.map((section) => [...section.querySelectorAll(".name")].map(({ textContent }) => textContent)));
  assert.deepEqual(plots.slice(0, 2), [["twin.position", "carriage_of_the_upper_transfer_unit.position", "lag"],
                                       ["twin.velocity", "rate", "go.Done"]]);
  assert.equal(plots.flat().length, 11, "nine signals and two curves");
  assert.equal(await page.getAttribute(".legend .curve:has-text('go.Busy')", "aria-pressed"), "false");
  assert.equal(await page.locator(".note").first().textContent(), "The carriage goes to 100 mm.");
  assert.match(await page.textContent("h2"), /twin\.velocity over twin\.position/);
  const number = (text) => Number(text.replace("−", "-"));
  await page.waitForFunction(() => document.querySelector(".legend td:nth-child(3)").textContent !== "");
  const [twin, carriage, lag, velocity, rate] = await page.locator(".legend tr td:nth-child(4)").allTextContents();
  assert.equal(number(lag), number(carriage) - number(twin), "a - b");
  assert.ok(Math.abs(number(rate) - number(velocity)) < 1, `derivative ${rate}, velocity ${velocity}`);
}

const namesOf = (page, plot) => page.locator(`section.plot:has(.legend) >> nth=${plot} >> .name`).allTextContents();
const settle = async (page) => { await page.evaluate(frame); await page.evaluate(frame); };

/** Presses Tab until what is in focus matches. */
async function tabTo(page, selector) {
  for (let k = 0; k < 200; ++k) {
    await page.keyboard.press("Tab");
    if (await page.evaluate((wanted) => document.activeElement.matches(wanted), selector)) return;
  }
  assert.fail(`no Tab leads to ${selector}`);
}

/** Hiding, moving, an axis of its own, a formula, and a path, without a mouse; the address has it all. */
async function testKeyboard(page) {
  await page.evaluate(() => document.activeElement.blur());
  const coloured = () => colouredPixels(page, "section.plot:has(.legend) >> nth=0 >> canvas");
  const before = await coloured();
  await tabTo(page, ".legend .curve");
  await page.keyboard.press("Enter");
  await settle(page);
  assert.ok(await coloured() < before, "a hidden curve is not drawn");
  await page.keyboard.press("Enter");
  await settle(page);
  assert.equal(await coloured(), before);
  await tabTo(page, "select[data-signal='lag']");
  await page.keyboard.press("ArrowDown");
  await settle(page);
  assert.deepEqual(await namesOf(page, 1), ["twin.velocity", "rate", "go.Done", "lag"], "moved by a key");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.signal), "lag", "and still in focus");
  await tabTo(page, "input[name='curve']");
  await page.keyboard.type("half");
  await page.keyboard.press("Tab");
  await page.keyboard.type("twin.position / 2 +");
  await page.keyboard.press("Enter");
  assert.match(await page.textContent(".bench [role=alert]"), /is expected here/);
  await page.keyboard.press("Backspace");
  await page.keyboard.type("+ lagg");
  await page.keyboard.press("Enter");
  assert.match(await page.textContent(".bench [role=alert]"), /there is no signal 'lagg'|not expected|is expected/);
  await page.keyboard.press("Control+A");
  await page.keyboard.type("max(twin.position, 0) / 2");
  await page.keyboard.press("Enter");
  await settle(page);
  assert.ok((await page.locator(".legend .name").allTextContents()).includes("half"));
  const shown = await page.locator(".legend .name").allTextContents();
  const { href } = await page.evaluate(() => ({ href: location.href }));
  assert.ok(href.includes("#report="), "the address has it");
  await page.goto("about:blank");
  await page.goto(href);
  await page.waitForFunction(() => performance.getEntriesByName("lineshaft:drawn").length > 0);
  assert.deepEqual(await page.locator(".legend .name").allTextContents(), shown, "the same again from the address");
  await page.click(".kept summary");
  await page.waitForFunction(() => document.querySelector(".kept textarea").value !== "");
  assert.match(await page.inputValue(".kept textarea"), /^report:\n  plots: \[/);
}

/** Drags a signal's name by the mouse; both ends have to be in view, so the page is shown in a high window. */
async function drag(page, signal, target) {
  const from = await page.locator(".legend .curve", { hasText: signal }).boundingBox();
  const to = await page.locator(target).first().boundingBox();
  await page.mouse.move(from.x + 60, from.y + 8);
  await page.mouse.down();
  await page.mouse.move(from.x + 80, from.y + 12, { steps: 5 });
  await page.mouse.move(to.x + 200, to.y + to.height / 2, { steps: 10 });
  await page.mouse.up();
  await settle(page);
}

async function testDrag(page) {
  await page.setViewportSize({ width: 1400, height: 4000 });
  await page.evaluate(() => scrollTo(0, 0));
  await settle(page);
  await drag(page, "twin.acceleration", "section.plot:has(.legend)");
  assert.ok((await namesOf(page, 0)).includes("twin.acceleration"), "dragged to another plot");
  await drag(page, "twin.acceleration", ".new-plot");
  assert.ok(!(await namesOf(page, 0)).includes("twin.acceleration"), "and to one of its own");
  await page.click("text=As it was");
  await settle(page);
  await testProgramsArrangement(page);
}

/** Text has 4.5:1 to what it stands on, curves 3:1 (WCAG 2.2). */
const contrasts = (page) => page.evaluate(() => {
  const canvas = document.createElement("canvas").getContext("2d");
  const luminance = (colour) => {
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const of = (name) => luminance(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  const ratio = (a, b) => (Math.max(of(a), of(b)) + 0.05) / (Math.min(of(a), of(b)) + 0.05);
  const low = (names, ground, least) => names.filter((name) => ratio(name, ground) < least).map((name) => `${name} on ${ground}: ${ratio(name, ground).toFixed(2)}`);
  return [...low(["text", "muted", "good", "bad", "accent"], "page", 4.5), ...low(["text", "muted"], "panel", 4.5),
          ...low(Array.from({ length: 8 }, (_, k) => `line-${k}`), "page", 3)];
});

async function testPaper(page) {
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 20000, `${pdf.length} bytes of PDF`);
  writeFileSync(file("arranged.pdf"), pdf);
  await page.emulateMedia({ media: "print" });
  for (const selector of [".toolbar", ".workbench", "footer", ".mover"])
    assert.equal(await page.locator(selector).first().isVisible(), false, `${selector} is printed`);
  await page.emulateMedia({ media: null });
}

async function testArranged(browser) {
  run("run", "tests/report/arranged.yaml", "--quiet", "--trace", file("arranged.csv"));
  const address = report("arranged.html", file("arranged.csv"));
  for (const width of [1400, 400])
    for (const colorScheme of ["light", "dark"]) {
      const page = await open(browser, address, { width, colorScheme, before: rememberTexts });
      await testNames(page);
      assert.deepEqual(await contrasts(page), []);
      if (colorScheme === "light") {
        await testProgramsArrangement(page);
        await page.screenshot({ path: file(`arranged_${width}.png`), fullPage: true });
        await testKeyboard(page);
        assert.deepEqual(await badTexts(page), []);
        if (width === 1400) await testDrag(page);
        if (width === 1400) await testPaper(page);
      }
      assert.deepEqual(page.problems, []);
      await page.close();
    }
}

/** The band around the points of a table, and how far from them the path is. */
async function testBand(browser) {
  run("run", "programs/14_contour.yaml", "--quiet", "--trace", file("contour.csv"));
  const page = await open(browser, report("contour.html", file("contour.csv")));
  await page.waitForFunction(() => document.querySelector(".figures td") !== null);
  assert.match(await page.textContent(".figures thead"), /farthest from the points \[mm\]/);
  const farthest = Number((await page.locator(".figures tbody td").allTextContents())[1]);
  assert.ok(farthest > 0.4 && farthest <= 0.5, `${farthest} mm from the points`);
  const beside = await page.$eval("canvas.path", (canvas) => {
    const ctx = canvas.getContext("2d");
    const { data, width } = ctx.getImageData(0, 0, canvas.width, canvas.height);
    let grey = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 50 && data[i + 3] < 80 && Math.abs(data[i] - data[i + 2]) < 40) grey += 1;
    return grey / width;
  });
  assert.ok(beside > 10, `the band has ${beside} points for each of the width`);
  assert.match(await page.evaluate(() => document.querySelector("pre")?.textContent ?? ""), /band: \["plate",0\.5\]|^$/);
  await page.screenshot({ path: file("contour.png"), fullPage: true });
  assert.deepEqual(page.problems, []);
  await page.close();
}

/** Runs of different signals share a page, one colour a run. */
async function testDifferentRuns(browser) {
  writeFileSync(file("left.csv"), "time [s],a.x [mm],a.y [mm]\n0,1,1\n1,2,1\n2,3,1\n");
  writeFileSync(file("right.csv"), "time [s],a.x [mm],b.z [mm/s]\n0,1.5,1\n0.1,2.5,1\n0.2,3.5,2\n");
  const page = await open(browser, report("different.html", file("left.csv"), file("right.csv")));
  const strokes = await page.locator(".legend tr").evaluateAll((rows) => rows.slice(1).filter((row) => row.cells[0].tagName === "TD").map((row) =>
    [row.cells[0].textContent, row.querySelector("line").getAttribute("stroke"), row.querySelector("line").getAttribute("stroke-dasharray")]));
  const left = strokes.filter(([name]) => name.includes("left") || name === "a.y");
  const of = (name) => strokes.filter(([text]) => text.startsWith(name)).map(([, stroke]) => stroke);
  assert.deepEqual([of("a.x left.csv"), of("a.x right.csv"), of("a.y"), of("b.z")],
                   [["var(--line-0)"], ["var(--line-1)"], ["var(--line-0)"], ["var(--line-1)"]], JSON.stringify(strokes));
  assert.notEqual(strokes[0][2], strokes[1][2], `dashes tell ${left[0][0]} apart, too`);
  const drawn = await colouredPixels(page, "section.plot:has(.legend) >> nth=0 >> canvas");
  await page.click("#runs button:has-text('right')");
  await settle(page);
  assert.ok(await colouredPixels(page, "section.plot:has(.legend) >> nth=0 >> canvas") < drawn, "a run that is hidden is not drawn");
  assert.deepEqual(page.problems, []);
}

/** Five circles from one study: a matrix, and five paths with the deviation magnified. */
async function testCircles(browser) {
  run("study", "programs/paper/wei2025_circles.yaml", "--quiet", "--traces", file("circles"), "--report", file("circles.html"));
  for (const width of [1400, 400]) {
    const page = await open(browser, pathToFileURL(file("circles.html")).href, { width, before: rememberTexts });
    await page.waitForSelector(".figures td");
    assert.deepEqual(await badTexts(page), []);
    assert.equal(await page.locator(".matrix tbody tr").count(), 5);
    assert.equal(await page.locator(".matrix tbody td").count(), 20);
    assert.match(await page.textContent(".matrix caption"), /logarithm/);
    const runs = await page.locator("#runs b").allTextContents();
    assert.deepEqual(runs, ["immediate", "early", "centred", "balanced", "ramp"]);
    assert.equal(await page.inputValue(".controls input"), "100", "the deviation is magnified");
    assert.equal(await page.locator(".figures tbody tr").count(), 5);
    const means = await figure(page, "mean");
    const wanted = await page.locator(".matrix tbody td:nth-child(4)").allTextContents();
    means.forEach((mean, k) => assert.ok(Math.abs(mean / Number(wanted[k].replace("−", "-")) - 1) < 0.05, `${runs[k]}: ${mean}, study ${wanted[k]}`));
    await page.screenshot({ path: file(`circles_${width}.png`), fullPage: true });
    const { y, height } = await page.locator("section.plot").first().boundingBox();
    if (width === 1400) await page.screenshot({ path: file("circles.png"), fullPage: true, clip: { x: 0, y: 0, width, height: y + height } });
    assert.deepEqual(page.problems, []);
    await page.close();
  }
}

/** A sweep of two settings is a heat map; its colours go by decades where its values do. */
async function testSweep(browser) {
  const row = (k, ours) => ({ case: k, name: "", set: { speed: `${k % 3} mm/s`, gain: `${Math.floor(k / 3)}` }, signal: "x.lag",
                              unit: "mm", paper: null, ours, ok: k !== 4, repeats: 2, least: ours / 2, greatest: 2 * ours });
  const rows = Array.from({ length: 6 }, (_, k) => row(k, 10 ** -k));
  writeFileSync(file("sweep.json"), JSON.stringify({ title: "A sweep", rows, claims: [], ok: false }));
  const page = await open(browser, report("sweep.html", file("sweep.json")));
  const heats = await page.locator(".matrix td").evaluateAll((cells) => cells.map((cell) => parseFloat(cell.style.getPropertyValue("--heat"))));
  assert.deepEqual(heats, [45, 18, 36, 9, 27, 0], "even steps of colour for decades");
  assert.match(await page.locator(".matrix td").first().textContent(), /^10.5 \.\. 2$/, "repeats have their range");
  const heads = await page.locator(".study th").allTextContents();
  assert.ok(!heads.includes("paper") && heads.includes("least .. greatest"), heads.join());
  await page.click("details summary");
  const widths = await page.locator(".bar.ours").evaluateAll((bars) => bars.slice(1).map((bar) => parseFloat(bar.style.width)));
  widths.slice(1).forEach((width, k) => assert.ok(Math.abs(widths[k] - width - (widths[0] - widths[1])) < 0.1, `bars by decades: ${widths}`));
  assert.deepEqual(page.problems, []);
}

const spike = { rows: 1000001, at: 654321 };
const oddNumber = (row) => (row * 7919) % 100003;

/** One sample of a million stands out of a line; numbers without any order; every 1,000th is missing. */
function writeSpike(path) {
  const lines = ["time [s],a.spike [mm],b.odd,c.gaps [s]"];
  for (let row = 0; row < spike.rows; ++row)
    lines.push(`${row / 1e6},${row === spike.at ? 5 : 0},${oddNumber(row)},${row % 1000 === 7 ? "" : row % 1000 / 8}`);
  writeFileSync(path, `${lines.join("\n")}\n`);
}

const packedRun = (page) =>
  JSON.parse(readFileSync(page, "utf8").match(/id="report">(.*?)<\/script>/s)[1]).runs[0];

/** What a page unpacks is what the trace has, in whatever order it is read. */
async function testSamples() {
  writeSpike(file("spike.csv"));
  report("spike.html", file("spike.csv"));
  const run = packedRun(file("spike.html"));
  const { times, values: [spiky, odd, gaps] } = await unpack(run);
  assert.equal(odd.length, spike.rows);
  const check = (row) => {
    assert.equal(times.at(row), row / 1e6);
    assert.equal(spiky.at(row), row === spike.at ? 5 : 0);
    assert.equal(odd.at(row), oddNumber(row));
    assert.equal(gaps.at(row), row % 1000 === 7 ? NaN : row % 1000 / 8);
  };
  for (const row of [700000, 3, spike.rows - 1, 512, 511, 1023, 1024, 654321]) check(row);
  for (let row = 0; row < spike.rows; ++row) check(row);
  const borders = slices(5, spike.rows - 5, 1200);
  slicedValues(odd, borders).forEach((value, k) => {
    const rows = Array.from({ length: borders[(k >> 1) + 1] - borders[k >> 1] }, (_, i) => borders[k >> 1] + i);
    const sorted = rows.sort((a, b) => oddNumber(a) - oddNumber(b));
    const ends = [sorted[0], sorted.at(-1)].sort((a, b) => a - b);
    assert.equal(value, oddNumber(ends[k & 1]), `slice ${k >> 1}`);
  });
}

/** The first drawing has the one sample that stands out, and the cursors' values are the samples'. */
async function testSpike(browser) {
  const page = await open(browser, pathToFileURL(file("spike.html")).href);
  const drawn = await page.$eval(".plot canvas", (canvas) => {
    const { width, height } = canvas;
    const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
    const found = [];
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 100 && data[i + 2] - data[i] > 60) found.push([(i / 4) % width, Math.floor(i / 4 / width)]);
    const top = Math.min(...found.map(([, y]) => y));
    const ys = found.map(([, y]) => y);
    return { top, bottom: Math.max(...ys), columns: found.filter(([, y]) => y === top).map(([x]) => x),
             left: Math.min(...found.map(([x]) => x)), right: Math.max(...found.map(([x]) => x)) };
  });
  assert.ok(drawn.bottom - drawn.top > 100, `the spike is drawn: ${JSON.stringify(drawn)}`);
  const x = drawn.left + ((drawn.right - drawn.left) * spike.at) / (spike.rows - 1);
  assert.ok(drawn.columns.every((each) => Math.abs(each - x) < 4), `near ${x}: ${drawn.columns}`);
  await page.waitForFunction(() => document.querySelector(".legend td:nth-child(3)").textContent !== "");
  const third = Math.floor((spike.rows - 1) / 3);
  const [, , a, b] = await rowOf(page, "b.odd");
  assert.deepEqual([a, b].map(Number), [oddNumber(third), oddNumber(2 * third)]);
  assert.deepEqual(page.problems, []);
  rmSync(file("spike.csv"));
}

/** Axes tell numbers apart whose third decimals are equal. */
async function testSmallNumbers(browser) {
  const rows = Array.from({ length: 100 }, (_, row) => `${row / 1e6},${(row % 7) * 2e-5},${20 + row / 1e6}`);
  writeFileSync(file("small.csv"), `time [s],a.small [mm],b.near [mm/s]\n${rows.join("\n")}\n`);
  const page = await open(browser, report("small.html", file("small.csv")), { before: () => {
    globalThis.texts = new Map();
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
      globalThis.texts.set(this.canvas, [...(globalThis.texts.get(this.canvas) ?? []), text]);
      fillText.call(this, text, ...place);
    };
  } });
  const drawn = await page.evaluate(() => [...globalThis.texts.values()]);
  assert.equal(drawn.length, 2);
  assert.ok(drawn[0].includes("2.5e−5") && drawn[0].includes("0.0001"), drawn[0].join(" "));
  assert.ok(drawn[1].includes("20.00004"), drawn[1].join(" "));
  for (const texts of drawn) assert.ok(texts.includes("20 µs"), `the time: ${texts.join(" ")}`);
  assert.deepEqual(page.problems, []);
}

const tenSignals = ["g.position", "x.position", "y.position", "x.velocity", "y.velocity",
                    "x.acceleration", "y.acceleration", "circle.ratio_x", "circle.ratio_y", "g_state.DiscreteMotion"];

/** When the page says that it has drawn, no plot is empty, nor changes afterwards. */
async function testDrawnAtTheMark(browser, address) {
  const page = await open(browser, address, { before: () => {
    const mark = performance.mark.bind(performance);
    window.pictures = () => [...document.querySelectorAll(".plot canvas")].map((canvas) => canvas.toDataURL());
    performance.mark = (name) => {
      if (name === "lineshaft:drawn") window.picturesAtMark = window.pictures();
      return mark(name);
    };
  } });
  await page.waitForSelector(".figures td");
  await page.evaluate(frame);
  const [then, now] = await page.evaluate(() => [window.picturesAtMark, window.pictures()]);
  assert.ok(now.length > 5 && then.length === now.length);
  now.forEach((picture, k) => assert.ok(picture === then[k], `plot ${k} was not ready`));
  await testCurves(page);
  await page.close();
}

/** A million rows of ten signals: size of the page, first drawing, drawing after a zoom. */
async function testLarge(browser) {
  const program = readFileSync(join(project, "programs/04_circle.yaml"), "utf8")
    .replace("every: 10\n", "every: 1\n")
    .replaceAll("paper/circle_", `${project}/programs/paper/circle_`)
    .replace(/signals: \[.*\]/, `signals: [${tenSignals.join(", ")}]`);
  writeFileSync(file("million.yaml"), program);
  run("run", file("million.yaml"), "--include-dir", project, "--set", "radius=160 mm", "--quiet", "--trace", file("million.csv"));
  const address = report("million.html", file("million.csv"));
  const megabytes = statSync(file("million.html")).size / 2 ** 20;
  const draws = [];
  const zooms = [];
  await testDrawnAtTheMark(browser, address);
  for (let repeat = 0; repeat < 3; ++repeat) {
    const page = await open(browser, address);
    draws.push(await mark(page, "drawn"));
    for (let k = 0; k < 3; ++k)
      zooms.push(await page.evaluate(async () => {
        const start = performance.now();
        const before = performance.getEntriesByName("lineshaft:range").length;
        document.querySelector(".u-over").dispatchEvent(
          new WheelEvent("wheel", { ctrlKey: true, deltaY: -60, clientX: 500, clientY: 300, bubbles: true, cancelable: true }));
        while (performance.getEntriesByName("lineshaft:range").length === before)
          await new Promise((done) => setTimeout(done, 1));
        return performance.getEntriesByName("lineshaft:range").at(-1).startTime - start;
      }));
    assert.deepEqual(page.problems, []);
    if (repeat === 0) await page.screenshot({ path: file("million.png") });
    await page.close();
  }
  rmSync(file("million.csv"));
  const least = (times) => Math.min(...times);
  console.log(`a million samples x 10 signals: ${megabytes.toFixed(2)} MB, ` +
              `first drawing ${draws.map(Math.round).join(", ")} ms, zoom ${zooms.map(Math.round).join(", ")} ms`);
  assert.ok(megabytes <= 4, `page of ${megabytes} MB`);
  if (bars !== "--bars") return;
  assert.ok(least(draws) <= 500, `first drawing ${draws} ms`);
  assert.ok(least(zooms) <= 150, `zoom ${zooms} ms`);
}

mkdirSync(folder, { recursive: true });
await withBrowser(async (newPage) => {
  for (const test of [testSamples, testSpike, testSmallNumbers, testCircle, testExpectations, testStudy, testArranged, testBand,
                      testDifferentRuns, testCircles, testSweep, testLarge]) {
    await test({ newPage });
    console.log(`ok ${test.name}`);
  }
});
