#!/usr/bin/python3
"""`run` and `serve` with each number of processes and descriptors, each amount of memory and of disk in a range: they
end with 0, 2 or 3, and what stands under the name of a trace is whole, or says that it is not.

usage: limits.py LINESHAFT [STEP]
    STEP   try every STEP-th value only; default: 1, all
LINESHAFT_MEMORY_LIMITS=off: for a build with sanitizers or counters, which need more

Where the libraries do not fit into the memory, or have no descriptor, the dynamic loader ends the process with 127, and
where the C++ library's reserve for exceptions does not fit, with SIGABRT, both before the first line of lineshaft: the
ranges begin above that.
"""

import collections
import json
import os
import pathlib
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

PROGRAM = """lineshaft: 1
parameters: {time: 1 s}
tasks: {main: {every: 1 ms}}
inputs: {go: true, level: 1}
blocks:
  axis: {type: axis, task: main}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: 10 mm/s, Execute: inputs.go}
  counter: {type: ctu, task: main, cu: inputs.go, pv: inputs.level}
  x: {type: pto, task: main, start_rate: 1 kHz, count: 1000000, execute: inputs.go}
retain: [inputs.level]
modbus:
  coils: {0: {signal: inputs.go, write: true}}
  holding_registers: {0: {signal: inputs.level, type: uint16, write: true}}
run: {for: $time}
trace: {task: main, signals: [axis.position, axis.velocity]}
"""
MEGABYTE = 1 << 20
NOBODY = 65534
FILES = ("t.csv", "t.events.csv", "e.csv")
WRITE = bytes.fromhex("000100000006010600000007")  # register 0 becomes 7


