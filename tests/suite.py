#!/usr/bin/python3
"""`lineshaft test` as a runner of suites: order, filter, list, first failure, traces of what fails, JUnit.

usage: suite.py LINESHAFT
"""

import json
import os
import pathlib
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
folder = pathlib.Path(tempfile.mkdtemp())


def program(name, *wanted):
    (folder / name).write_text(
        "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nblocks: {n: {type: ctu, task: t, cu: inputs.on, pv: 3}}\n"
        "inputs: {on: true}\nrun: {for: 5 ms}\ntrace: {task: t, signals: [n.cv]}\nexpect:\n" + "".join(f"  - {{at: end, {w}}}\n" for w in wanted))


def test(*arguments, code=0):
    answer = subprocess.run([lineshaft, "test", *arguments], cwd=folder, capture_output=True, text=True, timeout=60)
    assert answer.returncode == code, (arguments, answer)
    return re.sub(r" \(\d+\.\d\d s\)", "", answer.stdout).splitlines(), answer.stderr


assert "'nothere': it does not exist" in test("nothere", code=2)[1]
for i in range(20):
    program(f"a{i:02}.yaml", "n.cv: 1")
program("b.yaml", "n.cv: 2", "n.q: true", "n.cv: 1")
program("c.yaml", "n.cv: 1")
(folder / "d_test.st").write_text("TEST 'one and one' ASSERT_EQ(1 + 1, 2); END_TEST\nTEST 'nothing' END_TEST\n")
(folder / "e.yaml").write_text(
    "lineshaft_fit: 1\nprogram: f.yaml\nparameters: {count: {from: 0, to: 10, start: 4}}\n"
    "cases: [{compare: {s.out: {paper: 6, within: 0.1}}}]\n")
(folder / "f.yaml").write_text(
    "lineshaft: 1\nparameters: {count: 3.0}\ntasks: {t: {every: 1 ms}}\nblocks: {s: {type: add, task: t, in1: $count, in2: 1}}\n"
    "run: {for: 1 ms}\nexpect: [{at: end, s.out: 4}]\n")

one, _ = test(".", code=1)
assert test(".", "-j", "7", code=1)[0] == one, "the order does not depend on the jobs"
assert one[-1] == "25 of 26 passed" and one.count("ok      e.yaml") == 1, one
b = one.index("FAILED  b.yaml")
assert one[b + 1].endswith("expected 2") and one[b + 2].endswith("expected true") and one[b + 3].startswith("ok"), one
assert test("--list", ".")[0][-5:] == ["c.yaml", "d_test.st: one and one", "d_test.st: nothing", "e.yaml", "f.yaml"]
assert test(".", "--filter", "^a0[0-4]|one and")[0][-1] == "6 of 6 passed"
assert test(".", "--filter", "one and", "--list")[0] == ["d_test.st: one and one"]
assert "not a regular expression" in test(".", "--filter", "(", code=2)[1]
assert "filter leaves" in test(".", "--filter", "nothing of that", code=2)[1]
for jobs in "1", "4":
    said, _ = test(".", "--fail-fast", "-j", jobs, code=1)
    assert said[-1] == "20 of 21 passed" and "FAILED  b.yaml" in said, said

test(".", "--trace-failed", "traces", "--junit", "out.xml", code=1)
traced = sorted(p.name for p in (folder / "traces").iterdir())
assert "b.csv" in traced and all(name.startswith("b.") for name in traced), traced
failed = xml.parse(folder / "out.xml").getroot().find("testcase[@name='b.yaml']").findall("failure")
assert len(failed) == 2 and all("lineshaft run b.yaml --trace traces/b.csv" in f.text for f in failed), failed
(folder / "file").write_text("")
assert "cannot make" in test(".", "--trace-failed", "file/below", code=2)[1]


def write(name, text):
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return str(path)


def run(*arguments, code):
    answer = subprocess.run([lineshaft, *arguments], cwd=folder, capture_output=True, text=True, timeout=60)
    assert answer.returncode == code, (arguments, answer)
    return answer.stdout


