// Uses the page of `lineshaft serve` in a headless Chromium.
//   node live_test.mjs LINESHAFT FOLDER [--bars]
// Programs and screenshots go to FOLDER; --bars also holds the frames a second against their bar,
// which needs a quiet machine. Exit 77: no Chromium, nothing tested.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join, resolve } from "node:path";
import { colouredPixels, withBrowser } from "./browser.mjs";

const [lineshaft, folder] = process.argv.slice(2, 4).map((path) => resolve(path));
const bars = process.argv[4];
const file = (name) => join(folder, name);
const signals = ["path", "x", "y"].flatMap((axis) => ["position", "velocity", "acceleration"].map((of) => `${axis}.${of}`));
signals.push("inputs.go");

const program = `lineshaft: 1
title: Two axes that go back and forth
tasks: {servo: {every: 1 ms}}
blocks:
  path: {type: axis, task: servo, default_velocity: 200 mm/s}
  x: {type: axis, task: servo}
  y: {type: axis, task: servo}
  gear_x: {type: MC_GearIn, task: servo, Master: path, Slave: x, RatioNumerator: 4, RatioDenominator: 5, Execute: inputs.couple}
  gear_y: {type: MC_GearIn, task: servo, Master: path, Slave: y, RatioNumerator: 3, RatioDenominator: 5, Execute: inputs.couple}
  on: {type: ton, task: servo, in: NOT previous(off.q), pt: 400 ms}
  off: {type: ton, task: servo, in: on.q, pt: 400 ms}
  there: {type: MC_MoveAbsolute, task: servo, Axis: path, Position: 20 mm, Execute: on.q}
  back: {type: MC_MoveAbsolute, task: servo, Axis: path, Position: 0 mm, Execute: NOT on.q}
inputs: {couple: false, go: false}
stimulus: [{at: 10 ms, set: {inputs.couple: true}}]
run: {for: 1 s}
trace: {task: servo, signals: [${signals.join(", ")}]}
`;

const freePort = () => new Promise((done) => {
  const probe = createServer().listen(0, "127.0.0.1", () => {
    const { port } = probe.address();
    probe.close(() => done(port));
  });
});

