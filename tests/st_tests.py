#!/usr/bin/python3
"""TESTs of Structured Text: those of `pass` pass, those of `fail` fail with the messages of
fail/expected.txt, those of others (`fixtures`, `suites`) say what their expected.txt has, and each file of `bad` is refused with the message in the file NAME.txt beside it.

usage: st_tests.py LINESHAFT FOLDER [--update-expected]
"""

import difflib
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
root = pathlib.Path(sys.argv[2])
update = "--update-expected" in sys.argv
wrong = []


def run(folder, *arguments):
    answer = subprocess.run([lineshaft, "test", *arguments], cwd=folder, capture_output=True, timeout=60)
    said = re.sub(r" \(\d+\.\d\d s\)", "", answer.stdout.decode("utf-8"))
    return answer.returncode, said, answer.stderr.decode("utf-8")


def expect(what, value, wanted):
    if value != wanted:
        wrong.append(f"{what}: {value!r}, expected {wanted!r}")


def compare(golden, said):
    if update:
        golden.write_text(said, encoding="utf-8")
    expected = golden.read_text(encoding="utf-8") if golden.exists() else ""
    wrong.extend(difflib.unified_diff(expected.splitlines(), said.splitlines(), golden.name, "answer", lineterm=""))


def counts(text):
    """Of an lcov file: for each source what it says, as a list of (key, value)."""
    files = {}
    for record in text.split("end_of_record\n")[:-1]:
        lines = [line.split(":", 1) for line in record.splitlines()]
        files[next(value for key, value in lines if key == "SF")] = lines
    return files


def check_coverage(path):
    files = counts(path.read_text(encoding="utf-8"))
    expect("covered", sorted(files), [f"pass/{name}.st" for name in (
        "counter", "globals", "mocks", "pairs/a", "pairs/b", "values")])
    for name, lines in files.items():
        totals = {key: int(value) for key, value in lines if key in ("LF", "LH", "BRF", "BRH", "FNF", "FNH")}
        hit = lambda key, at: sum(k == key and v.split(",")[at] not in ("0", "-") for k, v in lines)
        of = lambda key: sum(k == key for k, _ in lines)
        expect(f"totals of {name}", totals, {
            "LF": of("DA"), "LH": hit("DA", 1), "BRF": of("BRDA"), "BRH": hit("BRDA", 3),
            "FNF": of("FN"), "FNH": hit("FNDA", 0)})
    counter = [":".join(line) for line in files["pass/counter.st"]]
    text = (root / "pass/counter.st").read_text(encoding="utf-8").splitlines()
    line = next(i for i, t in enumerate(text, 1) if t.startswith("IF reset"))
    branches = [entry.split(",") for entry in counter if entry.startswith(f"BRDA:{line},")]
    expect("branches of the IF", [b[2] for b in branches], ["0", "1", "2"])
    expect("the branch that no test takes", branches[2][3], "0")
    passes = sum(int(b[3]) for b in branches)
    expect("the IF was reached as often as its branches", f"DA:{line},{passes}" in counter, True)


with tempfile.TemporaryDirectory() as folder:
    junit, info = pathlib.Path(folder, "out.xml"), pathlib.Path(folder, "out.info")
    code, said, errors = run(root, "pass", "--junit", str(junit), "--coverage", str(info))
    expect("exit code of what passes", (code, errors), (0, ""))
    if code != 0:
        wrong.append(said)
    cases = xml.parse(junit).getroot().findall("testcase")
    declared = sum(len(re.findall(r"^TEST ", file.read_text(encoding="utf-8"), re.M))
                   for file in (root / "pass").rglob("*test*.s*"))
    expect("cases in the JUnit file", len(cases), declared)
    expect("a case", {key: cases[-1].get(key) for key in ("classname", "file", "name")},
           {"classname": "pass/tests/values_test.st", "file": "pass/tests/values_test.st", "name": "leaves early"})
    check_coverage(info)
    code, said, _ = run(root / "fail", "machine_test.st", "--junit", str(junit))
    expect("exit code of what fails", code, 1)
    compare(root / "fail/expected.txt", said)
    suite = xml.parse(junit).getroot()
    expect("failures and errors", (suite.get("failures"), suite.get("errors")), ("21", "4"))
    run(root / "bad", "no_test.st", "--junit", str(junit))
    case = xml.parse(junit).getroot().find("testcase")
    expect("a file that is refused", [case.get(key) for key in ("classname", "file", "name")], ["no_test.st"] * 3)
    pathlib.Path(folder, "twice_test.st").write_text("TEST 'a' ASSERT_TRUE(TRUE); END_TEST\n" * 2, encoding="utf-8")
    said = subprocess.run([lineshaft, "check", "twice_test.st"], cwd=folder, capture_output=True, timeout=60).stderr
    expect("two TESTs of one name", said.splitlines()[:1], [b"twice_test.st:2:6: warning[L0909]: two TESTs have one name"])
    pathlib.Path(folder, "twice_test.st").write_text("TEST 'a' ASSERT_TRUE(TRUE); END_TEST\n", encoding="utf-8")
    latin = "FUNCTION_BLOCK p\nVAR x : INT; END_VAR\nx := 1;\nEND_FUNCTION_BLOCK\nTEST 'grüß'\n ASSERT_TRUE(FALSE, 'ü');\nEND_TEST\n"
    pathlib.Path(folder, "latin_test.st").write_bytes(latin.encode("iso-8859-1"))
    code, said, errors = run(pathlib.Path(folder), "latin_test.st", "--junit", str(junit))
    told = "latin_test.st:6: ASSERT_TRUE(FALSE, 'ü'): expected TRUE, found FALSE; ü"
    expect("a test in Latin-1", (code, said.splitlines()[:2], errors), (1, ["FAILED  latin_test.st: grüß", "        " + told], ""))
    case = xml.parse(junit).getroot().find("testcase")
    expect("its case", (case.get("name"), case.find("failure").text), ("grüß", told))
    pathlib.Path(folder, "latin_test.st").unlink()
    pathlib.Path(folder, "large_test.st").write_text("// so many words\n" * (1 << 16), encoding="utf-8")
    code, said, _ = run(pathlib.Path(folder), ".")
    expect("a file of a folder that is too large is told", (code, "large_test.st' has more than" in said), (1, True))

