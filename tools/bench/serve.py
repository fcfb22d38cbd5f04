#!/usr/bin/python3
"""How well `lineshaft serve` keeps the clock, beside a bare loop of clock_nanosleep in the same time, and what clients
cost: lateness of the scans of a task of 1 ms.

usage: serve.py LINESHAFT [SECONDS [PRIORITY]]     first without clients, then with 8 pages of 1,000 signals at 100 Hz and
4 clients of Modbus that poll 124 registers as fast as they can, the bare loop beside both; with a priority both have it
(`--realtime`)
"""

import ctypes
import http.client
import json
import multiprocessing
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

SIGNALS, REGISTERS = 1000, 125


def program():
    blocks = "\n".join(f"  x{i}: {{type: axis, task: servo}}\n  feed{i}: {{type: MC_MoveVelocity, task: servo, Axis: x{i}, "
                       f"Velocity: {1 + i} mm/s, Execute: true}}" for i in range(SIGNALS // 4))
    registers = ", ".join(f"{2 * i}: x{i}.position" for i in range(REGISTERS // 2))
    return f"""lineshaft: 1
tasks: {{servo: {{every: 1 ms}}}}
blocks:
{blocks}
modbus:
  input_registers: {{{registers}}}
run: {{for: 1 s}}
"""


def bare_loop(seconds, priority, pipe):
    """Lateness [us] of waking at each millisecond of the clock."""
    libc = ctypes.CDLL(None)
    libc.prctl(29, 1, 0, 0, 0)  # no slack
    if priority:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))

    class Timespec(ctypes.Structure):
        _fields_ = [("s", ctypes.c_long), ("ns", ctypes.c_long)]

    late = []
    due = time.monotonic_ns() + 1_000_000
    for _ in range(int(seconds * 1000)):
        libc.clock_nanosleep(1, 1, ctypes.byref(Timespec(*divmod(due, 10**9))), None)
        late.append((time.monotonic_ns() - due) / 1e3)
        due += 1_000_000
    pipe.send(sorted(late))


def page(port, names, ends, lost):
    connection = http.client.HTTPConnection("127.0.0.1", port)
    connection.request("GET", f"/api/stream?every=10ms&signals={','.join(names)}")
    response = connection.getresponse()
    while not ends.is_set():
        line = response.readline()
        if b'"lost":' in line:
            lost[threading.get_ident()] = int(line.rsplit(b'"lost":', 1)[1].split(b"}")[0])


def poll(port, ends, count):
    client = socket.create_connection(("127.0.0.1", port))
    while not ends.is_set():
        client.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, 4, 0, 2 * (REGISTERS // 2)))
        if not client.recv(1000):
            return
        count[threading.get_ident()] = count.get(threading.get_ident(), 0) + 1


def serve(command, folder, seconds, priority, clients):
    realtime = ["--realtime", str(priority)] if priority else []
    process = subprocess.Popen(
        [command, "serve", "program.yaml", "--http", "127.0.0.1:18080", "--modbus", "127.0.0.1:11502", "--json",
         "--for", f"{seconds} s", *realtime], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stderr.readline()
    names = [f"x{i}.{port}" for i in range(SIGNALS // 4)
             for port in ("position", "velocity", "acceleration", "enable")]
    ends, lost, count = threading.Event(), {}, {}
    threads = [threading.Thread(target=page, args=(18080, names, ends, lost), daemon=True)
               for _ in range(8 if clients else 0)]
    threads += [threading.Thread(target=poll, args=(11502, ends, count), daemon=True) for _ in range(4 if clients else 0)]
    for thread in threads:
        thread.start()
    out, errors = process.communicate()
    ends.set()
    assert process.returncode == 0, errors
    task = json.loads(out)["serving"]["tasks"][0]
    print(f"{'12 clients' if clients else 'no client '}  " +
          "  ".join(f"{name} {value:8.1f} us" for name, value in task["lateness_us"].items()) +
          f"  overruns {task['overruns']}" +
          (f"  rows lost {sum(lost.values())}, polls {sum(count.values())}" if clients else ""))


def beside_bare_loop(command, folder, seconds, priority, clients):
    here, there = multiprocessing.Pipe()
    loop = multiprocessing.Process(target=bare_loop, args=(seconds, priority, there))
    loop.start()
    serve(command, folder, seconds, priority, clients)
    late = here.recv()
    loop.join()
    names = {"p50": 0.5, "p99": 0.99, "p99.9": 0.999, "greatest": 1}
    print("bare loop   " + "  ".join(f"{name} {late[min(int(part * len(late)), len(late) - 1)]:8.1f} us"
                                     for name, part in names.items()) +
          f"  overruns {sum(each >= 1000 for each in late)}", flush=True)


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    priority = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "program.yaml").write_text(program(), encoding="utf-8")
        for clients in (False, True):
            beside_bare_loop(command, folder, seconds, priority, clients)


if __name__ == "__main__":
    main()
