// Every request of `lineshaft debug` by the protocol's own test client, npm's @vscode/debugadapter-testsupport.
//
// usage: node debug_client.mjs LINESHAFT SOURCE_DIR
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";

const installed = createRequire(new URL("../tools/report/package.json", import.meta.url));
const { DebugClient } = installed("@vscode/debugadapter-testsupport");

const [lineshaft, source] = process.argv.slice(2).map((name) => path.resolve(name));
const folder = mkdtempSync(path.join(tmpdir(), "lineshaft-"));
const program = path.join(source, "tests/debug/motor.yaml"), motor = path.join(source, "tests/debug/motor.st");
const tests = path.join(source, "programs/09_own_block_test.st");
const text = readFileSync(motor, "utf8").split("\n");
const line = (wanted) => text.findIndex((each) => each.trim() === wanted) + 1;
const counting = line("count := count + 1;"), calling = line("ramp(goal := 3.0, speed => speed);");
const thread = { threadId: 2 };

// A session up to its first stop. `setup` asks what comes before `configurationDone`.
async function begin(launch, setup = async () => {}) {
  const client = new DebugClient(lineshaft, "debug", "lineshaft");
  client.defaultTimeout = 30000;
  await client.start();
  const capabilities = (await client.initializeRequest()).body;
  const initialized = client.waitForEvent("initialized");
  await client.launchRequest({ program, ...launch });
  await initialized;
  await setup(client);
  const stopped = client.waitForEvent("stopped");
  await client.configurationDoneRequest();
  return { client, capabilities, stop: (await stopped).body };
}

// Why it stands still then.
async function go(client, request) {
  const stopped = client.waitForEvent("stopped");
  await request;
  return (await stopped).body;
}

async function frames(client) {
  return (await client.stackTraceRequest(thread)).body.stackFrames;
}

async function inside(client, variablesReference, page = {}) {
  const { variables } = (await client.variablesRequest({ variablesReference, ...page })).body;
  return Object.fromEntries(variables.map((each) => [each.name, each]));
}

async function scopes(client, frameId) {
  const { scopes } = (await client.scopesRequest({ frameId })).body;
  return Object.fromEntries(scopes.map((each) => [each.name, each.variablesReference]));
}

async function value(client, scope, name) {
  return (await inside(client, (await scopes(client, (await frames(client))[0].id))[scope]))[name].value;
}

async function count(client) {
  return Number(await value(client, "Outputs", "count"));
}

