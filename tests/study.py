#!/usr/bin/env python3
"""The result files of studies: the same bytes with any number of threads, in any chunks, and after kills.

study.py LINESHAFT
"""
import csv
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = """lineshaft: 1
parameters: {speed: 10 mm/s, time: 1 s, jitter: 4 ms, every: 10 ms, top: 100 mm, seen: 0 mm}
tasks: {main: {every: $every, jitter: $jitter}}
blocks:
  axis: {type: axis, task: main, default_acceleration: 1e9 mm/s^2, default_jerk: 0 mm/s^3}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: $speed, Execute: true}
run: {for: $time}
expect:
  - {always: axis.position, at_most: $top}
"""
# 306 cases: 2 with a name, a grid of 2 x 3 with 40 draws, 60 draws, and a grid of 2 x 2 whose last case is a fault by
# the combination of its values. 'slow' takes longer than those after it.
PLAN = """lineshaft_study: 1
title: All kinds of cases
program: program.yaml
compare: {axis.position: {at_most: 50 mm}}
cases:
  - {name: first, set: {speed: 7 mm/s}, repeat: 3}
  - {name: slow, set: {time: 2000 s, speed: 0.01 mm/s}}
  - grid: {time: [1 s, 100 ms], speed: [1 mm/s, 2 cm/s, 90 mm/s]}
    random: {jitter: {log_uniform: [1 us, 5 ms]}, top: {choice: [80 mm, 100 mm]}}
    draws: 40
    seed: 3
  - random: {speed: {normal: [10 mm/s, 20 %]}, time: {uniform: [10 ms, 2000 ms]}, seen: {integer: [0 mm, 9 mm]}}
    draws: 60
    repeat: 2
  - grid: {every: [10 ms, 5 ms], jitter: [0 ms, 8 ms]}
claims:
  - {claim: ratio, formula: first / slow}
"""


class Checks:
    def __init__(self, lineshaft, folder):
        self.lineshaft, self.folder = lineshaft, folder
        (folder / "program.yaml").write_text(PROGRAM)
        (folder / "plan.yaml").write_text(PLAN)

    def run(self, *arguments, expect, **options):
        result = subprocess.run([self.lineshaft, "study", "plan.yaml", "--quiet", *arguments], cwd=self.folder,
                                capture_output=True, text=True, timeout=300, **options)
        assert result.returncode == expect, (arguments, result.returncode, result.stdout[-500:], result.stderr)
        return result

    def table(self, *arguments):
        """As it is printed, and that a quiet study prints nothing beside its file."""
        assert self.run(*arguments, expect=1).stdout == ""
        result = subprocess.run([self.lineshaft, "study", "plan.yaml", *arguments], cwd=self.folder,
                                capture_output=True, text=True, timeout=300)
        assert result.returncode == 1, (arguments, result.returncode, result.stderr)
        return result.stdout[:result.stdout.rindex("\n\n")]

    def bytes(self, name):
        return (self.folder / name).read_bytes()

    def sidecar(self, name):
        return json.loads(self.bytes(name + "-metadata.json"))


def threads(c):
    c.run("-j", "1", "-o", "one.csv", expect=1)
    c.run("-j", "2", "-o", "two.csv", expect=1)
    c.run("-j", "7", "-o", "seven.csv", expect=1)
    assert c.bytes("one.csv") == c.bytes("two.csv") == c.bytes("seven.csv")
    assert {k: v for k, v in c.sidecar("one.csv").items() if k != "url"} == \
        {k: v for k, v in c.sidecar("two.csv").items() if k != "url"}
    assert not list(c.folder.glob("*.part*"))