# What a run is too short for is undecided, and that is not ok.
EXPECTATIONS = """
  - {at: end, n.cv: 1}
  - {at: 2 ms, n.cv: 1}
  - {at: 50 ms, n.cv: 1}
  - {between: [1 ms, 3 ms], n.cv: 1}
  - {between: [1 ms, 50 ms], n.cv: 1}
  - {always: n.cv, at_most: 1}
  - {never: n.q}
  - {rising: inputs.on, at_least: 1}
  - {rising: inputs.on, count: 1}
  - {within 1 s of inputs.on: n.q}
  - {within 1 s of inputs.on: inputs.on}
"""
undecided = write("short/program.yaml", "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nsources: fault.st\nparameters: {fault: 100}\n"
                  "blocks:\n  n: {type: ctu, task: t, cu: inputs.on, pv: 3}\n  f: {type: Fault, task: t, at: $fault}\n"
                  "inputs: {on: false}\nstimulus: [{at: 1 ms, set: {inputs.on: true}}]\nrun: {for: 6 ms}\nexpect:" + EXPECTATIONS)
write("short/fault.st", "FUNCTION_BLOCK Fault\nVAR_INPUT CONSTANT at : INT; END_VAR VAR scans, x : INT; END_VAR\n"
      "scans := scans + 1; x := 10 / (at - scans);\nEND_FUNCTION_BLOCK\n")


def words(text):
    return [line.split()[0] for line in text.splitlines() if re.match("ok|FAILED|UNDECIDED", line)]


said = run("run", undecided, code=1)
assert words(said) == ["ok"] * 2 + ["UNDECIDED", "ok", "UNDECIDED"] + ["ok"] * 4 + ["UNDECIDED", "ok"], said
assert "inputs.on rises at 0.001 s, and whether n.q follows until 1.001 s is undecided: the run ended at 0.006 s; let it run longer" in said
judged = json.loads(run("run", undecided, "--json", code=1))["expect"]
assert [e.get("undecided", False) for e in judged] == [word == "UNDECIDED" for word in words(said)], judged
failed, _ = test("short", code=1)
assert len([line for line in failed if "is undecided" in line]) == 3 and failed[-1] == "0 of 1 passed", failed
# The fifth scan fails, at 4 ms: only what was judged to its end is ok.
said = run("run", undecided, "--set", "fault=5", code=3)
assert [i for i, word in enumerate(words(said)) if word == "ok"] == [1, 3, 7] and "FAILED" not in words(said), said
write("broken/fault.st", pathlib.Path(folder / "short/fault.st").read_text())
write("broken/program.yaml", pathlib.Path(undecided).read_text().replace("fault: 100", "fault: 5"))
failed, _ = test("broken", code=1)
assert len(failed) == 3 and "division_by_zero" in failed[1], failed  # the fault, not what it left undecided

# Why something is expected is told with the verdict.
reasoned = write("because.yaml", "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nblocks: {n: {type: ctu, task: t, cu: true, pv: 3}}\n"
                 "run: {for: 1 ms}\nexpect: [{at: end, n.cv: 2, because: a level counts once}]\n")
assert "FAILED  at the end: n.cv = 2, because a level counts once" in run("run", reasoned, code=1)
pathlib.Path(reasoned).unlink()

# What takes minutes is marked, and runs when it is asked for.
quick = "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nblocks: {n: {type: ctu, task: t, cu: inputs.on, pv: 3}}\ninputs: {on: false}\nexpect: [{at: end, n.cv: 0}]\n"
write("marked/a.yaml", quick + "run: {for: 1 ms}\n")
write("marked/b.yaml", quick + "run: {for: 1 ms}\nslow: true\n")
write("marked/c.yaml", "lineshaft_study: 1\nprogram: a.yaml\nslow: true\ncases: [{compare: [n.cv]}]\n")
write("marked/d.yaml", quick + "run: {for: 1 ms}\nslow: false\n")
said, _ = test("--junit", "marked.xml", "marked")
assert said[-2:] == ["2 of 2 passed", "skipped as slow, --slow runs them: marked/b.yaml, marked/c.yaml"], said
assert "skipped marked/b.yaml: slow, --slow runs it" in said, said
assert len(xml.parse(folder / "marked.xml").getroot().findall("testcase/skipped")) == 2
assert test("--slow", "marked")[0][-1] == "4 of 4 passed"
assert test("marked/b.yaml")[0][-1] == "1 of 1 passed", "what is named runs"