const checks = {
  async "capabilities are true"() {
    const { client, capabilities, stop } = await begin({ stopOnEntry: true });
    assert.equal(stop.reason, "entry");
    for (const each of ["ConfigurationDoneRequest", "StepBack", "TerminateRequest", "ConditionalBreakpoints", "HitConditionalBreakpoints",
      "LogPoints", "FunctionBreakpoints", "DataBreakpoints", "EvaluateForHovers", "SetVariable"]) assert.equal(capabilities[`supports${each}`], true, each);
    assert.equal(capabilities.supportTerminateDebuggee, true);
    assert.equal(capabilities.exceptionBreakpointFilters[0].filter, "block_error");
    const terminated = client.waitForEvent("terminated");
    await client.terminateRequest();
    await terminated;
    await client.stop();
  },

  async "launch takes settings, forces and a trace"() {
    const trace = path.join(folder, "trace.csv");
    const client = new DebugClient(lineshaft, "debug", "lineshaft");
    await client.start();
    const exited = client.waitForEvent("exited", 30000);
    await Promise.all([client.configurationSequence(),
      client.launch({ program, args: ["--force", "inputs.start=true@0s..1s", "--trace", trace] })]);
    assert.equal((await exited).body.exitCode, 0);
    await client.stop();
    assert.match(readFileSync(trace, "utf8"), /motor\.speed/);
  },

  async "breakpoints by line, condition, count, and as log points"() {
    const logged = [];
    const { client, stop } = await begin({}, async (client) => {
      client.on("output", ({ body }) => logged.push(body.output));
      const { breakpoints } = (await client.setBreakpointsRequest({ source: { path: motor }, breakpoints: [
        { line: counting, logMessage: "now {count}" }, { line: calling, condition: "count = 3" }] })).body;
      assert.deepEqual(breakpoints.map((each) => [each.verified, each.line]), [[true, counting], [true, calling]]);
    });
    assert.equal(stop.reason, "breakpoint");
    assert.equal(await count(client), 3);
    assert.deepEqual(logged.filter((each) => each.startsWith("now")), ["now 0\n", "now 1\n", "now 2\n"]);
    await client.setBreakpointsRequest({ source: { path: motor }, breakpoints: [{ line: counting, hitCondition: "% 5" }] });
    await go(client, client.continueRequest(thread));
    assert.equal(await count(client), 7);
    await client.stop();
  },

  async "signals, times and errors stop it"() {
    const { client, stop } = await begin({}, async (client) => {
      const { breakpoints } = (await client.setFunctionBreakpointsRequest({ breakpoints: [
        { name: "motor.speed >= 2 mm/s" }, { name: "delay.q" }, { name: "time >= 500 ms" }, { name: "no.such" }] })).body;
      assert.deepEqual(breakpoints.map((each) => each.verified), [true, true, true, false]);
      await client.setExceptionBreakpointsRequest({ filters: ["block_error"] });
    });
    assert.deepEqual([stop.reason, stop.text], ["function breakpoint", "motor.speed >= 2 mm/s"]);
    assert.equal((await go(client, client.continueRequest(thread))).text, "delay.q");
    assert.equal((await go(client, client.continueRequest(thread))).text, "time >= 500 ms");
    assert.equal((await go(client, client.reverseContinueRequest(thread))).text, "delay.q");
    await client.stop();
  },

  async "a fault is shown where it happened, with its calls and values"() {
    const failing = path.join(source, "tests/debug/fault.yaml");
    const { client, stop } = await begin({ program: failing }, (client) => client.setExceptionBreakpointsRequest({ filters: ["block_error"] }));
    assert.equal(stop.reason, "exception");
    const { stackFrames } = (await client.stackTraceRequest({ threadId: stop.threadId })).body;
    assert.deepEqual(stackFrames.map((each) => [each.name, each.line]),
      [["Taken", 8], ["Line (second)", 20], ["task main at 0.04 s", 1]]);
    const value = async (frame, scope, name) => (await inside(client, (await scopes(client, stackFrames[frame].id))[scope]))[name].value;
    assert.deepEqual([await value(0, "Inputs", "place"), await value(1, "Outputs", "n")], ["10", "5"]);
    await client.stop();
  },

  async "steps: over, into, out, to the next scan, back and on"() {
    const { client } = await begin({}, (client) => client.setBreakpointsRequest({ source: { path: motor }, breakpoints: [{ line: calling }] }));
    await client.setBreakpointsRequest({ source: { path: motor }, breakpoints: [] });
    const at = async () => [(await frames(client))[0].name, (await frames(client))[0].line];
    await go(client, client.stepInRequest(thread));
    assert.deepEqual(await at(), ["Ramp", line("steps := steps + 1;")]);
    assert.deepEqual((await frames(client)).map((each) => each.name).slice(1), ["Motor (motor)", "task main at 0 s"]);
    await go(client, client.stepOutRequest(thread));
    assert.deepEqual(await at(), ["Motor (motor)", line("FOR i := 1 TO 3 DO")]);
    await go(client, client.stepBackRequest(thread));
    assert.deepEqual(await at(), ["Motor (motor)", calling]);
    await go(client, client.nextRequest(thread));
    assert.deepEqual(await at(), ["Motor (motor)", line("FOR i := 1 TO 3 DO")]);
    await go(client, client.customRequest("lineshaft/nextScan", thread));
    assert.deepEqual([...await at(), await count(client)], ["Motor (motor)", line("a := count;"), 1]);
    assert.equal((await go(client, client.reverseContinueRequest(thread))).reason, "entry");
    await client.stop();
  },

  async "threads, scopes, values, pages and watches"() {
    const { client } = await begin({}, (client) => client.setBreakpointsRequest({ source: { path: motor },
      breakpoints: [{ line: calling, hitCondition: "7" }] }));
    assert.deepEqual((await client.threadsRequest()).body.threads.map((each) => each.name), ["fast", "main"]);
    const [top, task] = await frames(client);
    const groups = await scopes(client, top.id);
    assert.deepEqual(Object.keys(groups), ["Inputs", "Outputs", "Locals"]);
    const locals = await inside(client, groups.Locals);
    assert.deepEqual([locals.mode.value, locals.table.indexedVariables], ["Mode#running", 300]);
    assert.deepEqual(Object.keys(await inside(client, locals.table.variablesReference, { start: 298, count: 2 })), ["[299]", "[300]"]);
    assert.equal(await value(client, "Outputs", "speed"), "3.0 mm/s");
    const { Blocks } = await scopes(client, task.id);
    assert.deepEqual(Object.keys(await inside(client, Blocks)), ["motor"]);
    for (const [expression, wanted] of [["count * 2 + 1", "13"], ["mode = Mode#running", "TRUE"], ["motor.speed", "3 mm/s"]])
      assert.equal((await client.evaluateRequest({ expression, frameId: top.id })).body.result, wanted);
    await assert.rejects(client.evaluateRequest({ expression: "nothing", frameId: top.id }), /not known/);
    await client.stop();
  },

  async "who wrote last, and a value that is set by hand and recorded"() {
    const recording = path.join(folder, "hand.yaml"), traces = ["hand", "again", "free"].map((name) => path.join(folder, `${name}.csv`));
    const { client } = await begin({ args: ["--record", recording, "--trace", traces[0]] }, (client) => client.setBreakpointsRequest({
      source: { path: motor }, breakpoints: [{ line: line("a := count;"), hitCondition: "9" }] }));
    const mode = { variablesReference: (await scopes(client, (await frames(client))[0].id)).Locals, name: "mode" };
    await go(client, client.customRequest("lineshaft/lastWriter", mode));
    assert.equal((await frames(client))[0].line, line("mode := Mode#running;"));
    const { Outputs } = await scopes(client, (await frames(client))[0].id);
    await client.setVariableRequest({ variablesReference: Outputs, name: "count", value: "40" });
    await client.setBreakpointsRequest({ source: { path: motor }, breakpoints: [] });
    const failed = 1; // motor.count goes on from 40, and is not what is expected at the end
    const run = async (client, start, code = failed) => {
      const exited = client.waitForEvent("exited", 30000);
      await start(client);
      assert.equal((await exited).body.exitCode, code);
      await client.stop();
    };
    await run(client, (client) => client.continueRequest(thread));
    assert.match(readFileSync(recording, "utf8"), /motor\.count: 40/);
    for (const [trace, args] of [[traces[1], ["--recording", recording]], [traces[2], []]]) {
      const again = new DebugClient(lineshaft, "debug", "lineshaft");
      await again.start();
      await run(again, (client) => Promise.all([client.configurationSequence(), client.launch({ program, args: [...args, "--trace", trace] })]),
        args.length > 0 ? failed : 0);
    }
    const [hand, again, free] = traces.map((trace) => readFileSync(trace, "utf8"));
    assert.equal(hand, again);
    assert.notEqual(hand, free);
  },

  async "pause, refusals, a place to go to, disconnect"() {
    const { client } = await begin({ stopAtEnd: true });
    await assert.rejects(client.customRequest("lineshaft/none"), /no request/);
    await assert.rejects(client.nextRequest({ threadId: 77 }), /no such task/);
    await assert.rejects(client.launchRequest({ program }), /already/);
    await client.pauseRequest(thread);
    const { time } = (await client.customRequest("lineshaft/state")).body;
    assert.equal(time, 1e9);
    await go(client, client.customRequest("lineshaft/goTo", { time: 5e8 }));
    assert.equal((await client.customRequest("lineshaft/state")).body.time, 5e8);
    await client.stop();
  },

  async "a TEST of a file"() {
    const { client, stop } = await begin({ program: tests, test: "a mark that comes late asks", stopOnEntry: true });
    assert.equal(stop.reason, "entry");
    const [top] = (await client.stackTraceRequest({ threadId: 1 })).body.stackFrames;
    assert.equal(path.basename(top.source.path), path.basename(tests));
    const exited = client.waitForEvent("exited", 30000);
    await client.continueRequest({ threadId: 1 });
    assert.equal((await exited).body.exitCode, 0);
    await client.stop();
  },
};

for (const [name, check] of Object.entries(checks)) {
  await check();
  console.log("ok", name);
}
