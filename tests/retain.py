#!/usr/bin/python3
"""Kills runs that write retained values, at random moments: the file is always whole, the old or the new one.
Then flips bits of the file: each is told, and the copy before it is taken where there is one.
An instance in VAR RETAIN goes on with its values, whatever its initial values are. `--restart` says what a run begins with.

usage: retain.py LINESHAFT [KILLS]
"""

import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

PROGRAM = """\
lineshaft: 1
parameters: {count: 0}
tasks: {main: {every: 1 ms}}
blocks:
  shaft: {type: axis, task: main}
  feed: {type: MC_MoveVelocity, task: main, Axis: shaft, Velocity: 1 mm/s, Execute: true}
inputs: {a: $count, b: $count}
retain: [inputs.a, inputs.b, shaft]
run: {for: 2 s}
"""

COUNTER = """\
FUNCTION_BLOCK Counter
VAR first : INT := Base(); n : INT := first + 1; list : ARRAY[1..2] OF INT := [Base(), Base()]; END_VAR
VAR NON_RETAIN fresh : INT := Base(); END_VAR
n := n + 1; list[2] := list[2] + 1; fresh := fresh + 1;
END_FUNCTION_BLOCK
FUNCTION Base : INT
Base := 10;
END_FUNCTION
PROGRAM Main
VAR RETAIN kept : Counter; END_VAR
VAR plain : Counter; END_VAR
kept(); plain();
END_PROGRAM
"""
COUNTED = """\
lineshaft: 1
sources: [counter.st]
tasks: {main: {every: 10 ms}}
blocks: {m: {type: Main, task: main}}
run: {for: 10 ms}
"""


def seconds(start):
    begin = time.monotonic()
    assert start(0).wait() == 0
    return time.monotonic() - begin


def flips(lineshaft, program, kept, chance):
    """Whatever bit it is."""
    copy = pathlib.Path(f"{kept}.bak")
    command = [lineshaft, "run", program, "--quiet", "--set", "count=1", "--retain-file", kept]
    for _ in range(2):
        subprocess.run(command, check=True)
    whole, before = kept.read_bytes(), copy.read_bytes()
    for _ in range(40):
        place, bit = chance.randrange(len(whole)), chance.randrange(8)
        flipped = whole[:place] + bytes([whole[place] ^ 1 << bit]) + whole[place + 1:]
        for has_copy in (False, True):
            kept.write_bytes(flipped)
            copy.write_bytes(before) if has_copy else copy.unlink()
            run = subprocess.run(command, capture_output=True, text=True)
            told = "is damaged: the copy before it" in run.stderr if has_copy else "L0507" in run.stderr
            assert run.returncode == (0 if has_copy else 2) and told, (place, bit, has_copy, run)
    print("40 flipped bits were told")


def begins_once(lineshaft, folder):
    """What an instance in VAR RETAIN begins with is not reckoned anew where its values are retained."""
    (folder / "counter.st").write_text(COUNTER, encoding="utf-8")
    program, kept = folder / "counter.yaml", folder / "counter.retain"
    program.write_text(COUNTED, encoding="utf-8")
    for begun in range(3):
        subprocess.run([lineshaft, "run", program, "--quiet", "--retain-file", kept], check=True)
        values = json.loads(kept.read_text(encoding="utf-8"))["values"]
        scans = 2 * (begun + 1)
        assert values["m.kept.n"] == 11 + scans and values["m.kept.list[2]"] == 10 + scans, (begun, values)
        assert values["m.kept.first"] == 10 and not any("plain" in name or "fresh" in name for name in values), values
    made = subprocess.run([lineshaft, "new", folder / "around", "--from", folder / "counter.st"],
                          capture_output=True, text=True)
    around = (folder / "around.yaml").read_text(encoding="utf-8")
    assert "m.kept.n begun" in values and "begun" not in around, (made, values, around)
    print("an instance went on with what was retained")


RESTARTED = """\
lineshaft: 1
sources: [restarted.st]
tasks: {main: {every: 10 ms}}
blocks: {m: {type: Restarted, task: main}}
run: {for: 40 ms}
"""
PARTS = """\
PROGRAM Restarted
VAR RETAIN kept : INT; END_VAR
VAR plain : INT; END_VAR
kept := kept + 1; plain := plain + 1;
END_PROGRAM
"""


def restarts(lineshaft, folder):
    """Cold begins anew, warm with what is retained, hot with all of the checkpoint, and is where that was."""
    (folder / "restarted.st").write_text(PARTS, encoding="utf-8")
    (folder / "restarted.yaml").write_text(RESTARTED, encoding="utf-8")
    (folder / "longer.yaml").write_text(RESTARTED.replace("40 ms", "70 ms"), encoding="utf-8")

    def values(*arguments, program="restarted.yaml"):
        answer = subprocess.run([lineshaft, "run", program, "--json", *arguments], cwd=folder, check=True,
                                capture_output=True, text=True)
        found = json.loads(answer.stdout)
        return found["signals"]["m.kept"], found["signals"]["m.plain"], found["scans"]["main"]

    kept = ["--retain-file", "restarted.retain"]
    assert values(*kept) == (5, 5, 5)
    assert values(*kept) == (10, 5, 5), "warm is what a run is that is told nothing"
    assert values(*kept, "--restart", "warm") == (15, 5, 5)
    assert values(*kept, "--restart", "cold") == (5, 5, 5)
    assert values(*kept) == (10, 5, 5), "what a cold run kept"
    assert values("--restart", "warm") == (5, 5, 5), "without a file nothing is retained"
    checkpoint = ["--checkpoint", "restarted.checkpoint"]
    values("--checkpoint-every", "20 ms", *checkpoint)
    for how in (["--restart", "hot"], ["--resume"]):
        assert values(*how, *checkpoint) == (5, 5, 5), how
    for how, code, says in (("--restart=lukewarm", 2, "'lukewarm' is none of cold, hot, warm"), ("--restart=hot", 2, "nowhere")):
        answer = subprocess.run([lineshaft, "run", "restarted.yaml", how, "--checkpoint", "nowhere"], cwd=folder,
                                capture_output=True, text=True)
        assert answer.returncode == code and says in answer.stderr, answer
    print("each --restart began with what is its own")


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    chance = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        begins_once(lineshaft, pathlib.Path(folder))
        restarts(lineshaft, pathlib.Path(folder))
        program = pathlib.Path(folder, "program.yaml")
        program.write_text(PROGRAM, encoding="utf-8")
        kept = pathlib.Path(folder, "values.retain")

        def start(count):
            command = [lineshaft, "run", program, "--quiet", "--restart", "cold", "--retain-file", kept]
            return subprocess.Popen(command + ["--set", f"count={count}"], stdout=subprocess.DEVNULL,
                                    stderr=subprocess.DEVNULL)

        usual = min(seconds(start) for _ in range(5))
        old, killed, renewed, count = 0, 0, 0, 0
        while killed < kills:
            count += 1
            assert count < 50 * kills, "the runs end before they can be killed"
            run = start(count)
            time.sleep(chance.uniform(0.5, 1.1) * usual)
            run.kill()
            killed += run.wait() != 0
            values = json.loads(kept.read_text(encoding="utf-8"))["values"]
            found = values["inputs.a"]
            if values["inputs.b"] != found or found not in (old, count):
                print(f"kill {count}: the file has {values}, before it was {old}")
                return 1
            renewed += found == count
            old = found
        flips(lineshaft, program, kept, chance)
    print(f"{killed} of {count} runs killed, {renewed} runs had renewed the file, each left a whole one")
    return 0


if __name__ == "__main__":
    sys.exit(main())
