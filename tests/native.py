#!/usr/bin/python3
"""Native code of Structured Text and its interpreter: the same trace, the same messages of faults, and a checkpoint of
the one is resumed by the other. Where the system refuses executable memory it is interpreted, which is told once.

usage: native.py LINESHAFT
"""

import ctypes
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = """\
lineshaft: 1
tasks: {main: {every: 1 ms}}
sources: [job.st]
blocks: {job: {type: Job, task: main}}
run: {for: 300 ms}
trace: {task: main, signals: [job.n, job.level, job.error]}
"""
JOB = """\
FUNCTION Share : LREAL
VAR_INPUT a, b : DINT; END_VAR
Share := DINT_TO_LREAL(a / b);
END_FUNCTION
FUNCTION_BLOCK Job
VAR_OUTPUT n : DINT; level : LREAL; END_VAR
VAR i : DINT; t : ARRAY[0..9] OF LREAL; name : STRING[20]; END_VAR
n := n + 1;
FOR i := 0 TO 9 DO t[i] := t[i] * 0.5 + SIN(DINT_TO_LREAL(n + i)); END_FOR;
name := CONCAT('part ', DINT_TO_STRING(n));
CASE n MOD 7 OF
    0: level := t[0]; 1: level := t[n MOD 10]; 2: level := -level; 3: level := 1.0; 5: level := 2.0;
END_CASE;
level := level + Share(1000, LAST - n);
END_FUNCTION_BLOCK
"""
SET_MDWE, REFUSE_EXEC_GAIN = 65, 1  # prctl(2), Linux 6.3
INTERPRETED = "refuses executable memory"


def refuse():
    assert ctypes.CDLL(None).prctl(SET_MDWE, REFUSE_EXEC_GAIN, 0, 0, 0) == 0


def refuses():
    try:
        return subprocess.run(["true"], preexec_fn=refuse).returncode == 0
    except subprocess.SubprocessError:
        return False


class Runs:
    def __init__(self, lineshaft, folder):
        self.lineshaft, self.folder = lineshaft, folder

    def run(self, *arguments, code=0, before=None):
        """What it wrote and told."""
        trace = self.folder / "out.csv"
        answer = subprocess.run(
            [self.lineshaft, "run", "program.yaml", "--quiet", "--trace", trace, *arguments], cwd=self.folder,
            capture_output=True, text=True, preexec_fn=before, timeout=60)
        assert answer.returncode == code, answer
        return trace.read_bytes() if trace.exists() else None, answer.stdout, answer.stderr

    def write(self, last):
        (self.folder / "program.yaml").write_text(PROGRAM, encoding="utf-8")
        (self.folder / "job.st").write_text(JOB.replace("LAST", last), encoding="utf-8")


def check_ways(runs, code):
    native = runs.run(code=code)
    assert native[0] and INTERPRETED not in native[2], native
    assert native == runs.run("--no-native", code=code)
    if not refuses():
        print("this system cannot refuse executable memory")
        return native
    trace, out, err = runs.run(code=code, before=refuse)
    assert (trace, out) == native[:2] and err.count(INTERPRETED) == 1, err
    rest = "".join(line for line in err.splitlines(True) if INTERPRETED not in line)
    assert rest == native[2], (rest, native[2])
    assert runs.run("--no-native", code=code, before=refuse) == native
    return native


def check_checkpoints(runs):
    """Both leave the same one, and each goes on from the other's."""
    ways = (), ("--no-native",)
    kept, left = [runs.folder / f"{number}.checkpoint" for number in range(2)], []
    for way, file in zip(ways, kept):
        whole = runs.run(*way, "--checkpoint", file, "--checkpoint-every", "50 ms")[0]
        left.append((whole, file.read_bytes()))
    assert left[0] == left[1]
    for way in ways:
        for file in kept:
            assert runs.run(*way, "--checkpoint", file, "--resume")[0] == whole


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(lineshaft, pathlib.Path(folder))
        runs.write("1000")
        check_ways(runs, 0)
        check_checkpoints(runs)
        runs.write("100")
        told = check_ways(runs, 3)[2]
        assert "job.st:3:" in told and "called by Job (line 14)" in told, told
    print("native code and the interpreter write the same")


main()
