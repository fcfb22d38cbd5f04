#!/usr/bin/python3
"""`lineshaft test` as a runner of suites: order, filter, list, first failure, traces of what fails, JUnit.

usage: suite.py LINESHAFT
"""

import pathlib
import re
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
print("ok")
