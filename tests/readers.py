#!/usr/bin/python3
"""Large and malformed files of each kind that a command reads: it takes at most 20 times the file and 64 MB, ends with
an exit code and a message of its own, and obeys ^C at any moment within a second of processor time.

usage: readers.py LINESHAFT [MEGABYTES [INTERRUPTS]]
    MEGABYTES    of each file; default: 2
    INTERRUPTS   runs of each file that are interrupted at random moments; default: 1
LINESHAFT_MEMORY_LIMITS=off: for a build with sanitizers or counters, which need more
"""

import itertools
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

MOST_SECONDS = 60  # of processor time, where nobody interrupts
MOST_SECONDS_AFTER = 1
TICK = 1 / os.sysconf("SC_CLK_TCK")
PROGRAM = """lineshaft: 1
parameters: {w: 1.5}
tasks: {main: {every: 1 ms}}
inputs: {w: 1, x: $w}
blocks:
  counter: {type: ctu, task: main, cu: false, pv: inputs.w}
  sum: {type: add, task: main, in1: inputs.x, in2: 0.5}
retain: [inputs.w]
run: {for: 5 ms}
trace: {task: main, signals: [sum.out]}
"""
REPLAYED = PROGRAM + "stimulus:\n  - {file: FILE, set: {inputs.x: a}}\n"
CAM = """lineshaft: 1
tasks: {main: {every: 1 ms}}
blocks: {cam: {type: cam_table, task: main, points: FILE}}
run: {for: 5 ms}
"""
SOURCES = "lineshaft: 1\ntasks: {main: {every: 1 ms}}\nsources: [FILE]\nblocks: {}\nrun: {for: 5 ms}\n"
STUDY = "lineshaft_study: 1\nprogram: program.yaml\ncompare: {sum.out: {at_least: 0}}\ncases: [grid: {w: [1, 2]}]\n"
FIT = """lineshaft_fit: 1
program: program.yaml
parameters: {w: {from: 0, to: 9}}
cases: [{trace: {file: FILE}, compare: {sum.out: {column: a, uncertainty: 1}}}]
"""
RECORDING = "lineshaft_recording: 1\nprogram: program.yaml\nmeaning: '0123456789abcdef'\nentries:\n"


