#!/usr/bin/python3
"""Disks that are full, folders that take nothing, limits, signals, kills: each ends with the reason, the right exit
code, and no file under the final name that is not whole.

usage: writing.py LINESHAFT [KILLS]
LINESHAFT_MEMORY_LIMITS=off: for a build with sanitizers or counters, which need more
"""

import json
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
import zlib

from built import has_pages

PROGRAM = """lineshaft: 1
title: An axis and pulses
parameters: {time: 20 s, speed: 10 mm/s}
tasks: {main: {every: 1 ms}}
inputs: {go: false}
stimulus: [{at: 1 ms, set: {inputs.go: true}}]
blocks:
  axis: {type: axis, task: main}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: $speed, Execute: true}
  x: {type: pto, task: main, start_rate: 1 kHz, count: 1000000, execute: inputs.go}
run: {for: $time}
trace: {task: main, signals: [axis.position, axis.velocity]}
"""
FOREVER = ["--set", "time=100000 s"]
MARKED = """lineshaft: 1
title: Each run leaves its mark in all of its files
parameters: {mark: 1}
tasks: {main: {every: 1 ms}}
inputs: {mark: 0, go: false}
stimulus: [{at: 1 ms, set: {inputs.go: true}}]
blocks:
  x: {type: pto, task: main, start_rate: 1 kHz, count: $mark, execute: inputs.go}
run: {for: 20 ms}
trace: {task: main, signals: [inputs.mark]}
traces:
  more:
    task: main
    signals: [inputs.mark]
    trigger: {signal: inputs.go, edge: rising}
    samples: 5
"""


class Checks:
    def __init__(self, lineshaft, folder, kills):
        self.folder, self.kills = folder, kills
        # Where every user reaches it, by a name without the folders above.
        os.umask(0o022)
        shutil.copy(lineshaft, folder / "lineshaft")
        (folder / "lineshaft").chmod(0o755)
        self.lineshaft = "./lineshaft"
        (folder / "program.yaml").write_text(PROGRAM)

    def run(self, *arguments, expect, says="", **options):
        options = {"stdout": subprocess.PIPE, **options}
        result = subprocess.run([self.lineshaft, *arguments], cwd=self.folder, stderr=subprocess.PIPE, text=True,
                                timeout=60, **options)
        what = (arguments, result.returncode, result.stdout, result.stderr)
        assert result.returncode == expect, what
        assert says in result.stderr, what
        assert bool(says) == ("error" in result.stderr), what
        return result

    def start(self, *arguments):
        return subprocess.Popen([self.lineshaft, "run", "program.yaml", *arguments], cwd=self.folder,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def path(self, name):
        return self.folder / name

    def sidecar(self, name):
        return json.loads(self.path(name + "-metadata.json").read_text())

    def check_whole(self, name):
        text = self.path(name).read_bytes()
        metadata = self.sidecar(name)
        assert text.endswith(b"\n") and text.count(b"\n") == metadata["lineshaft:rows"] + 1
        assert f"{zlib.crc32(text):08x}" == metadata["lineshaft:crc32"]


def limit(kind, size):
    return lambda: resource.setrlimit(kind, (size, size))


def check_stopped_early(result):
    """The machine would have run for 100,000 s."""
    assert "the run stopped at " in result.stderr, result.stderr
    assert float(result.stderr.split("the run stopped at ")[1].split(" s")[0]) < 10000, result.stderr


def full_disks(c):
    for option in ("--trace", "--pulses"):
        check_stopped_early(c.run("run", "program.yaml", *FOREVER, option, "/dev/full", expect=3,
                                  says="cannot write '/dev/full': No space left on device"))
        name = f"limited{option}.csv"
        check_stopped_early(c.run("run", "program.yaml", *FOREVER, option, name, expect=3,
                                  says=f"cannot write '{name}': File too large",
                                  preexec_fn=limit(resource.RLIMIT_FSIZE, 200000)))
        assert not c.path(name).exists() and not c.path(name + "-metadata.json").exists()


def small_file_systems(c):
    small = c.path("small")
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "none", small], capture_output=True).returncode != 0:
        print("skipped: no file system can be mounted here")
        return
    try:
        c.run("run", "program.yaml", "--set", "time=1 s", "--trace", "small/t.csv", expect=0)
        c.check_whole("small/t.csv")
        before = c.path("small/t.csv").read_bytes()
        check_stopped_early(c.run("run", "program.yaml", *FOREVER, "--trace", "small/t.csv", expect=3,
                                  says="cannot write 'small/t.csv': No space left on device"))
        assert c.path("small/t.csv").read_bytes() == before
        c.check_whole("small/t.csv")
        formats_all_or_nothing(c, small)
    finally:
        subprocess.run(["umount", small], check=True)


