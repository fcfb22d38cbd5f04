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
import signal
import subprocess
import sys
import tempfile
import time
import zlib

PROGRAM = """lineshaft: 1
title: An axis and pulses
parameters: {time: 20 s, speed: 10 mm/s}
tasks: {main: {every: 1 ms}}
inputs: {go: false}
stimulus: [{at: 1 ms, set: {inputs.go: true}}]
blocks:
  axis: {type: virtual_axis, task: main, velocity: $speed}
  x: {type: pto, task: main, start_rate: 1 kHz, count: 1000000, execute: inputs.go}
run: {for: $time}
trace: {task: main, signals: [axis.position, axis.velocity]}
"""
FOREVER = ["--set", "time=100000 s"]


class Checks:
    def __init__(self, lineshaft, folder, kills):
        self.lineshaft, self.folder, self.kills = lineshaft, folder, kills
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
    finally:
        subprocess.run(["umount", small], check=True)


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
        c.run("run", "program.yaml", *FOREVER, option, "nowhere/t.csv", expect=3,
              says="cannot open 'nowhere/t.csv': No such file or directory")
    assert not any(c.path("closed").iterdir())


def standard_output(c):
    command = ["run", "program.yaml", "--trace", "t.csv"]
    with open("/dev/full", "w") as full:
        c.run(*command, expect=3, says="No space left on device", stdout=full)
    c.run(*command, expect=3, says="Bad file descriptor", stdout=None, preexec_fn=lambda: os.close(1))
    c.check_whole("t.csv")
    end, closed = os.pipe()
    os.close(end)
    c.run(*command, expect=3, says="Broken pipe", stdout=closed)
    os.close(closed)
    result = subprocess.run([c.lineshaft, *command], cwd=c.folder, stdout=subprocess.DEVNULL,
                            preexec_fn=lambda: os.close(2))
    assert result.returncode == 0
    c.check_whole("t.csv")


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
    c.run("report", "t.csv", "-o", "t.csv", expect=2, says="L0509")
    c.check_whole("t.csv")
    c.path("moves.csv").write_text("Vs,Ve,Vm,A,J,L\n0,0,1,1,1,1\n")
    c.run("plan", "moves.csv", "-o", "moves.csv", expect=2, says="L0509")
    assert c.path("program.yaml").read_text() == PROGRAM


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


def little_memory(c):
    """From too little to start to enough."""
    if os.environ.get("LINESHAFT_MEMORY_LIMITS") == "off":
        print("skipped: memory is not limited")
        return
    outcomes = set()
    for megabytes in range(8, 64, 2):
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
        for check in (full_disks, small_file_systems, folders, standard_output, outputs_over_inputs, signals,
                      little_memory, kills):
            check(c)
            print("ok ", check.__name__, flush=True)


if __name__ == "__main__":
    main()