def repeated(text, size):
    """A text of `size` bytes in pieces, so that this process stays small: its memory counts for the one that it begins."""
    piece = text * max(1, 65536 // len(text))
    return itertools.repeat(piece, max(1, size // len(piece)))


def columns(size, name):
    """So many names of columns as fit."""
    count, written = 0, 0
    while written < size:
        piece = ",".join(name(count + i) for i in range(4096)) + ","
        count, written = count + 4096, written + len(piece)
        yield piece


def word(number):
    """The shortest name that is no number."""
    letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
    text = letters[number % 52]
    while number >= 52:
        number = number // 52 - 1
        text = letters[number % 52] + text
    return text + "_"  # not `inf`, not `nan`


def tables(size):
    """CSV files as pieces of text, by name; the last piece ends them."""
    head, row = "time [s],a,b\n", "0.001,1.5,2\n"
    yield "rows", [head, *repeated(row, size)]
    yield "rising", ["time [s],master,a,b,slave\n", *(f"{number},1,2,3,4\n" for number in range(size // 16))]
    yield "short", ["a\n", *repeated("1\n", size)]
    yield "returns", [head.replace("\n", "\r"), *repeated(row.replace("\n", "\r"), size)]
    yield "both_ends", [head.replace("\n", "\r\n"), *repeated(row.replace("\n", "\r\n"), size)]
    yield "mistakes", [head, *repeated("x,y,z,u\n", size)]
    yield "long_cell", [head, *repeated("1", size)]
    yield "wide", [*columns(min(size, 1 << 20) - 70_000, word), "end\n"]
    yield "wide_rows", [*columns(min(size, 1 << 19), word), "end\n", *repeated("," * 65535 + "\n", size)]
    yield "wider", [*columns(min(size, 1 << 20) + 70_000, word), "end\n"]
    yield "blank", [head, *repeated("\n", size)]
    yield "blank_rows", ["a\n1\n", *repeated("\n", size), "1\n"]
    yield "empty_cells", [head, *repeated(",,\n", size)]
    yield "quotes", [head, *repeated('"', size)]
    yield "quoted", [head, *repeated('"0.001","1.5","2"\n', size)]
    yield "zeros", repeated("\0", size)
    yield "no_ends", repeated("0.001,1.5,2,", size)


def table_commands():
    """What reads a table as FILE, the plan beside it included."""
    yield "verify", None, ["verify", "FILE"]
    yield "diff", None, ["diff", "small.csv", "FILE"]
    yield "both", None, ["diff", "FILE", "FILE"]
    yield "contour", None, ["contour", "--quiet", "--command", "a,b", "--actual", "a,b", "FILE"]
    yield "report", None, ["report", "FILE", "-o", "out.html"]
    yield "plan", None, ["plan", "FILE", "-o", "out.csv"]
    yield "replay", REPLAYED, ["run", "user.yaml"]
    yield "cam", CAM, ["run", "user.yaml"]
    yield "fit", FIT, ["fit", "--quiet", "user.yaml"]
    if shutil.which("gnuplot"):
        yield "plot", None, ["plot", "FILE", "-o", "out.svg"]


def plans(size):
    head = "Vs,Ve,Vm,A,J,L\n"
    yield "rows", [head, *repeated("0,0,10,100,1000,5\n", size)]
    yield "mistakes", [head, *repeated("0,0,10,x\n", size)]
    yield "returns", [head.replace("\n", "\r"), *repeated("0,0,10,100,1000,5\r", size)]


def recordings(size):
    entry = "- {at: 0.001 s, set: {inputs.w: 7}}\n"
    yield "entries", [RECORDING, *repeated(entry, size)]
    yield "mistakes", [RECORDING, *repeated(entry.replace("inputs.w", "inputs.no"), size)]
    yield "line", [RECORDING, "- {at: 0.001 s, set: {inputs.w: ", *repeated("7", size), "}}\n"]
    yield "nested", [RECORDING, "- ", *repeated("[", size)]
    yield "returns", [RECORDING.replace("\n", "\r"), *repeated(entry.replace("\n", "\r"), size)]
    yield "no_ends", [RECORDING, *repeated("- {at: 0.001 s} ", size)]


def documents(size):
    head = "lineshaft: 1\n"
    yield "comment", [head, "# ", *repeated("x", size)]
    yield "equal_keys", [head, "blocks:\n", *repeated("  a: {type: ton}\n", size)]
    yield "nested", [head, "blocks: ", *repeated("{a: ", size)]
    yield "sequence", [head, "blocks: [", *repeated("1,", size)]
    yield "deep_lines", [head, "blocks:\n", *(" " * (depth % 2000) + "a:\n" for depth in range(size // 1000))]
    yield "text", [head, 'title: "', *repeated("x", size)]
    yield "unknown_keys", [head, *(f"k{number}: 1\n" for number in range(size // 12))]
    yield "anchors", [head, *repeated("a: &a [*a, *a]\n", size)]
    yield "returns", [head.replace("\n", "\r"), *repeated("k: 1\r", size)]
    yield "zeros", repeated("\0", size)


def sources(size):
    head = "FUNCTION_BLOCK fb\nVAR q : INT; END_VAR\n"
    yield "statements", [head, *repeated("q := q + 1;\n", size), "END_FUNCTION_BLOCK\n"]
    yield "nested", [head, "q := ", *repeated("(", size)]
    yield "nested_if", [head, *repeated("IF q > 0 THEN ", size)]
    yield "mistakes", [head, *repeated("p := 1;\n", size), "END_FUNCTION_BLOCK\n"]
    yield "errors", [head, *repeated(") ", size)]
    yield "names", [head, *repeated("x", size)]
    yield "comment", [head, "(*", *repeated("x", size)]
    yield "text", [head, "q := '", *repeated("x", size)]
    yield "variables", ["FUNCTION_BLOCK fb\nVAR\n", *(f"v{number} : INT;\n" for number in range(size // 13)), "END_VAR\n"]
    yield "returns", [head.replace("\n", "\r"), *repeated("q := q + 1;\r", size)]


def kept_states(size):
    yield "entries", ["lineshaft_retain: 1\nvalues:\n", *repeated("  a: 1\n", size)]
    yield "nested", ["{", *repeated('"a": {', size)]
    yield "text", ['{"lineshaft_retain": 1, "values": {"inputs.w": "', *repeated("7", size), '"}}']
    yield "sequence", ['{"lineshaft_retain": 1, "values": [', *repeated("1,", size), "1]}"]
    yield "keys", ['{"lineshaft_retain": 1, "values": {', *keys(size), '"a": 1}}']
    yield "zeros", repeated("\0", size)


def keys(size):
    """So many keys of an object as fit."""
    return (",".join(f'"{number + i}":0' for i in range(1000)) + "," for number in range(0, size // 9, 1000))


def sidecars(size):
    yield "keys", ['{"tableSchema": {"columns": [{', *keys(size), '"titles": "a"}]}}']
    yield "columns", ['{"tableSchema": {"columns": [', *repeated('{"titles": "a"},', size), '{"titles": "a"}]}}']
    yield "values", ['{"tableSchema": {"columns": [{"titles": "a", "values": [', *repeated('"v",', size), '"v"]}]}}']
    yield "nested", repeated("[", size)
    yield "nested_maps", repeated('{"a":', size)
    yield "text", ['{"dc:title": "', *repeated("x", size), '"}']
    yield "numbers", ["[", *repeated("1,", size), "1]"]
    yield "zeros", repeated("\0", size)


def checkpoints(size, good):
    head = good[:good.index(b"\n") + 1].decode("ascii")
    yield "zeros", [head, *repeated("\0", size)]
    yield "ones", [head, *repeated("\x01", size)]
    yield "head", repeated("x", size)
    yield "lines", repeated("lineshaft\n", size)


def trials(folder, size):
    """Name, the file under which the pieces come, the pieces, the plan beside it, the command."""
    for command, user, arguments in table_commands():
        for name, pieces in tables(size):
            yield f"{command}_{name}", "file.csv", pieces, user, arguments
    for name, pieces in plans(size):
        yield f"plan_{name}", "file.csv", pieces, None, ["plan", "FILE", "-o", "out.csv"]
    for name, pieces in recordings(size):
        yield f"recording_{name}", "file.yaml", pieces, None, ["run", "program.yaml", "--recording", "FILE"]
    for name, pieces in documents(size):
        yield f"yaml_{name}", "file.yaml", pieces, None, ["check", "FILE"]
    for ending in ("st", "scl"):
        for name, pieces in sources(size):
            yield f"{ending}_{name}", f"file.{ending}", pieces, SOURCES, ["check", "user.yaml"]
    for name, pieces in kept_states(size):
        yield f"retain_{name}", "file.ret", pieces, None, ["run", "program.yaml", "--retain-file", "FILE"]
    for name, pieces in sidecars(size):
        yield f"sidecar_{name}", "small.csv-metadata.json", pieces, None, ["verify", "small.csv"]
    merge = ["study", "study.yaml", "--merge", "parts", "-o", "out.csv"]
    for name, pieces in sidecars(size):
        yield f"part_{name}", "parts/part_1.csv-metadata.json", pieces, None, merge
    for name, pieces in tables(size):
        yield f"chunk_{name}", "parts/part_1.csv", pieces, None, merge
    for name, pieces in checkpoints(size, (folder / "good.checkpoint").read_bytes()):
        yield f"checkpoint_{name}", "file.checkpoint", pieces, None, ["run", "program.yaml", "--resume", "--checkpoint",
                                                                     "FILE"]


def prepare(lineshaft, folder):
    (folder / "program.yaml").write_text(PROGRAM)
    (folder / "study.yaml").write_text(STUDY)
    (folder / "small.csv").write_text("time [s],a,b\n0,1,2\n")
    (folder / "parts").mkdir()
    for arguments in (["run", "program.yaml", "--quiet", "--checkpoint", "good.checkpoint", "--checkpoint-every", "2 ms"],
                      ["study", "study.yaml", "--quiet", "--chunk", "1/1", "-o", "parts/part_1.csv"]):
        subprocess.run([lineshaft, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def started(lineshaft, arguments, folder, said):
    return subprocess.Popen([lineshaft, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=said,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS,) * 2))


def awaited(process):
    """Exit code, greatest memory [bytes], processor time [s]."""
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_maxrss * 1024, usage.ru_utime + usage.ru_stime


def time_of(process):
    """Of the processor, so far [s]."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) * TICK


def interrupted(lineshaft, arguments, folder, after):
    """What is wrong when ^C comes after so many seconds; the processor time from there on."""
    process = started(lineshaft, arguments, folder, subprocess.DEVNULL)
    time.sleep(after)
    before = time_of(process)  # one that has ended is there until it is awaited
    os.kill(process.pid, signal.SIGINT)
    code, _, seconds = awaited(process)
    wrong = [] if code in (0, 1, 2, 3, 130) or (code == -signal.SIGINT and before < 0.05) else [f"^C: exit code {code}"]
    rest = max(0, seconds - before - TICK)
    return wrong + ([f"^C: {rest:.2f} s"] if rest > MOST_SECONDS_AFTER else []), rest


class Harness:
    def __init__(self, lineshaft, folder, interrupts):
        self.lineshaft, self.folder, self.interrupts = lineshaft, folder, interrupts
        self.is_limited = os.environ.get("LINESHAFT_MEMORY_LIMITS") != "off"
        self.chance = random.Random(41)
        self.count = self.wrong = 0
        self.most = self.longest = 0

    def attempt(self, name, file, pieces, user, arguments):
        path = self.folder / file
        kept = path.read_bytes() if path.exists() else None
        with open(path, "w", encoding="utf-8", newline="") as out:
            out.writelines(pieces)
        if user:
            (self.folder / "user.yaml").write_text(user.replace("FILE", file))
        arguments = [file if argument == "FILE" else argument for argument in arguments]
        with open(self.folder / "said", "w+b") as said:
            code, taken, seconds = awaited(started(self.lineshaft, arguments, self.folder, said))
            said.seek(0)
            answer = said.read(1 << 20)
        wrong = [f"exit code {code}"] if code not in (0, 1, 2, 3) else []
        wrong += ["no message"] if code == 2 and b"error" not in answer else []
        size, readers = path.stat().st_size, max(1, arguments.count(file))
        allowed = readers * (20 * size + (64 << 20))
        if self.is_limited and taken > allowed:
            wrong.append(f"more than {allowed / 2**20:.0f} MB")
        rest = 0
        for _ in range(self.interrupts):
            told, after = interrupted(self.lineshaft, arguments, self.folder, self.chance.random() * (seconds + 0.01))
            wrong, rest = wrong + told, max(rest, after)
        path.unlink() if kept is None else path.write_bytes(kept)
        self.count, self.wrong = self.count + 1, self.wrong + len(wrong)
        self.most, self.longest = max(self.most, taken / allowed), max(self.longest, rest)
        if wrong or os.environ.get("LINESHAFT_FIGURES"):
            print(f"{name}: {size / 2**20:.1f} MB read in {taken / 2**20:.1f} MB, {seconds:.2f} s, exit {code}, "
                  f"{rest:.2f} s after ^C", *wrong, sep="; ", flush=True)


def main():
    lineshaft = os.path.abspath(sys.argv[1])
    size = int(float(sys.argv[2] if len(sys.argv) > 2 else 2) * (1 << 20))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(lineshaft, folder)
        harness = Harness(lineshaft, folder, int(sys.argv[3]) if len(sys.argv) > 3 else 1)
        floor = awaited(started(lineshaft, ["verify", os.devnull], folder, subprocess.DEVNULL))[1]
        for trial in trials(folder, size):
            harness.attempt(*trial)
    print(f"{harness.count} files of {size / 2**20:.1f} MB, an empty one read in {floor / 2**20:.1f} MB: at most "
          f"{harness.most * 100:.0f} % of what is allowed, {harness.longest:.2f} s after ^C; {harness.wrong} wrong")
    return 1 if harness.wrong or not harness.count else 0


if __name__ == "__main__":
    sys.exit(main())
