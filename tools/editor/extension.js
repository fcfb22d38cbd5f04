// The language server, the debugger, the tests and the pages of lineshaft in VS Code. What they know, `lineshaft` knows.
const { execFile } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

const command = () => vscode.workspace.getConfiguration("lineshaft").get("command");
const shown = (text) => `'${text.replaceAll("'", "'\\''")}'`;

/** Runs lineshaft in a folder: its exit code and what it printed. */
function lineshaft(parameters, cwd) {
  return new Promise((resolve) => {
    execFile(command(), parameters, { cwd, maxBuffer: 64 << 20 }, (error, stdout, stderr) =>
      resolve({ code: error ? (error.code ?? 1) : 0, stdout, stderr }));
  });
}

function inTerminal(parameters) {
  const terminal = vscode.window.terminals.find((t) => t.name === "lineshaft") ?? vscode.window.createTerminal("lineshaft");
  terminal.show();
  terminal.sendText([command(), ...parameters].map(shown).join(" "));
}

const fileAtHand = (file) => file ?? vscode.window.activeTextEditor?.document.uri.fsPath;
const escaped = (text) => text.replaceAll(/[.*+?^${}()|[\]\\]/g, "\\$&");

function debug(file, test) {
  const launch = { type: "lineshaft", request: "launch", name: test ?? path.basename(file), program: file, stopOnEntry: true };
  return vscode.debug.startDebugging(undefined, test ? { ...launch, test } : launch);
}

/** A run of the program at hand, as the page that `lineshaft report` writes, in a tab. */
async function showPage(given) {
  const file = fileAtHand(given);
  if (!file) return;
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "lineshaft-"));
  const trace = path.join(folder, "trace.csv"), page = path.join(folder, "page.html");
  await lineshaft(["run", file, "--trace", trace], path.dirname(file));
  const written = await lineshaft(["report", trace, "-o", page], path.dirname(file));
  if (!fs.existsSync(page)) {
    vscode.window.showErrorMessage(`lineshaft: ${written.stderr || "the program has no trace"}`);
    return;
  }
  const panel = vscode.window.createWebviewPanel("lineshaft", path.basename(file), vscode.ViewColumn.Beside, { enableScripts: true });
  panel.webview.html = fs.readFileSync(page, "utf8");
  fs.rmSync(folder, { recursive: true });
}

/** `path` or `path: name of a TEST`, as `lineshaft test --list` prints them. */
function addTest(controller, folder, line) {
  const [, file, name] = /^(.*?\.\w+)(?:: (.*))?$/.exec(line) ?? [];
  if (!file) return;
  const uri = vscode.Uri.file(path.resolve(folder, file));
  let item = controller.items.get(uri.fsPath);
  if (!item) {
    item = controller.createTestItem(uri.fsPath, file, uri);
    controller.items.add(item);
  }
  if (name) item.children.add(controller.createTestItem(`${uri.fsPath}: ${name}`, name, uri));
}

async function findTests(controller) {
  controller.items.replace([]);
  for (const { uri } of vscode.workspace.workspaceFolders ?? []) {
    const { stdout } = await lineshaft(["test", "--list", "."], uri.fsPath);
    for (const line of stdout.split("\n")) addTest(controller, uri.fsPath, line.trim());
  }
}

const unescaped = (text) =>
  text.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&quot;", '"').replaceAll("&apos;", "'").replaceAll("&#10;", "\n").replaceAll("&amp;", "&");

/** The failure of each case of a JUnit report, by the case's name; empty of one that passes. */
function failuresIn(xml) {
  const found = new Map();
  for (const [, attributes, , body] of xml.matchAll(/<testcase\b([^>]*?)(\/>|>([\s\S]*?)<\/testcase>)/g)) {
    const name = unescaped(/\bname="([^"]*)"/.exec(attributes)?.[1] ?? "");
    const failure = /<(?:failure|error)\b[^>]*?(?:message="([^"]*)")?[^>]*>([\s\S]*?)</.exec(body ?? "");
    const skipped = /<skipped/.test(body ?? "");
    found.set(name, { text: failure ? unescaped(failure[2].trim() || failure[1] || "failed") : "", skipped });
  }
  return found;
}

async function runTests(controller, request) {
  const run = controller.createTestRun(request);
  const wanted = request.include ?? [...controller.items].map(([, item]) => item);
  for (const item of wanted) {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), "lineshaft-"));
    const junit = path.join(folder, "results.xml");
    const leaves = item.children.size ? [...item.children].map(([, child]) => child) : [item];
    leaves.forEach((leaf) => run.started(leaf));
    const filter = item.parent ? ["--filter", `: ${escaped(item.label)}$`] : [];
    const { stderr, stdout } = await lineshaft(["test", item.uri.fsPath, "--junit", junit, ...filter], path.dirname(item.uri.fsPath));
    const cases = fs.existsSync(junit) ? failuresIn(fs.readFileSync(junit, "utf8")) : new Map();
    for (const leaf of leaves) {
      const result = cases.get(leaf.label) ?? cases.get(item.uri.fsPath) ?? { text: stderr || stdout };
      if (result.skipped) run.skipped(leaf);
      else if (result.text) run.failed(leaf, new vscode.TestMessage(result.text));
      else run.passed(leaf);
    }
    fs.rmSync(folder, { recursive: true });
  }
  run.end();
}

function addTests(context) {
  const controller = vscode.tests.createTestController("lineshaft", "lineshaft");
  controller.refreshHandler = () => findTests(controller);
  controller.resolveHandler = (item) => (item ? undefined : findTests(controller));
  controller.createRunProfile("Run", vscode.TestRunProfileKind.Run, (request) => runTests(controller, request), true);
  controller.createRunProfile("Debug", vscode.TestRunProfileKind.Debug, ({ include }) =>
    Promise.all((include ?? []).map((item) => debug(item.uri.fsPath, item.parent ? item.label : undefined))));
  context.subscriptions.push(controller);
}

function activate(context) {
  const server = { command: command(), args: ["lsp"] };
  client = new LanguageClient("lineshaft", "lineshaft", server, {
    documentSelector: [{ scheme: "file", language: "lineshaft-st" }, { scheme: "file", pattern: "**/*.yaml" }],
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{yaml,st,scl,s7dcl,udt,db,exp,typ,var,fun}") },
  });
  client.start();
  const adapter = { createDebugAdapterDescriptor: () => new vscode.DebugAdapterExecutable(command(), ["debug"]) };
  const commands = {
    "lineshaft.run": (file) => fileAtHand(file) && inTerminal(["run", fileAtHand(file)]),
    "lineshaft.debug": (file, test) => fileAtHand(file) && debug(fileAtHand(file), test),
    "lineshaft.test": (file, test) =>
      fileAtHand(file) && inTerminal(["test", fileAtHand(file), ...(test ? ["--filter", `: ${escaped(test)}$`] : [])]),
    "lineshaft.report": showPage,
  };
  context.subscriptions.push(
    vscode.debug.registerDebugAdapterDescriptorFactory("lineshaft", adapter),
    ...Object.entries(commands).map(([name, what]) => vscode.commands.registerCommand(name, what)),
  );
  addTests(context);
}

module.exports = { activate, deactivate: () => client?.stop(), failuresIn };