class Harness:
    def __init__(self, lineshaft, folder):
        self.folder = folder
        os.umask(0)
        for part in "lineshaft", "lineshaft_http.so":
            shutil.copy(pathlib.Path(lineshaft).with_name(part), folder / part)
        (folder / "lineshaft").chmod(0o755)
        self.command = str(folder / "lineshaft")
        folder.chmod(0o777)
        (folder / "program.yaml").write_text(PROGRAM)
        self.work = folder / "work"
        self.codes = collections.Counter()
        self.wrong = []

    def begin(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(mode=0o777)

    def start(self, arguments, limits, as_nobody=False):
        def limit():
            if as_nobody and os.geteuid() == 0:
                os.setgroups([])
                os.setgid(NOBODY)
                os.setuid(NOBODY)
            for kind, value in limits:
                resource.setrlimit(kind, (value, value))

        return subprocess.Popen([self.command, *arguments], cwd=self.work, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, preexec_fn=limit)

    def judge(self, what, code, said):
        self.codes[what.split()[0], code] += 1
        wrong = [] if code in (0, 2, 3) else [f"exit code {code}"]
        wrong += ["no message"] if code in (2, 3) and not said.strip() else []
        for name in FILES:
            if (self.work / name).exists() and not self.is_told(name, code):
                wrong.append(f"{name} is neither whole nor marked")
        if wrong:
            self.wrong.append((what, wrong, said[-1000:]))
            print(what, *wrong, said[-1000:], sep="; ", flush=True)

    def is_told(self, name, code):
        """Whole by its sidecar, or a table without one of a run that said nothing was wrong."""
        if not (self.work / (name + "-metadata.json")).exists():
            text = (self.work / name).read_bytes()
            return name != "t.csv" and text.endswith(b"\n") and code == 0
        verified = subprocess.run([self.command, "verify", name], cwd=self.work, capture_output=True, text=True)
        sidecar = json.loads((self.work / (name + "-metadata.json")).read_text())
        rows = (self.work / name).read_bytes().count(b"\n") - 1
        is_whole = verified.returncode == 0 and rows == sidecar["lineshaft:rows"]
        return is_whole and (code == 0 or "lineshaft:stopped" in sidecar)

    def run(self, what, limits, as_nobody=False):
        self.begin()
        process = self.start(["run", "../program.yaml", "--quiet", "--trace", "t.csv", "--pulses", "e.csv",
                              "--retain-file", "kept.ret", "--checkpoint-every", "300 ms", "--checkpoint", "c.checkpoint"],
                             limits, as_nobody)
        self.finish(f"run: {what}", process)

    def finish(self, what, process):
        try:
            said = process.communicate(timeout=60)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            self.wrong.append((what, "does not end", process.communicate()[1]))
            print(*self.wrong[-1], sep="; ", flush=True)
            return
        self.judge(what, process.returncode, said)

    def serve(self, what, limits, as_nobody=False):
        self.begin()
        ports = free_ports()
        process = self.start(["serve", "../program.yaml", "--allow-write", "--trace", "t.csv", "--record", "r.yaml", "--http",
                              f"127.0.0.1:{ports[0]}", "--modbus", f"127.0.0.1:{ports[1]}", "--for", "1000 s"],
                             limits, as_nobody)
        said = ""
        while (line := process.stderr.readline()) and not line.startswith("serving "):
            said += line
        if not line:
            process.communicate(timeout=60)
            return self.judge(f"serve: {what}", process.returncode, said)
        for _ in range(2):
            talk(ports)
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        self.finish(f"serve: {what}", process)


def free_ports():
    with socket.socket() as one, socket.socket() as other:
        one.bind(("127.0.0.1", 0))
        other.bind(("127.0.0.1", 0))
        return one.getsockname()[1], other.getsockname()[1]


def talk(ports):
    """Six clients of each protocol at once; whether they are answered depends on what there is."""
    body = b'{"inputs.level": 5}'
    request = b"POST /api/set HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n%s" % (len(body), body)
    clients = []
    for port, text in ((ports[0], request), (ports[1], WRITE)) * 6:
        try:
            client = socket.create_connection(("127.0.0.1", port), timeout=0.3)
            clients.append(client)
            client.sendall(text)
        except OSError:
            pass
    for client in clients:
        try:
            client.recv(1000)
        except OSError:
            pass
        client.close()


def least_that_starts(harness, kind, least, most, step):
    """The least value with which `--version` is printed each time: with less the loader ends the process."""
    harness.begin()
    while most - least > step:
        middle = (least + most) // 2
        codes = {version_with(harness, kind, middle) for _ in range(3)}
        least, most = (least, middle) if codes == {0} else (middle, most)
    return most


def version_with(harness, kind, value):
    process = harness.start(["--version"], [(kind, value)])
    process.communicate(timeout=60)
    return process.returncode


def processes_and_descriptors(harness, step):
    for count in range(0, 24, step):
        for way in (harness.run, harness.serve):
            way(f"processes {count}", [(resource.RLIMIT_NPROC, count)], as_nobody=True)
    for count in range(least_that_starts(harness, resource.RLIMIT_NOFILE, 3, 48, 1), 48, step):
        for way in (harness.run, harness.serve):
            way(f"descriptors {count}", [(resource.RLIMIT_NOFILE, count)])


def memory(harness, step):
    if os.environ.get("LINESHAFT_MEMORY_LIMITS") == "off":
        print("SKIPPED: memory is not limited")
        return
    least = least_that_starts(harness, resource.RLIMIT_AS, MEGABYTE, 1024 * MEGABYTE, MEGABYTE // 4)
    print(f"the process starts with {least / MEGABYTE:.1f} MB of addresses")
    for part in range(4, 4 * 60, step):
        harness.run(f"memory {part / 4} MB more", [(resource.RLIMIT_AS, least + part * MEGABYTE // 4)])
    for part in range(1, 200, step):
        harness.serve(f"memory {part} MB more", [(resource.RLIMIT_AS, least + part * MEGABYTE)])


def disk(harness, step):
    for size in range(0, 120_000, 1000 * step):
        for way in (harness.run, harness.serve):
            way(f"files of {size} bytes", [(resource.RLIMIT_FSIZE, size)])
    harness.begin()
    mount = ["mount", "-t", "tmpfs", "-o"]
    if subprocess.run([*mount, "size=64k", "none", harness.work], capture_output=True).returncode != 0:
        print("SKIPPED: no file system can be mounted here")
        return
    subprocess.run(["umount", harness.work], check=True)
    for pages in range(1, 60, step):
        small = SmallDisk(harness, pages)
        for way in (harness.run, harness.serve):
            with small:
                way(f"disk of {pages} pages", [])


class SmallDisk:
    """The folder of a trial as a file system of its own while it lasts."""

    def __init__(self, harness, pages):
        self.harness, self.size = harness, pages * resource.getpagesize()

    def __enter__(self):
        self.harness.begin()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={self.size},mode=777", "none", self.harness.work], check=True)
        self.begin, self.harness.begin = self.harness.begin, lambda: None

    def __exit__(self, *_):
        self.harness.begin = self.begin
        subprocess.run(["umount", self.harness.work], check=True)


def main():
    step = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with tempfile.TemporaryDirectory() as folder:
        harness = Harness(os.path.abspath(sys.argv[1]), pathlib.Path(folder))
        for part in (processes_and_descriptors, memory, disk):
            part(harness, step)
    for (command, code), count in sorted(harness.codes.items()):
        print(f"{command} exit code {code}: {count} times")
    assert not harness.wrong and sum(harness.codes.values()) > 0, f"{len(harness.wrong)} wrong"
    assert {("run:", 0), ("run:", 3), ("serve:", 0), ("serve:", 3)} <= set(harness.codes), harness.codes


if __name__ == "__main__":
    main()