# A folder is checked with its programs, and what two of them have of Structured Text is told once.
wrong = write("wrong/a.yaml", quick + "run: {for: 1 ms}\nsources: wrong.st\n")
write("wrong/b.yaml", pathlib.Path(wrong).read_text().replace("pv: 3", "pv: three"))
write("wrong/c.yaml", pathlib.Path(wrong).read_text())
write("wrong/wrong.st", "FUNCTION_BLOCK Wrong VAR x : INT; END_VAR x := TRUE; END_FUNCTION_BLOCK\n")
write("wrong/alone.st", "FUNCTION_BLOCK Alone VAR x : INT; END_VAR x := y; END_FUNCTION_BLOCK\n")
write("wrong/names_of_another.st", "FUNCTION_BLOCK Wrong VAR x : INT; END_VAR x := 1; END_FUNCTION_BLOCK\n")
checked = subprocess.run([lineshaft, "check", "wrong"], cwd=folder, capture_output=True, text=True, timeout=60)
places = re.findall(r"^wrong/(\S+):\d+:\d+: error", checked.stderr, re.M)
assert checked.returncode == 2 and sorted(places) == ["alone.st", "b.yaml", "wrong.st"], checked
assert run("check", "marked", code=0) == "ok  marked: 4 files\n"
assert run("check", "short/fault.st", code=0) == "ok  short/fault.st\n"

# What stands at the end, by name or of a block.
write("seen/main.st", "PROGRAM Main\nVAR n : INT := 3; t : TON; s : STRING := 'it$'s'; w : ARRAY[0..1] OF WSTRING := [2(\"ä\")]; "
      "p : STRUCT x : INT; y : STRING; END_STRUCT; END_VAR\nEND_PROGRAM\n")
write("seen/a.yaml", "lineshaft: 1\nsources: [main.st]\ntasks: {t: {every: 1 ms}}\n"
      "blocks: {main: {type: Main, task: t}}\nrun: {for: 1 ms}\n")
shown = run("run", "seen/a.yaml", "--show", "main", code=0)
shown = dict(line.split(None, 1) for line in shown.splitlines() if line.startswith("main."))
assert shown["main.n"] == "3" and shown["main.t.q"] == "false" and shown["main.p.x"] == "0", shown
assert shown["main.s"] == "'it$'s'" and shown["main.w[1]"] == "'ä'" and shown["main.p.y"] == "''", shown
assert json.loads(run("run", "seen/a.yaml", "--show", "main.w,main.p,main.s,main.n", "--json", code=0))["show"] == \
    {"main.w[0]": "ä", "main.w[1]": "ä", "main.p.x": 0, "main.p.y": "", "main.s": "it's", "main.n": 3}
refused = subprocess.run([lineshaft, "run", "seen/a.yaml", "--show", "Main"], cwd=folder, capture_output=True, text=True)
assert refused.returncode == 2 and "no block 'Main'" in refused.stderr and "'main'" in refused.stderr, refused
said = run("run", "marked/a.yaml", "--show", "n,inputs.on", code=0).splitlines()
assert [line.split() for line in said[-4:]] == [["n.q", "false"], ["n.cv", "0"], ["n.error", "false"], ["inputs.on", "false"]] or \
    [line.split() for line in said[-3:]] == [["n.q", "false"], ["n.cv", "0"], ["inputs.on", "false"]], said
assert json.loads(run("run", "marked/a.yaml", "--show", "n.cv", "--json", code=0))["show"] == {"n.cv": 0}
refused = subprocess.run([lineshaft, "run", "marked/a.yaml", "--show", "n.vc"], cwd=folder, capture_output=True, text=True)
assert refused.returncode == 2 and "n.vc" in refused.stderr or "'vc'" in refused.stderr, refused

# What is nearly right is told.
write("nearly/one.st", "TEST 'one'\n  ASSERT_TRUE(TRUE);\nEND_TEST\n")
for asked, words in ((["run", "marked/a"], "did you mean 'marked/a.yaml'?"), (["run", "marked/a.yml"], "did you mean 'marked/a.yaml'?"),
                     (["run", "marked/a.yaml", "--trcae", "x.csv"], "did you mean '--trace'?\nlineshaft run --help says more"),
                     (["run", "nearly/one.st"], "'lineshaft test one.st' runs its TESTs"), (["explain", "axis"], "did you mean 'axes'?"),
                     (["run", "marked/a.yaml", "--show", "on"], "did you mean 'inputs.on'?"), (["explain", "qqq"], "'lineshaft explain' lists them")):
    refused = subprocess.run([lineshaft, *asked], cwd=folder, capture_output=True, text=True)
    assert refused.returncode == 2 and words in refused.stderr, (asked, refused)

# Helps say choices as people write them; blocks are searched.
commands = re.findall(r"^  ([a-z]+) ", run("--help", code=0).split("Subcommands:")[1], re.M)
assert len(commands) > 15
for command in commands:
    assert "value in" not in run(command, "--help", code=0) and "OR {" not in run(command, "--help", code=0), command