/** A served program; `end` takes it away. */
async function serve(port, ...options) {
  const child = spawn(lineshaft, ["serve", file("live.yaml"), "--http", `127.0.0.1:${port}`, ...options],
                      { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
  let said = "";
  await new Promise((done, fail) => {
    child.stderr.on("data", (text) => {
      said += text;
      if (said.includes("^C ends it")) done();
    });
    child.on("exit", () => fail(new Error(said)));
  });
  const gone = new Promise((done) => { child.on("exit", done); });
  return { end: () => { child.kill("SIGINT"); return gone; } };
}

async function open(newPage, port, viewport = { width: 1400, height: 900 }) {
  const page = await newPage({ viewport, colorScheme: "light" });
  page.problems = [];
  page.on("pageerror", (error) => page.problems.push(String(error)));
  page.on("request", (request) => {
    if (!/^(data|blob):|^http:\/\/127\.0\.0\.1:/.test(request.url())) page.problems.push(`asked for ${request.url()}`);
  });
  // Each drawing of a plot clears its canvas once.
  await page.addInitScript(() => {
    globalThis.drawings = 0;
    const { clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...place) {
      if (this.canvas === document.querySelector(".plot canvas")) globalThis.drawings += 1;
      clearRect.apply(this, place);
    };
  });
  await page.goto(`http://127.0.0.1:${port}/#${signals.join()}`);
  await page.waitForFunction(() => globalThis.drawings > 5);
  return page;
}

const timeOf = async (page) => parseFloat(await page.textContent("#time"));
const cellsOf = (page, table, name) =>
  page.locator(`${table} tr`, { hasText: name }).first().locator("td").allTextContents();
const eventually = (page, condition, argument) => page.waitForFunction(condition, argument, { timeout: 20000 });

async function testDrawing(newPage, port) {
  const machine = await serve(port);
  const page = await open(newPage, port);
  await page.waitForTimeout(3000);
  const plots = await page.locator(".plot").count();
  for (let k = 0; k < plots; ++k) {
    const count = await colouredPixels(page, `.plot >> nth=${k} >> canvas`);
    assert.ok(count > 200, `plot ${k} has ${count} coloured pixels`);
  }
  const count = await page.evaluate(async () => {
    const [begun, before] = [performance.now(), globalThis.drawings];
    await new Promise((done) => setTimeout(done, 5000));
    return (1000 * (globalThis.drawings - before)) / (performance.now() - begun);
  });
  console.log(`10 signals at 1 kHz: ${count.toFixed(1)} frames a second`);
  if (bars === "--bars") assert.ok(count >= 30, `${count} frames a second`);
  assert.ok(count > 1, `${count} frames a second`);
  const [, state, position, velocity, error] = await cellsOf(page, "#axes", "path");
  assert.match(state, /discrete_motion|standstill/);
  assert.ok(/mm$/.test(position) && /mm\/s$/.test(velocity) && error === "", `${position} ${velocity} ${error}`);
  const [, scans, p50] = await cellsOf(page, "#tasks", "servo");
  assert.ok(Number(scans) > 1000 && /s$/.test(p50), `${scans} ${p50}`);
  await page.screenshot({ path: file("live.png"), fullPage: true });
  assert.deepEqual(page.problems, []);
  await page.close();
  await machine.end();
}

/** The buttons of a signal's row in the table. */
const buttonOf = (page, name, text) => page.locator(`#signals tr[data-name="${name}"] button`, { hasText: text });

async function testWriting(newPage, port) {
  const reader = await serve(port);
  const page = await open(newPage, port);
  await page.fill("#filter", "inputs.go");
  await page.fill('[aria-label="value of inputs.go"]', "true");
  for (const what of ["set", "force"]) {
    await buttonOf(page, "inputs.go", what).click();
    await eventually(page, () => document.querySelector("#message").textContent.includes("--allow-write"));
    await eventually(page, () => document.querySelector('#signals tr[data-name="inputs.go"] .wrong').textContent.includes("--allow-write"));
  }
  await page.click("#pause");
  await eventually(page, () => document.querySelector("#message").textContent.includes("--allow-write"));
  await reader.end();
  const writer = await serve(port, "--allow-write", "--record", file("recording.yaml"));
  await page.reload();
  await page.waitForFunction(() => globalThis.drawings > 5);
  const value = async () => (await (await fetch(`http://127.0.0.1:${port}/api/values?signals=inputs.go,x.velocity`)).json()).values;
  await page.fill('[aria-label="value of inputs.go"]', "perhaps");
  await page.click('[aria-label="set inputs.go"]');
  await eventually(page, () => document.querySelector('#signals tr[data-name="inputs.go"] .wrong').textContent.includes("perhaps"));
  await page.fill('[aria-label="value of inputs.go"]', "true");
  assert.equal(await page.textContent('#signals tr[data-name="inputs.go"] .wrong'), "", "what is typed anew is not wrong yet");
  await page.click('[aria-label="set inputs.go"]');
  await eventually(page, () => document.querySelector('#signals tr[data-name="inputs.go"] .value').textContent === "true");
  await page.click("#pause");
  await eventually(page, () => document.querySelector("#status").textContent.startsWith("paused"));
  const stands = await timeOf(page);
  await page.click("#step");
  await eventually(page, (time) => parseFloat(document.querySelector("#time").textContent) > time, stands);
  assert.ok(await timeOf(page) - stands < 0.0025, "one scan of 1 ms");
  assert.equal((await value())["inputs.go"], true);
  await page.fill("#until input", `${(stands + 0.5).toFixed(6)} s`);
  await page.press("#until input", "Enter");
  await eventually(page, (time) => parseFloat(document.querySelector("#time").textContent) >= time, stands + 0.499);
  await page.fill("#filter", "x.velocity");
  await page.fill('[aria-label="value of x.velocity"]', "7");
  await buttonOf(page, "x.velocity", "force").click();
  await page.click("#pause");
  await eventually(page, () => document.querySelector('#signals tr[data-name="x.velocity"] .forced'));
  assert.equal((await value())["x.velocity"], 7);
  await buttonOf(page, "x.velocity", "release").click();
  await eventually(page, () => !document.querySelector('#signals tr[data-name="x.velocity"] .forced'));
  assert.deepEqual(page.problems, []);
  await page.close();
  await writer.end();
}

/** Where neither cursor stands, which would be dragged in place of the plot; they move as time goes on. */
async function freePlace(page, box) {
  const cursors = await Promise.all([".cursor-A", ".cursor-B"].map((each) => page.locator(each).first().boundingBox()));
  const places = [0.2, 0.5, 0.8].map((share) => box.x + box.width * share);
  return places.find((place) => cursors.every((cursor) => !cursor || Math.abs(cursor.x - place) > 0.1 * box.width));
}

async function testTrigger(newPage, port) {
  const machine = await serve(port);
  const page = await open(newPage, port);
  await page.selectOption('[aria-label="signal"]', "path.position");
  await page.selectOption('[aria-label="condition"]', "above");
  await page.fill('[aria-label="value"]', "10");
  await page.fill('[name="before"]', "0.2");
  await page.fill('[name="after"]', "0.3");
  await page.click("#arm");
  await eventually(page, () => /^hold at/.test(document.querySelector("#armed").textContent));
  assert.equal(await page.textContent("#hold"), "Follow");
  const [, , atCursor] = await page.locator(".legend tr", { hasText: "path.position" }).first().locator("td").allTextContents();
  assert.ok(Number(atCursor) > 10 && Number(atCursor) < 10.5, `cursor A is where it begins: ${atCursor}`);
  const [cursor, plot] = await Promise.all([".cursor-A", ".u-over"].map((each) => page.locator(each).first().boundingBox()));
  const share = (cursor.x + cursor.width / 2 - plot.x) / plot.width;
  assert.ok(Math.abs(share - 0.2 / 0.5) < 0.02, `and stands there, at ${share} of the plot`);
  const drawn = await page.evaluate(() => globalThis.drawings);
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => globalThis.drawings), drawn, "what was caught stays");
  await page.screenshot({ path: file("trigger.png") });
  const picture = () => page.locator(".plot canvas").first().evaluate((canvas) => canvas.toDataURL());
  const caught = await picture();
  const over = page.locator(".u-over").first();
  await over.dblclick({ position: { x: 50, y: 50 } });
  await page.waitForTimeout(200);
  assert.notEqual(await picture(), caught, "a double click shows all that is kept");
  await page.click("#hold");
  await eventually(page, (before) => globalThis.drawings > before + 5, drawn);
  const box = await over.boundingBox();
  const from = await freePlace(page, box);
  await page.mouse.move(from, box.y + 80);
  await page.mouse.down();
  await page.mouse.move(from + box.width * 0.15, box.y + 80, { steps: 5 });
  await page.waitForTimeout(50);
  await page.mouse.up();
  await eventually(page, () => document.querySelector("#hold").textContent === "Follow");
  await page.fill('[aria-label="value"]', "high");
  await page.click("#arm");
  await eventually(page, () => document.querySelector("#message").textContent.includes("number"));
  await page.fill('[aria-label="value"]', "1e6");
  await page.click("#arm");
  await eventually(page, () => document.querySelector("#armed").textContent === "armed");
  await page.click("#arm");
  await eventually(page, () => document.querySelector("#armed").textContent === "");
  assert.deepEqual(page.problems, []);
  await page.close();
  await machine.end();
}