def formats_all_or_nothing(c, small):
    """On a full disk `format` leaves a source as it was, and `new` leaves nothing."""
    for path in small.iterdir():
        path.unlink()
    source = small / "odd.st"
    source.write_text("PROGRAM Main\nVAR x:INT; END_VAR\n" + "x:=x+1;\n" * 500 + "END_PROGRAM\n")
    before = source.read_bytes()
    free = os.statvfs(small)
    (small / "rest").write_bytes(bytes(free.f_bavail * free.f_frsize))
    c.run("format", "small/odd.st", expect=3, says="cannot write 'small/odd.st': No space left on device")
    assert source.read_bytes() == before
    c.run("new", "small/mine", expect=3, says="cannot write 'small/mine.yaml': No space left on device")
    assert not list(small.glob("*odd.st?*")) and not list(small.glob("*mine*")), list(small.iterdir())
    (small / "rest").unlink()
    c.run("format", "small/odd.st", expect=0)
    assert "x := x + 1;" in source.read_text()


def folders(c):
    def nobody():
        if os.getuid() == 0:
            os.setuid(65534)
    c.path("closed").mkdir(mode=0o555)
    os.chmod(c.folder, 0o755)
    for option in ("--trace", "--pulses"):
        result = c.run("run", "program.yaml", *FOREVER, option, "closed/t.csv", expect=3, preexec_fn=nobody,
                       says="cannot open 'closed/t.csv': Permission denied")
        assert "the run stopped at 0 s" in result.stderr, result.stderr
        c.run("run", "program.yaml", *FOREVER, option, "closed", expect=3,
              says="cannot write 'closed': it is a directory")
        result = c.run("run", "program.yaml", *FOREVER, option, "closed/deep/t.csv", expect=2, preexec_fn=nobody,
                       says="error[L0502]: cannot make the folder 'closed/deep': Permission denied")
        assert result.stderr.count("L0502") == 1, result.stderr  # the files beside it are not told
    assert not any(c.path("closed").iterdir())
    c.path("dark").mkdir()
    c.path("dark").chmod(0o333)  # may be written, but not read
    c.path("study.yaml").write_text("lineshaft_study: 1\ntitle: Short\nprogram: program.yaml\n"
                                    "compare: [axis.position]\ncases: [grid: {time: [5 ms, 6 ms]}]\n")
    c.run("study", "study.yaml", "--traces", "dark", expect=0, preexec_fn=nobody)
    assert len(list(c.path("dark").glob("*time=?_ms.csv"))) == 2, list(c.path("dark").iterdir())


def standard_output(c):
    command = ["run", "program.yaml", "--trace", "t.csv"]
    with open("/dev/full", "w") as full:
        c.run(*command, expect=3, says="No space left on device", stdout=full)
    c.run(*command, expect=3, says="Bad file descriptor", stdout=None, preexec_fn=lambda: os.close(1))
    c.check_whole("t.csv")
    end, closed = os.pipe()
    os.close(end)
    # Nobody reads any more, as after `| head -1`: that is no mistake, and nothing is said of it.
    for piped in command, ["blocks"], ["run", "program.yaml", "--trace", "-", "--quiet"], ["run", "program.yaml", "--json"]:
        assert c.run(*piped, expect=141, stdout=closed).stderr == "", piped
    os.close(closed)
    result = subprocess.run([c.lineshaft, *command], cwd=c.folder, stdout=subprocess.DEVNULL,
                            preexec_fn=lambda: os.close(2))
    assert result.returncode == 0
    c.check_whole("t.csv")


def trace_to_standard_output(c):
    """The same bytes as in a file, and nothing else; what the run says goes to the standard error."""
    c.run("run", "program.yaml", "--trace", "t.csv", "--pulses", "e.csv", expect=0)
    for option, name in (("--trace", "t.csv"), ("--pulses", "e.csv")):
        piped = c.run("run", "program.yaml", option, "-", expect=0)
        assert piped.stdout == c.path(name).read_text() and "machine time" in piped.stderr, piped.stderr
        with open(c.path("redirected"), "w") as file:
            c.run("run", "program.yaml", option, "-", "--quiet", expect=0, stdout=file)
        assert c.path("redirected").read_bytes() == c.path(name).read_bytes()
    assert "L0509" in c.run("run", "program.yaml", "--trace", "-", "--json", expect=2).stdout
    c.run("run", "program.yaml", "--trace", "-", "--pulses", "-", expect=2, says="L0509")
    assert not list(c.folder.glob("-*")), list(c.folder.glob("-*"))


