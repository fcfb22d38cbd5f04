#!/usr/bin/python3
"""Lets the N-th write, fsync, syncfs, rename, open and allocation of each command fail, for N = 1, 2, 3 ... until none does:
the command ends with a message and an exit code for it, and what stands under a final name is whole. `serve` has clients
meanwhile, threads and connections fail, too, and what it has acknowledged is recorded.

usage: fault.py LINESHAFT [STEP]
    STEP   allocations are many: fail every STEP-th only, after the first 100; default: 1, all
"""

import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from built import has_pages  # noqa: E402

PROGRAM = """lineshaft: 1
title: An axis and pulses
parameters: {speed: 10 mm/s}
tasks: {main: {every: 1 ms}}
inputs: {go: false}
stimulus: [{at: 1 ms, set: {inputs.go: true}}]
blocks:
  axis: {type: axis, task: main, default_acceleration: 100 mm/s^2}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: $speed, Execute: true}
  x: {type: pto, task: main, start_rate: 1 kHz, count: 1000, execute: inputs.go}
run: {for: 20 ms}
trace: {task: main, signals: [axis.position, axis.velocity]}
expect: [{at: end, x.busy: true}]
"""
STUDY = """lineshaft_study: 1
title: Speeds
program: program.yaml
compare: {axis.position: {at_least: 0 mm}}
cases: [grid: {speed: [1 mm/s, 2 mm/s, 3 mm/s]}]
"""
FIT = """lineshaft_fit: 1
title: The speed
program: program.yaml
parameters: {speed: {from: 1 mm/s, to: 20 mm/s}}
cases: [compare: {axis.velocity: {paper: 0.3 mm/s}}]
"""
COMMANDS = {
    "run": ["run", "program.yaml", "--trace", "out.csv", "--pulses", "out_edges.csv"],
    "study": ["study", "study.yaml", "-j", "2", "-o", "out.csv", "--traces", "out_traces"],
    "fit": ["fit", "fit.yaml", "-j", "2", "-o", "out.yaml"],
    "plan": ["plan", "moves.csv", "-o", "out.csv"],
    "report": ["report", "trace.csv", "-o", "out.html"],
    "verify": ["verify", "trace.csv"],
}
if not has_pages(pathlib.Path(sys.argv[1]).resolve(), "faults of report"):
    del COMMANDS["report"]
SERVED = """lineshaft: 1
tasks: {main: {every: 1 ms}}
inputs: {w: 0}
blocks: {late: {type: ton, task: main, in: true, pt: 1 s}, counter: {type: ctu, task: main, cu: late.q, pv: inputs.w}}
modbus: {holding_registers: {0: {signal: inputs.w, type: uint16, write: true}}}
run: {for: 1 s}
"""
KINDS = ("write", "fsync", "syncfs", "rename", "open", "malloc")
KINDS_OF_SERVE = ("disk", "thread", "accept", "open", "malloc")
MOST_SECONDS = 20


def is_marked(name, outputs, said):
    """What a run that was stopped has left, and says so."""
    beside = name if name.endswith("-metadata.json") else name + "-metadata.json"
    stopped = name.endswith(".events.csv") and "the run stopped at" in said
    return stopped or "lineshaft:stopped" in json.loads(outputs.get(beside, "{}"))