determinism = pathlib.Path(__file__).parents[1] / "tools" / "determinism"
said = subprocess.run([determinism, "--help"], cwd=folder, capture_output=True, text=True, timeout=60)
assert said.returncode == 0 and "--full" in said.stdout and said.stderr == "", said
found = [line.split()[0] for line in run("blocks", "Gear", code=0).splitlines()]
assert {"MC_GearIn", "MC_GearOut", "MC_GearInPos"} <= set(found) and len(found) < 10, found
assert [line.split()[0] for line in run("blocks", "gear", "leaves", code=0).splitlines()] == ["MC_GearOut"]
for name in ("mc_movemodulo", "Tc2_MC2.MC_MoveModulo"):
    said = run("blocks", name, code=0)
    assert said.startswith("of the library Tc2_MC2:\n// Moves") and "Direction : MC_Direction" in said and "ErrorID" in said, said
    assert "command" not in said, said
assert "Tc2_MC2" in run("blocks", "Tc2_MC2.MC_MoveAbsolute", code=0)
said = run("blocks", "MC_MOVEABSOLUTE", code=0)
assert "mcShortestWay" in said and "lineshaft blocks Tc2_MC2.MC_MoveAbsolute\n" in said, said
assert "MotionControl.Native.MC_MoveAbsolute\n" in said, said
assert "Libraries" not in run("blocks", "MC_MovePath", code=0)
said = run("blocks", "sm3_robotics", code=0)
assert re.search("^MC_GroupStop +Stops a group on its path, and holds it while Execute is there", said, re.M) and "error_of" not in said, said
said = run("blocks", "Siemens.Simatic.S71500.MotionControl.Native", code=0)
assert re.search("^MC_GearInPos ", said, re.M) and "isFarFrom" not in said, said
said = subprocess.run([lineshaft, "blocks", "Tc9_None.Block"], cwd=folder, capture_output=True, text=True)
assert said.returncode == 2 and "there is no block type 'Tc9_None.Block'" in said.stderr, said

# A comment in Latin-1 is text as another.
(folder / "latin.st").write_bytes("FUNCTION_BLOCK p\nVAR_INPUT x : INT; (* õä *) END_VAR\nEND_FUNCTION_BLOCK\n".encode("iso-8859-1"))
described = json.loads(run("blocks", "latin.st", "--json", code=0))
assert [field["doc"] for field in described[0]["fields"] if field["name"] == "x"] == ["õä"], described

# Which axis a command refers to.
write("axis.yaml", "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nblocks:\n  x: {type: axis, task: t}\n"
      "  stop: {type: MC_Stop, task: t, Axis: x, Execute: true}\nrun: {for: 1 ms}\n")
assert re.search(r"2 stop +MC_Stop\n +Axis +-> x\n", run("show", "axis.yaml", code=0))
assert "stop -> x" in run("show", "axis.yaml", "--dot", code=0).replace('"', "")
assert json.loads(run("show", "axis.yaml", "--json", code=0))["tasks"][0]["blocks"][1]["references"] == {"Axis": "x"}

# A terminal shows what is at work.
write("long/a.yaml", quick + "run: {for: 1 ms}\n")
write("long/b.yaml", quick + "run: {for: 100000 h}\n")
terminal, other = pty.openpty()
running = subprocess.Popen([lineshaft, "test", "long"], cwd=folder, stdout=subprocess.PIPE, stderr=other)
shown = ""
while not re.search(r"1 of 2 files, at work: long/b\.yaml \([1-9]\d* s\)", shown):
    assert select.select([terminal], [], [], 20)[0], shown
    shown += os.read(terminal, 1000).decode()
running.kill()
running.wait()

# So it does of suites of TcUnit, one of which ends when it is told to although its scan does not.
write("endless/MAIN.st", """FUNCTION_BLOCK Endless EXTENDS TcUnit.FB_TestSuite
VAR i : LINT; END_VAR
TEST('endless');
WHILE i >= 0 DO
    i := (i + 1) MOD 1000;
END_WHILE
TEST_FINISHED();
END_FUNCTION_BLOCK
PROGRAM MAIN
VAR suite : Endless; END_VAR
TcUnit.RUN();
END_PROGRAM
""")
for sent in signal.SIGINT, signal.SIGTERM:
    terminal, other = pty.openpty()
    running = subprocess.Popen([lineshaft, "test", "endless"], cwd=folder, stdout=subprocess.PIPE, stderr=other)
    shown = ""
    while "at work: endless/MAIN.st, MAIN.suite (" not in shown:
        assert select.select([terminal], [], [], 20)[0], shown
        shown += os.read(terminal, 1000).decode()
    running.send_signal(sent)
    assert running.wait(timeout=20) == 130
print("ok")