def no_verdicts_without_files(c):
    c.path("expects.yaml").write_text(PROGRAM + "expect: [{at: end, axis.velocity: {at_least: 0 mm/s}}]\n")
    c.path("folder").mkdir()
    result = c.run("run", "expects.yaml", "--trace", "folder", expect=3, says="cannot write 'folder': it is a directory")
    assert "at the end" not in result.stdout, result.stdout


def outputs_over_inputs(c):
    os.link(c.path("program.yaml"), c.path("hard.csv"))
    os.symlink("program.yaml", c.path("soft.csv"))
    for name in ("program.yaml", "./program.yaml", "hard.csv", "soft.csv"):
        for option in ("--trace", "--pulses"):
            c.run("run", "program.yaml", option, name, expect=2, says="L0509")
    c.run("run", "program.yaml", "--trace", "t.csv", "--pulses", "t.csv", expect=2, says="L0509")
    c.path("plan.yaml").write_text(
        "lineshaft_study: 1\ntitle: One\nprogram: program.yaml\ncompare: {axis.velocity: {at_least: 0 mm/s}}\n"
        "cases: [{name: a, set: {time: 1 s}}]\n")
    for name in ("program.yaml", "plan.yaml"):
        c.run("study", "plan.yaml", "-o", name, expect=2, says="L0509")
    c.run("run", "program.yaml", "--trace", "t.csv", expect=0)
    if has_pages(c.folder / "lineshaft", "a report over its trace"):
        c.run("report", "t.csv", "-o", "t.csv", expect=2, says="L0509")
    c.check_whole("t.csv")
    c.path("moves.csv").write_text("Vs,Ve,Vm,A,J,L\n0,0,1,1,1,1\n")
    c.run("plan", "moves.csv", "-o", "moves.csv", expect=2, says="L0509")
    source = "FUNCTION_BLOCK Own\nVAR_OUTPUT n : LINT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n"
    c.path("own.st").write_text(source)
    c.path("uses.yaml").write_text(PROGRAM.replace("blocks:", "sources: own.st\nblocks:\n  own: {type: Own, task: main}"))
    c.path("uses_plan.yaml").write_text(c.path("plan.yaml").read_text().replace("program.yaml", "uses.yaml"))
    c.run("run", "uses.yaml", "--set", "time=1 s", "--trace", "own.st", expect=2, says="L0509")
    c.run("study", "uses_plan.yaml", "-o", "own.st", expect=2, says="L0509")
    c.run("test", "program.yaml", "--junit", "program.yaml", expect=2, says="L0509")
    for option in ("--junit", "--coverage"):
        c.run("test", "uses_plan.yaml", option, "own.st", expect=2, says="L0509")
    assert c.path("own.st").read_text() == source
    c.path("fit.yaml").write_text(
        "lineshaft_fit: 1\nprogram: uses.yaml\nparameters: {speed: {from: 1 mm/s, to: 20 mm/s}}\n"
        "cases: [{set: {time: 1 s}, compare: {axis.velocity: {paper: 10 mm/s}}}]\n")
    for name in ("fit.yaml", "uses.yaml", "own.st"):
        c.run("fit", "fit.yaml", "-o", name, expect=2, says="L0509")
    c.path("no_header.csv").write_text("a,b\n1,2\n")
    c.run("plan", "no_header.csv", "-o", "planned.csv", expect=2, says="the column 'a' is not known")
    assert not list(c.folder.glob("planned*")), list(c.folder.glob("planned*"))
    assert c.path("program.yaml").read_text() == PROGRAM


def linked_folders(c):
    """`..` of a folder that is a link is the folder around what it links to."""
    (c.folder / "project" / "config").mkdir(parents=True)
    (c.folder / "project" / "programs").mkdir()
    (c.folder / "elsewhere").mkdir()
    c.path("project/config/own.st").write_text(
        "FUNCTION_BLOCK Own\nVAR_OUTPUT n : LINT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n")
    c.path("project/programs/p.yaml").write_text(
        PROGRAM.replace("blocks:", "sources: ../config/own.st\nblocks:\n  own: {type: Own, task: main}"))
    os.symlink("../project/programs", c.path("elsewhere/link"))
    for name in ("project/programs/p.yaml", "elsewhere/link/p.yaml"):
        c.run("check", name, expect=0)