def answer_of(port, request):
    """What comes to it; empty when the client is not answered."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=10) as client:
            client.sendall(request)
            client.shutdown(socket.SHUT_WR)
            answer = b""
            while part := client.recv(4096):
                answer += part
            return answer
    except OSError:  # it was sent away
        return b""


class Command:
    """One command in a folder of its own."""

    def __init__(self, lineshaft, shim, name, kind, root):
        self.lineshaft, self.shim, self.name, self.kind = lineshaft, shim, name, kind
        self.folder = root / f"{name}_{kind}"
        self.folder.mkdir()
        for file, text in (("program.yaml", PROGRAM), ("study.yaml", STUDY), ("fit.yaml", FIT), ("served.yaml", SERVED),
                           ("moves.csv", "Vs,Ve,Vm,A,J,L\n" + "0,0,1,1,1,1\n" * 20)):
            (self.folder / file).write_text(text)
        subprocess.run([lineshaft, "run", "program.yaml", "--trace", "trace.csv"], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)
        self.code, _ = self.run(0)
        assert self.code in (0, 1), self.code
        self.calls = int((self.folder / "calls").read_text())
        self.whole = self.outputs()

    def run(self, at):
        for file in self.written():
            file.unlink()
        environment = {**os.environ, "LD_PRELOAD": self.shim, "FAULT_KIND": self.kind, "FAULT_AT": str(at),
                       "FAULT_REPORT": str(self.folder / "calls")}
        answer = subprocess.run([self.lineshaft, *COMMANDS[self.name]], cwd=self.folder, env=environment,
                                capture_output=True, timeout=MOST_SECONDS)
        return answer.returncode, (answer.stderr + answer.stdout).decode(errors="replace")

    def written(self):
        return [file for place in ("out*", "out*/*") for file in self.folder.glob(place) if file.is_file()]

    def outputs(self):
        return {file.name: file.read_bytes() for file in self.written() if ".part" not in file.name}

    def mistake(self, at):
        """What is wrong with the answer to a failure of the N-th call; empty when nothing is."""
        code, said = self.run(at)
        outputs = self.outputs()
        if code == self.code:
            return "" if outputs == self.whole else f"exit code {code} without all outputs"
        faulty_case = code == 1 and self.name == "study" and "fault: " in said
        if code not in (2, 3) and not faulty_case:
            return f"exit code {code}: {said}"
        if "error: " not in said and "error[" not in said and "fault: " not in said:
            return f"no message: {said}"
        if faulty_case:
            return ""
        broken = [name for name, text in outputs.items()
                  if self.whole.get(name) != text and not is_marked(name, outputs, said)]
        return f"{broken} not whole" if broken else ""

    def places(self, step):
        few = 100 if self.kind == "malloc" else self.calls
        return [*range(1, min(few, self.calls) + 1), *range(few + 1, self.calls + 1, step)]


class Served(Command):
    """A machine that two clients write to, one after the other."""

    def run(self, at):
        for file in self.written():
            file.unlink()
        ports = []
        for _ in range(2):
            with socket.socket() as probe:
                probe.bind(("127.0.0.1", 0))
                ports.append(probe.getsockname()[1])
        environment = {**os.environ, "LD_PRELOAD": self.shim, "FAULT_KIND": self.kind, "FAULT_AT": str(at),
                       "FAULT_REPORT": str(self.folder / "calls")}
        process = subprocess.Popen(
            [self.lineshaft, "serve", "served.yaml", "--allow-write", "--record", "out.yaml", "--http",
             f"127.0.0.1:{ports[0]}", "--modbus", f"127.0.0.1:{ports[1]}"],
            cwd=self.folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        said = ""
        while (line := process.stderr.readline().decode(errors="replace")) and not line.startswith("serving "):
            said += line
        kept = self.write(ports) if line else []
        process.send_signal(signal.SIGTERM)
        said += process.communicate(timeout=MOST_SECONDS)[1].decode(errors="replace")
        recorded = (self.folder / "out.yaml").read_text() if (self.folder / "out.yaml").exists() else ""
        missing = [value for value in kept if f"inputs.w: {value}}}" not in recorded]
        return f"{missing} acknowledged and not recorded" if missing else process.returncode, said

    def write(self, ports):
        kept = []
        for value in range(1, 7):
            if value % 2:
                body = f'{{"inputs.w": {value}}}'.encode()
                request = b"POST /api/set HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n%b" % (len(body), body)
                done = answer_of(ports[0], request).startswith(b"HTTP/1.1 200")
            else:
                request = struct.pack(">HHHBBHH", 1, 0, 6, 1, 6, 0, value)
                done = answer_of(ports[1], request) == request
            kept += [value] if done else []
        return kept

    def mistake(self, at):
        code, said = self.run(at)
        if code not in (0, 2, 3):
            return f"exit code {code}: {said}"
        return "" if code == 0 or "error" in said else f"no message: {said}"


def main():
    lineshaft, step = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        root, failed = pathlib.Path(folder), 0
        shim = root / "fault.so"
        source = pathlib.Path(__file__).with_name("fault.c")
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", shim, source, "-ldl"], check=True)

        def try_all(case):
            kind_of = Served if case[0] == "serve" else Command
            command = kind_of(lineshaft, str(shim), *case, root)
            places = command.places(step)
            wrong = [f"{case[0]}, {case[1]} {at}: {m}" for at in places if (m := command.mistake(at))]
            shutil.rmtree(command.folder)
            return f"{case[0]}: {len(places)} of {command.calls} calls of {case[1]} failed in turn", wrong

        for line, wrong in pool.map(try_all, [("serve", kind) for kind in KINDS_OF_SERVE]
                                    + [(name, kind) for kind in KINDS for name in COMMANDS]):
            print(line, *wrong[:20], sep="\n    ", flush=True)
            failed += len(wrong)
    print(f"{failed} wrong")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
