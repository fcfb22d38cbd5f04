#!/usr/bin/python3
"""How well `lineshaft serve` keeps the clock, beside a bare loop of clock_nanosleep in the same time, and what clients
cost: lateness of the scans of a task of 1 ms.

usage: serve.py LINESHAFT [SECONDS [PRIORITY]]     first without clients, then with 8 pages of 1,000 signals at 100 Hz and
4 clients of Modbus that poll 124 registers as fast as they can, the bare loop beside both; with a priority both have it
(`--realtime`); at last without clients and with 64 idle ones of Modbus and 200 slow ones of HTTP in turn: how soon the
owner is answered, and how late the scans are
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
TOKEN = "0123456789abcdef0123456789abcdef"


def program():
    blocks = "\n".join(f"  x{i}: {{type: axis, task: servo}}\n  feed{i}: {{type: MC_MoveVelocity, task: servo, Axis: x{i}, "
                       f"Velocity: {1 + i} mm/s, Execute: true}}" for i in range(SIGNALS // 4))
    registers = ", ".join(f"{2 * i}: x{i}.position" for i in range(REGISTERS // 2))
    return f"""lineshaft: 1
tasks: {{servo: {{every: 1 ms}}}}
blocks:
{blocks}
  counter: {{type: ctu, task: servo, cu: false, pv: inputs.level}}
inputs: {{level: 0}}
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


def start(command, folder, seconds, realtime=()):
    """The process and its ports, once it serves."""
    ports = 18080, 11502
    process = subprocess.Popen(
        [command, "serve", "program.yaml", "--http", f"127.0.0.1:{ports[0]}", "--modbus", f"127.0.0.1:{ports[1]}",
         "--json", "--allow-write", "--token-file", "token.txt", "--for", f"{seconds} s", *realtime], cwd=folder,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while (line := process.stderr.readline()) and not line.startswith("serving "):
        print(line, end="", file=sys.stderr)
    return process, *ports


def serve(command, folder, seconds, priority, clients):
    realtime = ["--realtime", str(priority)] if priority else []
    process, http_port, modbus_port = start(command, folder, seconds, realtime)
    names = [f"x{i}.{port}" for i in range(SIGNALS // 4)
             for port in ("position", "velocity", "acceleration", "enable")]
    ends, lost, count = threading.Event(), {}, {}
    threads = [threading.Thread(target=page, args=(http_port, names, ends, lost), daemon=True)
               for _ in range(8 if clients else 0)]
    threads += [threading.Thread(target=poll, args=(modbus_port, ends, count), daemon=True) for _ in range(4 if clients else 0)]
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


def crowd(http_port, modbus_port, ends):
    """64 clients of Modbus that say nothing, 200 of HTTP that send a byte now and then; of those who had to go ten come
    again each time."""
    idle = [socket.create_connection(("127.0.0.1", modbus_port)) for _ in range(64)]
    slow = [begun(http_port) for _ in range(200)]
    while not ends.wait(0.05):
        gone = [client for client in slow if not has_sent(client)]
        for client in gone[:10]:
            client.close()
            slow.remove(client)
            slow.append(begun(http_port))
    for client in idle + slow:
        client.close()


def begun(port):
    """Does not wait until somebody takes it."""
    client = socket.socket()
    client.setblocking(False)
    client.connect_ex(("127.0.0.1", port))
    return client


def has_sent(client):
    try:
        return client.send(b"G") == 1
    except OSError:
        return False


def owner(http_port, modbus_port, ends):
    """How long each answer takes [s], by HTTP with the token and by Modbus, on a new connection each time."""
    times = []
    while not ends.wait(0.02):
        begun = time.perf_counter()
        connection = http.client.HTTPConnection("127.0.0.1", http_port, timeout=20)
        connection.request("POST", "/api/set", json.dumps({"inputs.level": len(times)}), {"Authorization": "Bearer " + TOKEN})
        assert connection.getresponse().status == 200
        connection.close()
        times.append(time.perf_counter() - begun)
        begun = time.perf_counter()
        with socket.create_connection(("127.0.0.1", modbus_port), timeout=20) as client:
            client.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, 4, 0, 2))
            assert client.recv(1000)
        times.append(time.perf_counter() - begun)
    return times


def owner_beside(command, folder, seconds, realtime, is_crowded):
    """Lateness of the scans [us] and times of the owner's answers [s]."""
    process, *ports = start(command, folder, 1000 * seconds, realtime)
    ends = threading.Event()
    others = multiprocessing.Process(target=crowd, args=(*ports, goes := multiprocessing.Event()))
    if is_crowded:
        others.start()
    threading.Timer(seconds, ends.set).start()
    times = owner(*ports, ends)
    goes.set()
    process.terminate()
    out, errors = process.communicate()
    assert process.returncode == 0, errors
    if is_crowded:
        others.join()
    return json.loads(out)["serving"]["tasks"][0]["lateness_us"], sorted(times)


def crowds(command, folder, seconds, priority, rounds=3):
    """Without and with a crowd in turn, so that what else the machine does falls on both."""
    realtime = ["--realtime", str(priority)] if priority else []
    late = {False: [], True: []}
    for _ in range(rounds):
        for is_crowded in (False, True):
            lateness, times = owner_beside(command, folder, seconds, realtime, is_crowded)
            late[is_crowded].append(lateness)
            print(f"{'264 clients' if is_crowded else 'the owner  '}  " +
                  "  ".join(f"{name} {value:8.1f} us" for name, value in lateness.items()) +
                  f"  owner answered {len(times)} times: median {times[len(times) // 2] * 1e3:.1f} ms, "
                  f"p99 {times[int(len(times) * 0.99)] * 1e3:.1f} ms, greatest {times[-1] * 1e3:.1f} ms", flush=True)
    for name in late[False][0]:
        without, beside = (sorted(each[name] for each in late[crowded])[rounds // 2] for crowded in (False, True))
        print(f"lateness {name}, median of {rounds}: {beside:.1f} us beside 264 clients, {without:.1f} us without, "
              f"ratio {beside / without:.2f}")


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    priority = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "program.yaml").write_text(program(), encoding="utf-8")
        token = pathlib.Path(folder) / "token.txt"
        token.write_text(TOKEN + "\n", encoding="ascii")
        token.chmod(0o600)
        for clients in (False, True):
            beside_bare_loop(command, folder, seconds, priority, clients)
        crowds(command, folder, seconds, priority)


if __name__ == "__main__":
    main()
