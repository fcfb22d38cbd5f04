#!/usr/bin/python3
"""A program with interfaces, references, pointers, a method that meets itself, a UNION, a process image and a sequence is
resumed from its checkpoint at scans drawn at random, with native code or without before and behind: the trace and the last
checkpoint are those of a run that was not resumed.

usage: resume.py LINESHAFT [STOPS [SEED]]
"""

import pathlib
import random
import subprocess
import sys
import tempfile

SCANS = 240
PROGRAM = """\
lineshaft: 1
tasks: {{main: {{every: 1 ms}}}}
sources: [job.st]
blocks: {{job: {{type: Job, task: main}}}}
io: {{"%QB5": job.fed}}
run: {{for: {scans} ms}}
trace: {{task: main, signals: [job.n, job.sum, job.total, job.steps, job.at_image, job.bits, job.error, "%QW0", "%MB9"]}}
"""
JOB = """\
TYPE
  Raw : UNION r : REAL; d : DWORD; b : ARRAY[0..3] OF BYTE; END_UNION;
  Item : STRUCT id : INT; value : REAL; raw : Raw; END_STRUCT;
END_TYPE
VAR_GLOBAL
  shared : Raw; word AT %QW0 : WORD; low AT %MB9 : BYTE; items : ARRAY[0..7] OF Item;
END_VAR
INTERFACE Counting
  METHOD Count : DINT VAR_INPUT step : DINT; END_VAR END_METHOD
END_INTERFACE
FUNCTION_BLOCK Up IMPLEMENTS Counting
VAR kept : DINT; END_VAR
METHOD Count : DINT VAR_INPUT step : DINT; END_VAR kept := kept + step; Count := kept; END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Down EXTENDS Up
VAR p : POINTER TO DINT; END_VAR
METHOD OVERRIDE Count : DINT VAR_INPUT step : DINT; END_VAR p := ADR(kept); p^ := p^ - step; Count := p^; END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Back
VAR_INPUT me : POINTER TO Back; END_VAR
METHOD Squares : DINT VAR_INPUT depth, n : DINT; END_VAR VAR own : DINT; END_VAR
own := n * n;
IF depth > 0 THEN Squares := me^.Squares(depth - 1, n + 1); END_IF
Squares := Squares + own * depth;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Walk
VAR_OUTPUT passes : DINT; END_VAR
VAR waits : INT; END_VAR
INITIAL_STEP Idle: END_STEP
TRANSITION FROM Idle TO Left := TRUE; END_TRANSITION
STEP Left: Lift(N); END_STEP
TRANSITION FROM Left TO (Far, Near) := waits MOD 3 = 0; END_TRANSITION
STEP Far: Lift(L, T#5ms); END_STEP
STEP Near: END_STEP
TRANSITION FROM (Far, Near) TO Idle := Near.T >= T#7ms; END_TRANSITION
ACTION Lift: waits := waits + 1; passes := passes + waits; END_ACTION
END_FUNCTION_BLOCK
FUNCTION_BLOCK Job
VAR_OUTPUT n, sum, total, steps : DINT; at_image : INT; bits : DWORD; END_VAR
VAR_INPUT fed : BYTE; END_VAR
VAR
  up : Up; down : Down; one : Counting; walk : Walk; table : ARRAY[0..9] OF INT; p : POINTER TO INT; r : REFERENCE TO Raw;
  back : Back; pb : POINTER TO BYTE; pi : POINTER TO Item; i : INT; own : Raw; text : STRING[12]; letters : POINTER TO BYTE;
END_VAR
n := n + 1;
IF n MOD 2 = 0 THEN one := up; ELSE one := down; END_IF
back.me := ADR(back);
total := total + one.Count(n) + fed + back.Squares(6, n MOD 9);
IF n = 1 THEN p := ADR(table); pb := ADR(items); pi := ADR(items); letters := ADR(text); END_IF
IF n MOD 3 = 0 THEN r REF= shared; ELSE r REF= own; END_IF
p^ := DINT_TO_INT(n MOD 1000);
p := p + SIZEOF(INT);
IF p > ADR(table[9]) THEN p := ADR(table); END_IF
r.r := DINT_TO_REAL(n) / 7.0;
pi^.raw := r;
pi^.value := pi^.value + own.r;
pi := pi + SIZEOF(Item);
IF pi > ADR(items[7]) THEN pi := ADR(items); END_IF
sum := 0;
FOR i := 0 TO 39 DO sum := sum + pb[i] * (i + 1); END_FOR
letters[n MOD 10] := TO_BYTE(65 + n MOD 26);
sum := sum + LEN(text) * 1000;
bits := shared.d XOR own.d;
walk();
steps := walk.passes;
word := WORD#16#FFFF AND DWORD_TO_WORD(bits);
low := own.b[2];
at_image := WORD_TO_INT(%QW0);
%QB5 := %MB9 XOR DINT_TO_BYTE(n);
END_FUNCTION_BLOCK
"""


class Runs:
    def __init__(self, lineshaft, folder):
        self.lineshaft, self.folder = lineshaft, folder
        (folder / "job.st").write_text(JOB, encoding="utf-8")
        (folder / "program.yaml").write_text(PROGRAM.format(scans=SCANS), encoding="utf-8")

    def run(self, every, *arguments):
        """Its trace and its last checkpoint, of which one is written each time so many scans have passed."""
        trace, kept = self.folder / "out.csv", self.folder / "kept.checkpoint"
        answer = subprocess.run([self.lineshaft, "run", "program.yaml", "--quiet", "--trace", trace, "--checkpoint", kept,
                                 "--checkpoint-every", f"{every} ms", *arguments], cwd=self.folder, capture_output=True,
                                text=True, timeout=60)
        assert answer.returncode == 0, answer.stderr
        return trace.read_bytes(), kept.read_bytes()


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    stops = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    draw = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(lineshaft, pathlib.Path(folder))
        whole = runs.run(SCANS)
        rows = whole[0].decode().splitlines()[1:]
        assert len({row.split(",", 1)[1] for row in rows}) > SCANS // 2, "its state hardly changes"
        for stop in (draw.randrange(SCANS // 2 + 1, SCANS) for _ in range(stops)):
            first, second = ([["--no-native"], []][draw.randrange(2)] for _ in range(2))
            runs.run(stop, *first)  # the last checkpoint is of that scan
            trace, kept = runs.run(SCANS, "--resume", *second)
            assert trace == whole[0], f"stopped at {stop}: another trace"
            assert kept == whole[1], f"stopped at {stop}: another checkpoint"
    print(f"resumed {stops} times: the same trace and checkpoint")


main()