def contents(c):
    with open(c.folder / "one.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 306, len(rows)
    assert [int(row["case"]) for row in rows] == list(range(1, 307))
    assert rows[0]["name"] == "first" and rows[0]["speed"] == "7" and rows[0]["outcome"] == "ok"
    assert float(rows[0]["axis.position.least"]) < float(rows[0]["axis.position"]) < \
        float(rows[0]["axis.position.greatest"])
    units = {column["titles"]: column.get("unit") for column in c.sidecar("one.csv")["tableSchema"]["columns"]}
    assert units["speed"] == "mm/s" and units["time"] == "s" and units["jitter"] == "us" and units["machine_time"] == "s", units
    grid = rows[2:242]
    assert [row["speed"] for row in grid[::40]] == ["1", "20", "90"] * 2
    assert [row["jitter"] for row in grid[:40]] == [row["jitter"] for row in grid[40:80]], "draws differ in the grid"
    assert all(1 <= float(row["jitter"]) <= 5000 for row in grid) and len({row["jitter"] for row in grid}) == 40
    failed = [row for row in rows if row["outcome"] == "failed"]
    assert failed and all(float(row["axis.position.greatest"]) > 50 for row in failed)
    assert any("at most 80 mm" in row["message"] for row in failed), failed[0]
    assert all(row["axis.position"] for row in rows[:-1])
    fault = rows[-1]
    assert fault["outcome"] == "fault" and fault["axis.position"] == "" and "jitter" in fault["message"], fault
    speeds = [float(row["speed"]) for row in rows[242:302]]
    assert 9 < sum(speeds) / 60 < 11 and 1 < max(abs(s - 10) for s in speeds) < 10
    assert {row["seen"] for row in rows[242:302]} <= {str(i) for i in range(10)}


def chunks(c):
    whole = c.table("-o", "one.csv")
    for of in (1, 3, 7):
        (c.folder / f"parts_{of}").mkdir()
        for i in range(of, 0, -1):
            c.run("--chunk", f"{i}/{of}", "-o", f"parts_{of}/part_{i}.csv", "-j", str(1 + i % 2),
                  expect=1 if any_failed(c, i, of) else 0)
        merged = c.table("--merge", f"parts_{of}", "-o", "merged.csv")
        assert c.bytes("merged.csv") == c.bytes("one.csv"), of
        assert merged == whole, "the merged table differs"
    c.run("--chunk", "1/400", "-o", "empty.csv", expect=0)
    assert c.bytes("empty.csv").count(b"\n") == 1, "more chunks than cases leave some without a row"


def any_failed(c, i, of):
    rows = c.bytes("one.csv").decode().splitlines()[1:]
    n = len(rows)
    return any(",failed," in row or ",fault," in row for row in rows[n * (i - 1) // of:n * i // of])


def broken_merges(c):
    part = c.folder / "parts_3" / "part_2.csv"
    kept, sidecar = part.read_bytes(), Path(str(part) + "-metadata.json")
    part.rename(c.folder / "away")
    result = c.run("--merge", "parts_3", "-o", "m.csv", expect=2)
    assert "L0611" in result.stderr and "one is missing: 2" in result.stderr and "--chunk 2/3" in result.stderr
    part.write_bytes(kept[:-40])
    assert "L0613" in c.run("--merge", "parts_3", "-o", "m.csv", expect=2).stderr
    part.write_bytes(kept.replace(b",ok,", b",OK,", 1))
    assert "L0613" in c.run("--merge", "parts_3", "-o", "m.csv", expect=2).stderr
    part.write_bytes(kept)
    text = sidecar.read_text()
    foreign = json.loads(text)
    foreign["lineshaft:study"] = "0" * 16
    sidecar.write_text(json.dumps(foreign))
    assert "L0612" in c.run("--merge", "parts_3", "-o", "m.csv", expect=2).stderr
    sidecar.write_text(text)
    c.run("--merge", "parts_3", "-o", "m.csv", expect=1)
    program = (c.folder / "program.yaml").read_text()
    (c.folder / "program.yaml").write_text(program + "# changed\n")
    result = c.run("--merge", "parts_3", "-o", "m.csv", expect=2)
    assert result.stderr.count("L0612") == 3, result.stderr
    (c.folder / "program.yaml").write_text(program)
    (c.folder / "none").mkdir()
    sidecar = c.folder / "parts_3" / "part_1.csv-metadata.json"
    text = sidecar.read_text()
    for index, of in ((1, 0), (0, 3), (4, 3), (-1, 3), (1, 10**30), (1, 1.5), ('"1"', 3), (1, "null"), ("[]", 3)):
        sidecar.write_text(re.sub(r'"index": 1,\s*"of": 3', f'"index": {index}, "of": {of}', text))
        assert sidecar.read_text() != text
        assert "L0612" in c.run("--merge", "parts_3", "-o", "m.csv", expect=2).stderr, (index, of)
    sidecar.write_text("[" * 900000)
    assert "L0611" in c.run("--merge", "parts_3", "-o", "m.csv", expect=2).stderr
    sidecar.write_text(text)
    result = c.run("--merge", "parts_3", "-o", "parts_3/part_1.csv", expect=2)
    assert "L0509" in result.stderr, result.stderr
    assert "no chunk in" in c.run("--merge", "none", "-o", "none.csv", expect=2).stderr
    assert not list(c.folder.glob("none.csv*"))


def replayed_files(c):
    """A chunk that replayed other bytes is of another study."""
    (c.folder / "replay.yaml").write_text(PROGRAM.replace("$speed,", "inputs.v,").replace(
        "run:", "inputs: {v: 0 mm/s}\nstimulus: [{file: $file, set: {inputs.v: v}}]\nrun:").replace(
        "{speed: 10 mm/s,", "{speed: 10 mm/s, file: a.csv,"))
    (c.folder / "replay_plan.yaml").write_text(
        "lineshaft_study: 1\nprogram: replay.yaml\ncompare: [axis.position]\n"
        "cases: [{set: {file: a.csv}}, {set: {file: b.csv}}]\n")
    for name, speed in (("a", 10), ("b", 20)):
        (c.folder / f"{name}.csv").write_text(f"time,v [mm/s]\n0,{speed}\n")

    def study(*arguments, expect):
        command = [c.lineshaft, "study", "replay_plan.yaml", "--quiet", *arguments]
        result = subprocess.run(command, cwd=c.folder, capture_output=True, text=True, timeout=300)
        assert result.returncode == expect, (arguments, result.stdout, result.stderr)
        return result

    (c.folder / "replay_parts").mkdir()
    for i in (1, 2):
        study("--chunk", f"{i}/2", "-o", f"replay_parts/part_{i}.csv", expect=0)
    study("--merge", "replay_parts", "-o", "replay.csv", expect=0)
    a, b = (float(row["axis.position"]) for row in csv.DictReader((c.folder / "replay.csv").open()))
    assert abs(b - 2 * a) < 1e-6 and a > 0, (a, b)
    (c.folder / "b.csv").write_text("time,v [mm/s]\n0,30\n")
    assert "L0612" in study("--merge", "replay_parts", "-o", "replay.csv", expect=2).stderr


TRACED = """lineshaft: 1
parameters: {speed: 10 mm/s, jitter: 0 ms}
tasks: {main: {every: 2 ms, jitter: $jitter}}
blocks:
  axis:
    type: path_move
    task: main
    execute: true
    length: 1e6 mm
    start_velocity: $speed
    velocity_limit: $speed
    end_velocity: $speed
run: {for: 1 s}
trace: {task: main, signals: [axis.position]}
"""
TRACED_PLAN = """lineshaft_study: 1
program: traced.yaml
compare: {axis.position: {at_most: 50 mm}}
cases:
  - {name: slow, set: {speed: 1 mm/s}}
  - grid: {speed: [10 mm/s, 90 mm/s]}
    repeat: 2
    set: {jitter: 1 ms}
"""


def traces(c):
    """A trace is named by its case, and is what a run of its own records; of failed cases only those."""
    (c.folder / "traced.yaml").write_text(TRACED)
    (c.folder / "traced_plan.yaml").write_text(TRACED_PLAN)

    def call(*arguments, expect, **options):
        result = subprocess.run([c.lineshaft, *arguments], cwd=c.folder, capture_output=True, text=True, timeout=300, **options)
        assert result.returncode == expect, (arguments, result.stdout, result.stderr)
        return result

    def files(folder):
        return sorted(path.name for path in (c.folder / folder).glob("*.csv") if ".events." not in path.name)

    call("study", "traced_plan.yaml", "--quiet", "--traces", "all", "-o", "with.csv", "-j", "2", expect=1)
    repeated = [f"{case}_jitter=1_ms_speed={speed}_mm_s.{repeat}.csv" for case, speed in ((2, 10), (3, 90)) for repeat in (1, 2)]
    assert files("all") == repeated + ["slow.csv"], files("all")
    call("run", "traced.yaml", "--quiet", "--set", "speed=1 mm/s", "--trace", "slow.csv", expect=0)
    assert c.bytes("all/slow.csv") == c.bytes("slow.csv")
    first, second = c.bytes(f"all/{repeated[0]}"), c.bytes(f"all/{repeated[1]}")
    assert first != second, "repeats have one seed"
    answer = call("study", "traced_plan.yaml", "--json", "--traces", "failed", "--traces-of", "failed", expect=1)
    assert files("failed") == repeated[2:], files("failed")
    assert c.bytes(f"failed/{repeated[2]}") == c.bytes(f"all/{repeated[2]}")
    rows = json.loads(answer.stdout)["rows"]
    assert [row.get("traces") for row in rows] == [None, None, [f"failed/{name}" for name in repeated[2:]]], rows
    call("study", "traced_plan.yaml", "--quiet", "-o", "without.csv", expect=1)
    assert c.bytes("with.csv") == c.bytes("without.csv")
    study = ("study", "traced_plan.yaml", "--quiet", "--traces", "refused", "-o", "refused.csv")
    assert "cannot write 'refused/" in call(*study, expect=3, preexec_fn=lambda: limit_files(4096)).stderr
    call(*study, "--resume", expect=1)
    assert c.bytes("refused.csv") == c.bytes("without.csv"), "what the disk refused is no result"
    assert files("refused") == files("all") and not list((c.folder / "refused").glob("*.part*"))
    assert "L0503" in call("study", "plan.yaml", "--traces", "none", expect=2).stderr
    (c.folder / "file").write_text("")
    assert "cannot make 'file/x'" in call("study", "traced_plan.yaml", "--traces", "file/x", expect=2).stderr


def limit_files(size):
    """As on a full disk: no file grows beyond it."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def size(path):
    """0 when it is not there, which may be so from one moment to the next."""
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return 0


def interrupted(c, kill):
    """Runs and resumes the study, killing it each time its file has grown; returns how often it was interrupted."""
    part = c.folder / "killed.csv.part"
    rounds = 0
    while True:
        process = subprocess.Popen([c.lineshaft, "study", "plan.yaml", "--quiet", "--resume", "-j", "2", "-o",
                                    "killed.csv"], cwd=c.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        before = size(part)
        while process.poll() is None and size(part) <= before + 2000:
            pass
        process.send_signal(kill)
        code = process.wait()
        if code == 1:  # to its end: the kill came too late
            return rounds
        assert code in (-kill, 130), code
        rounds += 1


def stops_at_once(c):
    """A study that is told to stop while its workers read the program keeps nothing of what they could not read."""
    for delay in range(200):
        process = subprocess.Popen([c.lineshaft, "study", "plan.yaml", "--quiet", "--resume", "-j", "8", "-o",
                                    "stopped.csv"], cwd=c.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        time.sleep(delay % 50 * 3e-4)
        process.send_signal(signal.SIGINT)
        assert process.wait() in (1, -signal.SIGINT, 130)
    c.run("--resume", "-o", "stopped.csv", expect=1)
    assert c.bytes("stopped.csv") == c.bytes("one.csv")


def kills(c):
    part = c.folder / "killed.csv.part"
    for kill in (signal.SIGKILL, signal.SIGINT, signal.SIGTERM):
        rounds = 0
        for _ in range(100):  # a study takes a few milliseconds on a quick machine, and may end first
            rounds += interrupted(c, kill)
            assert c.bytes("killed.csv") == c.bytes("one.csv"), kill
            if rounds >= 40:
                break
            (c.folder / "killed.csv").unlink()
        assert rounds >= 1, "never interrupted"
        assert not part.exists()
        assert c.table("--resume", "-o", "killed.csv") == c.table("-o", "one.csv")
        (c.folder / "killed.csv").unlink()


def torn_rows(c):
    """A row that was cut off in writing is computed again."""
    c.run("-o", "torn.csv", expect=1)
    whole = c.bytes("torn.csv")
    metadata = c.sidecar("torn.csv")
    for name in ("torn.csv", "torn.csv-metadata.json"):
        (c.folder / name).unlink()
    (c.folder / "torn.csv.part").write_bytes(whole[:len(whole) // 2])
    (c.folder / "torn.csv.part-metadata.json").write_text(json.dumps(metadata))
    c.run("--resume", "-o", "torn.csv", expect=1)
    assert c.bytes("torn.csv") == whole
    metadata["lineshaft:study"] = "f" * 16
    (c.folder / "torn.csv").unlink()
    (c.folder / "torn.csv.part").write_bytes(whole[:1000])
    (c.folder / "torn.csv.part-metadata.json").write_text(json.dumps(metadata))
    assert "another study" in c.run("--resume", "-o", "torn.csv", expect=3).stderr
    assert c.bytes("torn.csv.part") == whole[:1000], "a foreign file was touched"


def full_disks(c):
    assert "No space left" in c.run("-o", "/dev/full", expect=3).stderr
    result = c.run("-o", "full.csv", "-j", "2", expect=3, preexec_fn=lambda: limit_files(8192))
    assert "cannot write 'full.csv'" in result.stderr and not (c.folder / "full.csv").exists()
    c.run("-o", "full.csv", "--resume", expect=1)
    assert c.bytes("full.csv") == c.bytes("one.csv")


def command_lines(c):
    for arguments in (["--chunk", "0/3"], ["--chunk", "4/3"], ["--chunk", "1/3x"]):
        assert "is not a chunk" in c.run(*arguments, "-o", "x.csv", expect=2).stderr
    for arguments in (["--resume"], ["--chunk", "1/3"], ["--merge", "."]):
        assert "L0614" in c.run(*arguments, expect=2).stderr
    c.run("--merge", ".", "--chunk", "1/2", "-o", "x.csv", expect=2)
    assert "cannot read 'nowhere'" in c.run("--merge", "nowhere", "-o", "x.csv", expect=2).stderr


def main():
    with tempfile.TemporaryDirectory() as folder:
        c = Checks(os.path.abspath(sys.argv[1]), Path(folder))
        for check in (threads, contents, traces, chunks, broken_merges, replayed_files, stops_at_once, kills, torn_rows,
                      full_disks, command_lines):
            check(c)
            print("ok ", check.__name__, flush=True)


if __name__ == "__main__":
    main()
