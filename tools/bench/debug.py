#!/usr/bin/python3
"""What a debugger costs a run that nobody stops: one program by `lineshaft run` and by `lineshaft debug` in turn, launched,
continued and run to its end. Bar: 1.05 times the processor's time, of the least of each.

usage: debug.py LINESHAFT [TIMES [HOURS]]     5 times, 8 hours of the program's time
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

source = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(source / "tests"))
from dap_client import Client  # noqa: E402

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
times = int(sys.argv[2]) if len(sys.argv) > 2 else 5
hours = float(sys.argv[3]) if len(sys.argv) > 3 else 8
folder = pathlib.Path(tempfile.mkdtemp())
program = folder / "line.yaml"
program.write_text(f"""lineshaft: 1
sources: {source}/tests/debug/motor.st
tasks: {{main: {{every: 1 ms, priority: 1}}, servo: {{every: 1 ms, priority: 9}}}}
inputs: {{start: false}}
stimulus: [{{at: 25 ms, set: {{inputs.start: true}}}}]
blocks:
  x: {{type: axis, task: servo}}
  motor: {{type: Motor, task: main, start: inputs.start}}
  feed: {{type: MC_MoveVelocity, task: main, Axis: x, Velocity: 1 mm/s, Execute: motor.running}}
  delay: {{type: ton, task: main, in: motor.running, pt: 20 ms}}
run: {{for: {hours} h}}
""", encoding="utf-8")


def spent(process):
    """Of the processor [s]."""
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, process.returncode
    return usage.ru_utime + usage.ru_stime


def by_run():
    return spent(subprocess.Popen([lineshaft, "run", program, "--include-dir", source, "--quiet"]))


def by_debugger():
    client = Client(lineshaft)
    client.launch(program, args=["--include-dir", str(source)], stopOnEntry=True)
    client.event("stopped")
    client.request("continue", threadId=1)
    while client._next("exited").get("event") != "exited":
        continue
    client.request("disconnect")
    client.process.stdin.close()
    return spent(client.process)


measured = {by_run: [], by_debugger: []}
for _ in range(times):
    for way, seconds in measured.items():
        begun = time.perf_counter()
        seconds.append((way(), time.perf_counter() - begun))
for title, part in (("processor", 0), ("clock", 1)):
    run, debugger = (min(each[part] for each in seconds) for seconds in measured.values())
    print(f"{title}: run {run:.3f} s, debugger {debugger:.3f} s: {debugger / run:.3f} x" + (", bar 1.05" if part == 0 else ""))