def signals(c):
    for kind in (signal.SIGINT, signal.SIGTERM):
        process = c.start(*FOREVER, "--trace", "cut.csv", "--pulses", "edges.csv")
        while not (c.path("cut.csv.part").exists() and c.path("cut.csv.part").stat().st_size > 100000):
            time.sleep(0.005)
        process.send_signal(kind)
        stderr = process.communicate(timeout=10)[1]
        assert process.returncode == 130, (process.returncode, stderr)
        assert "interrupted at " in stderr, stderr
        c.check_whole("cut.csv")
        for name in ("cut.csv", "edges.csv"):
            assert c.sidecar(name)["lineshaft:stopped"].startswith("interrupted at "), c.sidecar(name)
        assert c.path("edges.csv").read_bytes().endswith(b",1\n")
        assert not c.path("cut.csv.part").exists() and not c.path("edges.csv.part").exists()
        verified = c.run("verify", "cut.csv", expect=0).stdout
        assert "did not complete: interrupted at " in verified, verified
    c.run("run", "program.yaml", "--trace", "cut.csv", "--pulses", "edges.csv", expect=0)
    assert "lineshaft:stopped" not in c.sidecar("cut.csv")
    assert not c.path("edges.csv-metadata.json").exists()


def second_signals(c):
    """The first ends the run in order, a later one ends the process, whatever it waits for. A sender that sends it
    twice at once (as `timeout` does) means it once."""
    os.mkfifo(c.path("nobody_reads.csv"))
    process = c.start("--trace", "nobody_reads.csv")
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    time.sleep(0.5)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=10)
    assert process.returncode == 130, process.returncode
    process = c.start(*FOREVER, "--trace", "twice.csv")
    while not c.path("twice.csv.part").exists():
        time.sleep(0.005)
    process.send_signal(signal.SIGTERM)
    process.send_signal(signal.SIGTERM)
    assert "interrupted at " in process.communicate(timeout=10)[1]
    c.check_whole("twice.csv")