with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "endless.st").write_text("""PROGRAM Main
VAR k, n : DINT; a, b : DINT := 1; END_VAR
k := 0; n := 0;
WHILE k < 3 DO k := k + 1; END_WHILE;
WHILE a <> b + 1 DO n := n + 1; END_WHILE;
END_PROGRAM
""", encoding="utf-8")
    pathlib.Path(folder, "endless.yaml").write_text("""lineshaft: 1
tasks: {main: {every: 10 ms}}
sources: endless.st
blocks: {m: {type: Main, task: main}}
run: {for: 20 ms, on_error: continue}
trace: {task: main, signals: [m.n]}
expect: [{at: end, m.n: 1}]
""", encoding="utf-8")
    traces = []
    for options in ([], ["--coverage", "out.info"], ["--no-native"]):
        run(folder, "endless.yaml", "--trace-failed", "traces", *options)
        traces.append(pathlib.Path(folder, "traces", "endless.csv").read_text(encoding="utf-8"))
    expect("a loop that does not end, with coverage and interpreted", traces[1:], traces[:1] * 2)

code, said, _ = run(root, "pass", "--filter", "mocked function")
expect("--filter", (code, said.splitlines()[-1]), (0, "1 of 1 passed"))
code, said, _ = run(root, "pass/tests/values_test.st")
expect("a folder of tests sees the one around it", (code, said.splitlines()[-1]), (0, "6 of 6 passed"))
code, said, _ = run(root, "fail/machine_test.st", "--filter", "equal", "--source", "pass")
expect("--source", code, 1)
code, _, errors = run(root, "pass/counter.st")
expect("a file without a TEST", code, 1)

for folder in "fixtures", "suites":
    code, said, errors = run(root, folder)
    expect(f"exit code of {folder}", (code, errors), (1, ""))
    compare(root / folder / "expected.txt", said)
with tempfile.TemporaryDirectory() as folder:
    junit, info = pathlib.Path(folder, "out.xml"), pathlib.Path(folder, "out.info")
    run(root, "fixtures", "suites", "--junit", str(junit), "--coverage", str(info))
    cases = [(case.get("file"), case.get("line"), case.get("name")) for case in xml.parse(junit).getroot().iter("testcase")]
    for file in "fixtures/test/ScalerTest.st", "suites/counter_suite.st":
        lines = (root / file).read_text(encoding="utf-8").splitlines()
        begins = [line for path, line, _ in cases if path == file]
        expect(f"cases of {file} have the lines of their tests", all(
            any(word in " ".join(lines[max(0, int(line) - 4):int(line)]) for word in ("{Test", "TEST")) for line in begins if line), True)
        expect(f"{file} has cases", bool(begins), True)
    expect("what they cover", {"fixtures/src/scaler.st", "suites/counter.st"} <= set(counts(info.read_text(encoding="utf-8"))), True)
_, said, _ = run(root, "fixtures", "suites", "--list", "--filter", "Table|waits")
expect("--list of tests of others", said.splitlines(), [
    'fixtures/test/ScalerTest.st: ScalerTest.Table(raw := LREAL#1.0, wanted := LREAL#3.0)',
    'fixtures/test/ScalerTest.st: ScalerTest.Table(raw := LREAL#-2.0, wanted := LREAL#-6.0)',
    'fixtures/test/ScalerTest.st: ScalerTest.Table(raw := LREAL#2.0, wanted := LREAL#5.0)',
    'suites/counter_suite.st: Main.counting: waits'])

with tempfile.TemporaryDirectory() as folder:
    readme = (root / "../../programs/README.md").read_text(encoding="utf-8")
    block, test = [text for text in re.findall(r"^```pascal\n(.*?)^```", readme, re.M | re.S) if "Filler" in text]
    program = re.search(r"^```yaml\n(sources: filler.st\n.*?)^```", readme, re.M | re.S)[1]
    pathlib.Path(folder, "filler.st").write_text(block, encoding="utf-8")
    pathlib.Path(folder, "filler_test.st").write_text(test, encoding="utf-8")
    pathlib.Path(folder, "filler.yaml").write_text(
        "lineshaft: 1\ntitle: Filler\ntasks: {main: {every: 1 ms}}\ninputs: {go: true}\nrun: {for: 100 ms}\n" + program,
        encoding="utf-8")
    code, said, errors = run(pathlib.Path(folder), ".")
    expect("the examples of programs/README.md", (code, said.splitlines()[-1], errors), (0, "2 of 2 passed", ""))

for path in sorted((root / "bad").glob("*.st")):
    code, said, errors = run(path.parent, path.name)
    expect(f"exit code of {path.name}", (code, errors), (1, ""))
    compare(path.with_suffix(".txt"), said)
    if not re.search(r"^ *\S+\.st:(\d+:\d+:)? error\[L\d{4}\]: ", said, re.M):
        wrong.append(f"{path.name}: no message with a place")

print("\n".join(wrong) or "ok")
sys.exit(bool(wrong))