/** The page comes back with the machine, and shows another one's time. */
async function testReconnection(newPage, port) {
  const first = await serve(port, "--speed", "100");
  const page = await open(newPage, port);
  await eventually(page, () => parseFloat(document.querySelector("#time").textContent) > 200);
  await first.end();
  await eventually(page, () => document.querySelector("#status").textContent.includes("not connected"));
  const second = await serve(port);
  await eventually(page, () => document.querySelector("#status").textContent.startsWith("speed"));
  const before = await page.evaluate(() => globalThis.drawings);
  await eventually(page, (drawings) => globalThis.drawings > drawings + 5, before);
  assert.ok(await timeOf(page) < 200, "the time has begun anew");
  assert.deepEqual(page.problems, []);
  await page.close();
  await second.end();
}

async function testNarrow(newPage, port) {
  const machine = await serve(port);
  const page = await open(newPage, port, { width: 400, height: 800 });
  await page.waitForTimeout(1000);
  const [width, inner] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(width <= inner, `the page is ${width} wide in a window of ${inner}`);
  const cut = await page.evaluate(() => [...document.querySelectorAll("button, input, select, td, th, h1, label")]
    .filter((each) => each.getClientRects().length > 0 && each.getBoundingClientRect().right > innerWidth + 0.5)
    .map((each) => `${each.tagName} ${each.textContent}`));
  assert.deepEqual(cut, [], "nothing is cut");
  await page.screenshot({ path: file("narrow.png"), fullPage: true });
  assert.deepEqual(page.problems, []);
  await page.close();
  await machine.end();
}

mkdirSync(folder, { recursive: true });
writeFileSync(file("live.yaml"), program);
await withBrowser(async (newPage) => {
  const port = await freePort();
  for (const test of [testDrawing, testWriting, testTrigger, testReconnection, testNarrow]) {
    await test(newPage, port);
    console.log(`ok ${test.name}`);
  }
});