def idle_inputs(c):
    """What the command line names may be a pipe that nobody writes to: a signal ends the wait."""
    os.mkfifo(c.path("idle"))
    commands = [["check", "idle"], ["run", "idle"], ["run", "/dev/stdin"], ["check", "/dev/stdin"], ["diff", "idle", "idle"],
                ["test", "idle"], ["study", "idle"], ["fit", "idle"], ["show", "idle"], ["plan", "-"], ["plan", "idle"],
                ["verify", "/dev/stdin"]]
    if has_pages(c.folder / "lineshaft", "a report of an idle pipe"):
        commands.append(["report", "idle", "-o", "r.html"])
    waiting = [subprocess.Popen([c.lineshaft, *command], cwd=c.folder, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE) for command in commands]
    time.sleep(1)
    for command, process, kind in zip(commands, waiting, (signal.SIGINT, signal.SIGTERM) * len(commands)):
        assert process.poll() is None, (command, process.communicate())
        process.send_signal(kind)
    for command, process in zip(commands, waiting):
        process.communicate(timeout=10)
        assert process.returncode == 130, (command, process.returncode)
    written = subprocess.Popen([c.lineshaft, "check", "/dev/stdin"], cwd=c.folder, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    time.sleep(0.3)
    assert written.communicate(PROGRAM, timeout=10)[0] == "ok  /dev/stdin\n"


def pipes_that_files_name(c):
    """What a file names is a regular file, or the mistake is told at its place."""
    os.mkfifo(c.path("pipe"))
    study = "lineshaft_study: 1\nprogram: {}\ncompare: {{axis.velocity: {{at_least: 0 mm/s}}}}\ncases: [{{name: a}}]\n"
    fit = ("lineshaft_fit: 1\nprogram: {}\nparameters: {{speed: {{from: 1 mm/s, to: 20 mm/s}}}}\n"
           "cases: [{{compare: [axis.velocity], trace: {}}}]\n")
    files = {
        "controller": PROGRAM.replace("tasks: {main: {every: 1 ms}}", "controller: pipe"),
        "replay": PROGRAM.replace("stimulus: [", "stimulus: [{file: pipe, set: {inputs.go: go}}, "),
        "study": study.format("pipe"),
        "fit": fit.format("pipe", "t.csv"),
        "measured": fit.format("program.yaml", "pipe"),
    }
    for name, text in files.items():
        c.path(f"names_{name}.yaml").write_text(text)
        said = c.run("check", f"names_{name}.yaml", expect=2, says="'pipe' is not a regular file").stderr
        line = text[:text.index("pipe")].count("\n") + 1
        assert f"names_{name}.yaml:{line}:" in said, said


def marks(c):
    """Of each file of c.folder / out.*: the run that it comes from."""
    def column(name):
        return {line.split(",")[2] for line in c.path(name).read_text().splitlines()[2:]}
    events = c.path("out.events.csv").read_text()
    told = [json.loads(c.path(name + "-metadata.json").read_text())["lineshaft:run"]["parameters"]["mark"]
            for name in ("out.csv", "out.more.csv")]
    return {*column("out.csv"), *column("out.more.csv"), *told, events.split("inputs.mark = ")[1].split("\n")[0],
            str(len(c.path("out.edges").read_text().splitlines()) - 1)}


def writers_at_once(c, rounds=25):
    """Of four runs into the same files the last one wins as a whole."""
    c.path("marked.yaml").write_text(MARKED)
    winners = set()
    for _ in range(rounds):
        runs = [subprocess.Popen([c.lineshaft, "run", "marked.yaml", "--quiet", "--set", f"mark={mark}", "--force",
                                  f"inputs.mark={mark}", "--trace", "out.csv", "--pulses", "out.edges"], cwd=c.folder,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                for mark in (2, 3, 4, 5)]
        said = [process.communicate(timeout=60)[1] for process in runs]
        assert all(process.returncode == 0 for process in runs), said
        c.run("verify", "out.csv", "out.more.csv", expect=0)
        found = marks(c)
        assert len(found) == 1, found
        winners |= found
    assert not list(c.folder.glob("out*.part*")), list(c.folder.glob("out*.part*"))
    print(f"{rounds} rounds of four, won by {', '.join(sorted(winners))}")


def little_memory(c):
    """From too little to start to enough."""
    if os.environ.get("LINESHAFT_MEMORY_LIMITS") == "off":
        print("skipped: memory is not limited")
        return
    outcomes = set()
    least = (c.path(c.lineshaft).stat().st_size >> 20) + 2  # where the executable itself does not fit no process begins
    for megabytes in range(least, 64, 2):
        for name in ("m.csv", "m.csv-metadata.json"):
            c.path(name).unlink(missing_ok=True)
        result = subprocess.run([c.lineshaft, "run", "program.yaml", "--trace", "m.csv"], cwd=c.folder,
                                capture_output=True, text=True, timeout=60,
                                preexec_fn=limit(resource.RLIMIT_AS, megabytes << 20))
        outcomes.add(result.returncode)
        if result.returncode == 0:
            c.check_whole("m.csv")
        else:
            # 127: the libraries do not fit. SIGABRT: nor does the C++ runtime's reserve for exceptions.
            no_reserve = result.returncode == -signal.SIGABRT and "without an active exception" in result.stderr
            assert no_reserve or result.returncode in (3, 127), (megabytes, result)
            assert result.stderr and not c.path("m.csv").exists(), (megabytes, result)
    assert {0, 127} <= outcomes, outcomes


def kills(c):
    """The trace of before or the new one, never a part; a sidecar tells of the trace that it stands beside."""
    versions = []
    for speed in ("5 mm/s", "10 mm/s"):
        start = time.monotonic()
        c.run("run", "program.yaml", "--set", f"speed={speed}", "--trace", "k.csv", expect=0)
        seconds = time.monotonic() - start
        versions.append((c.path("k.csv").read_bytes(), c.path("k.csv-metadata.json").read_bytes()))
    generator = random.Random(1)
    killed = rounds = 0
    while killed < c.kills:
        round, rounds = rounds, rounds + 1
        assert rounds <= 20 * c.kills, "the runs end before they can be killed"
        process = c.start("--set", f"speed={('5 mm/s', '10 mm/s')[round % 2]}", "--trace", "k.csv")
        time.sleep(generator.uniform(0, 1.2 * seconds))
        process.kill()
        process.communicate()
        killed += process.returncode == -signal.SIGKILL
        trace, beside = c.path("k.csv").read_bytes(), c.path("k.csv-metadata.json")
        found = [version for version in versions if version[0] == trace]
        assert found, f"kill {round}: {len(trace)} bytes are no whole trace"
        assert not beside.exists() or beside.read_bytes() == found[0][1], f"kill {round}: another's sidecar"
    print(f"killed {killed} of {rounds} runs")


def main():
    with tempfile.TemporaryDirectory() as folder:
        c = Checks(os.path.abspath(sys.argv[1]), pathlib.Path(folder), int(sys.argv[2]) if len(sys.argv) > 2 else 10)
        for check in (full_disks, small_file_systems, folders, standard_output, trace_to_standard_output,
                      no_verdicts_without_files, outputs_over_inputs, linked_folders, signals, second_signals, idle_inputs,
                      pipes_that_files_name, writers_at_once, little_memory, kills):
            check(c)
            print("ok ", check.__name__, flush=True)


if __name__ == "__main__":
    main()
