// Loads pages that `lineshaft report` made from files into a headless Chromium and uses them.
//   node browser_test.mjs LINESHAFT PROJECT FOLDER [--bars]
// Pages and screenshots go to FOLDER; --bars also holds the drawing times against their bars, which
// needs a quiet machine. Exit 77: no Chromium, nothing tested.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { unpack } from "#page/decode";
import { slicedValues, slices } from "#page/samples";

const [lineshaft, project, folder, bars] = process.argv.slice(2);
const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync);
const skipped = 77;

function skip(why) {
  console.log(`SKIPPED: ${why}; tools/setup --tests installs it`);
  process.exit(skipped);
}

if (!chromium) skip("no Chromium");
const { chromium: browserType } = await import("playwright-core").catch(() => skip("no playwright-core"));

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

const frame = "new Promise((done) => requestAnimationFrame(() => setTimeout(done)))";

/** How many of a plot's pixels bear a colour: neither background, nor grid, nor text. */
const colouredPixels = (page, selector) => page.$eval(selector, (canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b, alpha] = data.subarray(i, i + 4);
    if (alpha > 100 && Math.max(r, g, b) - Math.min(r, g, b) > 60) count += 1;
  }
  return count;
});

async function open(browser, address, { colorScheme = "light", before = () => {} } = {}) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, colorScheme });
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
  const address = report("circle.html", file("early.csv"), file("immediate.csv"), "--circle", "0,0,20", "--while", "g.moving");
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
  assert.ok(drawn[0].includes("4e−5") && drawn[0].includes("0.0001"), drawn[0].join(" "));
  assert.ok(drawn[1].includes("20.00004"), drawn[1].join(" "));
  for (const texts of drawn) assert.ok(texts.includes("20 µs"), `the time: ${texts.join(" ")}`);
  assert.deepEqual(page.problems, []);
}

const tenSignals = ["g.position", "x.position", "y.position", "x.velocity", "y.velocity",
                    "x.acceleration", "y.acceleration", "circle.ratio_x", "circle.ratio_y", "g.moving"];

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
    .replace("sources: paper/", `sources: ${project}/programs/paper/`)
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
const profile = mkdtempSync(join(tmpdir(), "lineshaft-browser-"));
const context = await browserType.launchPersistentContext(profile, {
  executablePath: chromium,
  headless: true,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
try {
  for (const test of [testSamples, testSpike, testSmallNumbers, testCircle, testExpectations, testStudy, testLarge]) {
    await test({ newPage });
    console.log(`ok ${test.name}`);
  }
} finally {
  await context.close();
  rmSync(profile, { recursive: true, force: true });
}

async function newPage({ viewport, colorScheme }) {
  const page = await context.newPage();
  await page.setViewportSize(viewport);
  await page.emulateMedia({ colorScheme });
  return page;
}
