#!/usr/bin/python3
"""`lineshaft serve` and real clients: urllib, curl, pymodbus, bare sockets; more of Modbus is in modbus.py. Nothing here
is a matter of time: how well the clock is kept is measured by tools/bench/serve.py.

usage: serve.py LINESHAFT SOURCE_DIR [RECORDINGS [SEED]]        so many random recordings are played back
"""

import http.client
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

from pymodbus.client import ModbusTcpClient

PROGRAM = """lineshaft: 1
title: A random line
tasks:
  servo: {every: 2 ms, priority: 26, jitter: 0.3 ms}
  main: {every: 5 ms, priority: 1, cost: 1 ms, cost_jitter: 50 %}
  event: {on: [inputs.go], priority: 30}
blocks:
  shaft: {type: axis, task: servo}
  slave: {type: axis, task: servo, default_acceleration: 5000 mm/s^2}
  feed: {type: MC_MoveVelocity, task: servo, Axis: shaft, Velocity: 100 mm/s, Execute: inputs.go}
  gear:
    type: MC_GearIn
    task: servo
    Master: shaft
    Slave: slave
    RatioNumerator: inputs.ratio
    ContinuousUpdate: true
    Execute: true
  late: {type: ton, task: main, in: inputs.go, pt: 20 ms}
  counter: {type: ctu, task: event, cu: inputs.count, pv: 5}
  channel: {type: pto, task: main, start_rate: 1 kHz, count: 40, execute: late.q}
inputs: {go: false, count: false, ratio: 1.5}
stimulus: [{at: 30 ms, set: {inputs.count: true}}]
force: [{from: 100 ms, until: 150 ms, set: {gear.RatioNumerator: 3}}]
modbus:
  coils: {5: {signal: inputs.go, write: true}, 6: {signal: inputs.count, write: true}}
  discrete_inputs: {0: late.q}
  holding_registers:
    10: {signal: inputs.ratio, type: real32, write: true}
    12: {signal: shaft.position, type: real64, words: low_first}
    20: {signal: inputs.ratio, type: int16, scale: 0.01}
  input_registers: {0: counter.cv}
run: {for: 1 s}
trace: {task: servo, signals: [shaft.position, slave.position, slave.velocity, late.q, counter.cv, inputs.ratio]}
"""


TOKEN = "0123456789abcdef0123456789abcdef"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class NotServed(AssertionError):
    """The command has ended before it served."""

    def __init__(self, code, said):
        super().__init__(code, said)
        self.code, self.said = code, said


class Machine:
    """A served program; its clients' answers are checked to be JSON."""

    def __init__(self, *options, program="program.yaml", write=True, host="127.0.0.1", limits=(), as_other=False):
        def limit():
            for kind, value in limits:
                resource.setrlimit(kind, (value, value))

        other = {"user": 65534, "group": 65534, "extra_groups": []} if as_other and os.geteuid() == 0 else {}
        self.host, self.port, self.modbus_port = host, free_port(), free_port()
        self.process = subprocess.Popen(
            [COMMAND, "serve", program, "--http", f"{host}:{self.port}", "--modbus", f"{host}:{self.modbus_port}",
             *(["--allow-write"] if write else []), *options],
            cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=limit if limits else None,
            **other)
        said = ""
        while (line := self.process.stderr.readline()) and not line.startswith("serving "):
            said += line  # a warning
        if not line:
            said += self.process.communicate(timeout=30)[1]
            raise NotServed(self.process.returncode, said)

    def ask(self, path, body=None, headers=None, method=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://{self.host}:{self.port}{path}", data, headers or {}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=20) as response:
                return response.status, json.loads(response.read())
        except urllib.error.HTTPError as error:
            return error.code, json.loads(error.read())

    def get(self, path):
        status, answer = self.ask(f"/api/{path}")
        assert status == 200, answer
        return answer

    def post(self, path, body=None):
        status, answer = self.ask(f"/api/{path}", {} if body is None else body)
        assert status == 200, answer
        return answer

    def value(self, name):
        return self.get(f"values?signals={name}")["values"][name]

    def modbus(self):
        client = ModbusTcpClient(self.host, port=self.modbus_port, timeout=20)
        assert client.connect()
        return client

    def end(self, how=signal.SIGINT):
        self.process.send_signal(how)
        out, errors = self.process.communicate(timeout=30)
        return self.process.returncode, out, errors


def run(*arguments):
    return subprocess.run([COMMAND, *arguments], cwd=FOLDER, capture_output=True, text=True, timeout=120)


def eventually(holds):
    for _ in range(2000):
        if holds():
            return
        time.sleep(0.005)
    raise AssertionError("did not come")


def scans_of(state, task):
    return next(each["scans"] for each in state["pace"]["tasks"] if each["name"] == task)


def check_api():
    machine = Machine()
    assert not machine.get("state")["paused"]
    signals = {each["name"]: each for each in machine.get("signals")}
    assert signals["shaft.position"] == {"name": "shaft.position", "type": "real", "unit": "mm", "settable": False,
                                         "traced": True}
    assert signals["inputs.go"]["settable"]
    machine.post("pause")
    before = machine.get("state")
    assert before["paused"]
    after = machine.post("step", {"scans": 7, "task": "servo"})
    assert after["paused"] and scans_of(after, "servo") == scans_of(before, "servo") + 7, (before, after)
    goal = after["time_ns"] + 40_000_000
    machine.post("run_until", {"time": f"{goal} ns"})
    eventually(lambda: machine.get("state")["paused"])
    assert machine.get("state")["time_ns"] == goal
    machine.post("run_until", {"time": goal / 1e9 + 1 / 3})
    eventually(lambda: machine.get("state")["paused"])
    goal += 333_333_333
    assert machine.get("state")["time_ns"] == goal, "a number of seconds: the nearest nanosecond"
    assert machine.post("set", {"inputs.go": True, "inputs.ratio": 2})["time_ns"] == goal + 1
    machine.post("resume")
    eventually(lambda: machine.value("inputs.go") is True)
    eventually(lambda: machine.value("shaft.velocity") > 0)
    machine.post("force", {"gear.RatioNumerator": 0.5, "shaft.velocity": "1 cm/s"})
    eventually(lambda: machine.value("shaft.velocity") == 10)
    forced = machine.get("state")["forced"]
    assert forced == {"gear.RatioNumerator": "0.5", "shaft.velocity": "10 mm/s"}, forced
    machine.post("release", {"signals": ["gear.RatioNumerator", "shaft.velocity"]})
    eventually(lambda: machine.get("state")["forced"] == {} and machine.value("shaft.velocity") != 10)
    machine.post("speed", {"speed": "max"})
    eventually(lambda: machine.get("state")["time_s"] > 10)
    code, _, errors = machine.end()
    assert code == 0, errors


def check_refusals():
    machine = Machine()
    for path, body, words in [
        ("set", {"inputs.gp": True}, "no input 'gp'"),
        ("set", {"inputs.go": 2}, "2"),
        ("set", {"shaft.position": 2}, "is an output"),
        ("set", {"gear.RatioNumerator": 2}, "is wired"),
        ("set", {"inputs.go": [[]]}, "expected"),
        ("set", [], "expected"),
        ("force", {"shaft.velocity": "1 kg"}, "kg"),
        ("release", {"signals": "x"}, "expected"),
        ("step", {"scans": 0}, "'scans'"),
        ("step", {"task": "none"}, "task"),
        ("speed", {"speed": -1}, "speed"),
        ("run_until", {"time": "soon"}, "soon"),
        ("run_until", {"time": 1e300}, "time"),
        ("run_until", {"time": True}, "expected a time"),
        ("run_until", {"time": 0}, "has been: the machine is at"),
    ]:
        status, answer = machine.ask(f"/api/{path}", body)
        assert status == 400 and words in json.dumps(answer), (path, body, answer)
    assert machine.ask("/api/values?signals=shaft.positon")[0] == machine.ask("/api/values?signals=%ff")[0] == 400
    assert machine.ask("/api/nothing")[0] == 404
    assert machine.ask("/etc/passwd")[0] == machine.ask("/../../etc/passwd")[0] == 404
    assert machine.ask("/api/state", {})[0] == 405
    assert machine.ask("/api/state", headers={"Range": "bytes=0-9"})[0] == 200  # and whole: it is JSON
    for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
        assert machine.ask("/api/state", headers=headers)[0] == 403
        assert machine.ask("/api/set", {"inputs.go": True}, headers=headers)[0] == 403
    document = machine.get("openapi.json")
    assert document == json.loads(run("serve", "--openapi", "program.yaml").stdout)
    for path, methods in document["paths"].items():
        for method in methods:
            if path not in ("/api/stream", "/api/checkpoint"):
                assert machine.ask(path, {} if method == "post" else None)[0] in (200, 400), path
    connection = http.client.HTTPConnection("127.0.0.1", machine.port, timeout=20)
    connection.request("POST", "/api/set", b"x" * 100_000)
    assert connection.getresponse().status == 413
    curl = subprocess.run(["curl", "-s", "-d", "{", f"http://127.0.0.1:{machine.port}/api/set"], capture_output=True,
                          text=True, timeout=20)
    assert "not JSON" in curl.stdout
    second = run("serve", "program.yaml", "--http", f"127.0.0.1:{machine.port}")
    assert second.returncode == 2 and "L0510" in second.stderr and "another port" in second.stderr, second.stderr
    third = run("serve", "program.yaml", "--http", "off", "--allow-write")
    assert third.returncode == 2 and "L0512" in third.stderr, third.stderr
    for address in ("127.0.0.1", "nowhere:80", "127.0.0.1:0", "127.0.0.1:70000"):
        assert run("serve", "program.yaml", "--http", address).returncode == 2
    assert machine.end()[0] == 0
    reader = Machine(write=False)
    status, answer = reader.ask("/api/set", {"inputs.go": True})
    assert status == 403 and "--allow-write" in answer["help"]
    assert reader.modbus().write_coil(5, True).exception_code == 1
    assert reader.value("inputs.go") is False
    assert reader.end()[0] == 0


def check_privileges():
    """Ports below 1024 and real time are for root: who is somebody else is told what to do."""
    if os.geteuid() == 0:
        done = run("serve", "program.yaml", "--http", f"127.0.0.1:{free_port()}", "--for", "20 ms", "--realtime", "50")
        assert done.returncode == 0 or "L0511" in done.stderr, done.stderr  # a container may forbid it to root, too
    os.chmod(FOLDER, 0o755)
    other = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
    here = ["--http", f"127.0.0.1:{free_port()}"]
    for options, words in ((["--realtime", "50", *here], ["L0511", "setcap"]),
                           (["--http", "127.0.0.1:80"], ["L0510", "for root"])):
        try:
            refused = subprocess.run([COMMAND, "serve", "program.yaml", "--for", "20 ms", *options], cwd=FOLDER,
                                     capture_output=True, text=True, timeout=20, **other)
        except PermissionError:
            print("SKIPPED: messages for who is not root, who cannot read the command here")
            return
        if refused.returncode == 0:
            print(f"SKIPPED: message of {options[0]}: it is allowed here")
        else:
            assert refused.returncode == 2 and all(word in refused.stderr for word in words), refused.stderr


def check_capture():
    """tshark finds nothing malformed in what goes over the wires."""
    if not shutil.which("tshark"):
        print("SKIPPED: tshark; tools/setup --tests installs it")
        return
    machine = Machine()
    shark = ["tshark", "-n", "-d", f"tcp.port=={machine.modbus_port},mbtcp", "-d", f"tcp.port=={machine.port},http"]
    capturing = subprocess.Popen(shark[:2] + ["-i", "lo", "-w", "capture.pcapng", "-f",
                                              f"tcp port {machine.modbus_port} or tcp port {machine.port}"],
                                 cwd=FOLDER, stderr=subprocess.PIPE, text=True)
    while (line := capturing.stderr.readline()) and "Capture started" not in line:
        pass
    if not line:
        print("SKIPPED: tshark may not capture here")
    client = machine.modbus()
    for address in range(30):
        client.read_holding_registers(address, 4)
        client.read_coils(address, 2)
        client.write_coil(address, True)
        client.write_registers(10, [0x4000 + address, 0])
        client.readwrite_registers(read_address=10, read_count=2, write_address=10, write_registers=[0x4000, 0])
        client.mask_write_register(20, 1, 2)
        machine.get("values")
        machine.ask("/api/nothing")
    time.sleep(0.5)
    capturing.send_signal(signal.SIGINT)
    capturing.wait(20)
    assert machine.end()[0] == 0

    read = subprocess.run([*shark, "-r", "capture.pcapng", "-T", "fields", "-e", "frame.protocols"], cwd=FOLDER,
                          capture_output=True, text=True, timeout=300)
    frames, answers, malformed = (read.stdout.count(what) for what in ("mbtcp", ":http", "malformed"))
    if line:
        assert frames >= 360 and answers >= 60 and malformed == 0, (frames, answers, malformed)
        print(f"tshark: {frames} frames of Modbus/TCP and {answers} of HTTP, 0 malformed")


def check_stream():
    machine = Machine("--speed", "10")
    connection = http.client.HTTPConnection("127.0.0.1", machine.port, timeout=20)
    connection.request("GET", "/api/stream?signals=shaft.position,late.q&every=4ms")
    response = connection.getresponse()
    seen = {}
    while seen.get("rows", 0) < 200:
        event = response.readline().decode().strip().removeprefix("event: ")
        data = json.loads(response.readline().decode().removeprefix("data: "))
        response.readline()
        if event == "rows":
            times = data["time"]
            assert all(len(column) == len(times) for column in data["values"])
            assert times == sorted(set(times)) and (not times or times[0] > seen.get("last", -1))
            seen["rows"] = seen.get("rows", 0) + len(times)
            seen["last"] = times[-1] if times else seen.get("last", -1)
        elif event == "signals":
            assert [each["name"] for each in data] == ["shaft.position", "late.q"]
        else:
            assert event == "state" and data["speed"] == 10
    slow = [http.client.HTTPConnection("127.0.0.1", machine.port, timeout=20) for _ in range(3)]
    for each in slow:
        each.request("GET", "/api/stream?signals=shaft.position")  # and it reads nothing
    scans = scans_of(machine.get("state"), "servo")
    eventually(lambda: scans_of(machine.get("state"), "servo") > scans + 100)
    page = urllib.request.urlopen(f"http://127.0.0.1:{machine.port}/", timeout=20).read().decode()
    assert "uPlot" in page and not re.search(r"(src|href)=.https?:", page)
    assert machine.end()[0] == 0


class Watch:
    """Counts a task's scans by a stream, which needs no further connection."""

    def __init__(self, machine, task):
        self.response = http.client.HTTPConnection("127.0.0.1", machine.port, timeout=20)
        self.response.request("GET", "/api/stream?signals=inputs.ratio&every=1s")
        self.response, self.task = self.response.getresponse(), task

    def scans(self):
        while (line := self.response.readline()) != b"event: state\n":
            if not line:
                raise ConnectionError
        return scans_of(json.loads(self.response.readline().removeprefix(b"data: ")), self.task)


def check_streams_end():
    """A stream ends with its machine, and says nothing but what it is to say."""
    for _ in range(3):
        machine = Machine("--speed", "max", "--for", "100 h")
        watches = []
        for _ in range(20):
            watches.append(Watch(machine, "servo"))
            time.sleep(0.02)  # each is told the state at its own moments
        machine.process.send_signal(signal.SIGINT)
        for watch in watches:
            try:
                while True:
                    watch.scans()
            except (OSError, http.client.HTTPException):
                pass
        assert machine.end()[0] == 0


def begun_connection(port):
    """Does not wait until somebody takes it."""
    client = socket.socket()
    client.setblocking(False)
    client.connect_ex(("127.0.0.1", port))
    return client


def send_some(client):
    """Half a request, and no more."""
    try:
        client.sendall(b"\0\1\0\0\0")
        client.shutdown(socket.SHUT_WR)
    except OSError:
        pass  # it was not taken


def connected(port):
    return socket.create_connection(("127.0.0.1", port), timeout=20)


def answered(client):
    """All that comes until the other side ends; empty when it ends by a reset."""
    got = b""
    try:
        while part := client.recv(65536):
            got += part
    except ConnectionError:
        pass
    return got


def head(lines, path="/api/state"):
    return f"GET {path} HTTP/1.1\r\nHost: localhost\r\n".encode() + b"".join(lines)


def status_of(answer):
    return int(answer[9:12]) if answer.startswith(b"HTTP/1.1 ") else None


def exchange(port, request):
    """What is answered to bytes after which no more come; empty when the other side ends it."""
    try:
        with connected(port) as client:
            client.sendall(request)
            client.shutdown(socket.SHUT_WR)
            return answered(client)
    except TimeoutError:
        raise
    except OSError:
        return b""


def ask_raw(port, request):
    """The status; None when the connection was ended without one."""
    return status_of(exchange(port, request))


def resident(process):
    """Memory in MB."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


def check_hostile():
    machine = Machine()
    watch = Watch(machine, "servo")
    eventually(lambda: watch.scans() > 10)
    before = resident(machine.process)
    lines = [f"X-{k}: 1\r\n".encode() for k in range(98)]
    assert ask_raw(machine.port, head(lines) + b"\r\n") == 200
    assert ask_raw(machine.port, head(lines + [b"Y: 1\r\n"] * 3) + b"\r\n") in (400, None)
    assert ask_raw(machine.port, head([b"X: " + b"x" * 7000 + b"\r\n"] * 3) + b"\r\n") in (400, None)
    assert ask_raw(machine.port, head([b"X: " + b"x" * 10_000_000 + b"\r\n\r\n"])) in (400, None)
    assert ask_raw(machine.port, head([b"X: x\r\n"] * 1_700_000 + [b"\r\n"])) in (400, None)
    assert ask_raw(machine.port, head([b"\r\n"], "/" + "x" * 8000)) in (404, 414)
    assert ask_raw(machine.port, b"x" * 10_000_000) in (400, 414, None)
    drops = [connected(machine.port) for _ in range(5)] + [connected(machine.modbus_port)]
    until = time.monotonic() + 6
    while time.monotonic() < until:
        scans = watch.scans()
        for client in drops:
            try:
                client.sendall(b"G")
            except ConnectionError:
                pass
    assert all(status_of(answered(client)) in (400, None) for client in drops)  # ended by the machine, not by us
    flood = [begun_connection(port) for port in [machine.port] * 300 + [machine.modbus_port] * 60]
    for client in flood[::3]:
        send_some(client)
    assert watch.scans() > scans
    scans = watch.scans()
    eventually(lambda: watch.scans() > scans + 100)
    for client in flood:
        client.close()
    eventually(lambda: ask_raw(machine.port, head([b"Connection: close\r\n\r\n"])) == 200)
    assert resident(machine.process) < before + 20, (before, resident(machine.process))
    eventually(lambda: reads_coil(machine.modbus_port))
    code, _, errors = machine.end()
    assert code == 0, errors


def reads_coil(port):
    answer = exchange(port, struct.pack(">HHHBBHH", 7, 0, 6, 1, 1, 5, 1))
    return answer == struct.pack(">HHHBBBB", 7, 0, 4, 1, 1, 1, 0)


def check_limits():
    machine = Machine()
    streams = [Watch(machine, "servo") for _ in range(16)]
    assert machine.ask("/api/stream?signals=late.q")[0] == 503
    streams.pop().response.close()
    eventually(lambda: status_of(first_of(machine.port, "/api/stream?signals=late.q")) == 200)
    client = connected(machine.port)
    threading.Thread(target=client.sendall, args=(head([b"\r\n"], "/api/nothing") * 3000,), daemon=True).start()
    eventually(lambda: b"HTTP/1.1 429" in client.recv(65536))
    assert machine.end()[0] == 0


def first_of(port, path):
    with connected(port) as client:
        client.sendall(head([b"\r\n"], path))
        return client.recv(1000)


def own_address():
    """Of this machine, not the loopback's; None where there is none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return None
        address = probe.getsockname()[0]
    return None if address.startswith("127.") else address


def check_other_addresses():
    """Who comes by another address than the loopback's counts as another machine."""
    address = own_address()
    if not address:
        print("SKIPPED: writing from another address: this machine has none")
        return
    (FOLDER / "token").write_text("0123456789abcdef\n", encoding="ascii")
    os.chmod(FOLDER / "token", 0o600)
    machine = Machine("--token-file", "token", host=address)
    assert machine.ask("/api/state")[0] == 200
    for headers, status in (({}, 403), ({"Authorization": "Bearer 0123456789abcdeF"}, 403),
                            ({"Authorization": "0123456789abcdef"}, 403),
                            ({"Authorization": "Bearer 0123456789abcdef"}, 200)):
        assert machine.ask("/api/set", {"inputs.go": True}, headers)[0] == status, headers
    assert machine.modbus().write_coil(5, True).exception_code == 1
    assert machine.end()[0] == 0
    short = FOLDER / "short"
    short.write_text("0123456789abcde\n", encoding="ascii")
    assert "L0514" in run("serve", "program.yaml", "--token-file", "short").stderr


def write_at_random(machine, rng, until):
    """A client that does what it likes."""
    client = machine.modbus()
    while time.monotonic() < until:
        ratio, flag = round(rng.uniform(0.1, 3), 3), rng.random() < 0.5
        rng.choice([
            lambda: machine.post("set", {"inputs.go": flag, "inputs.ratio": ratio}),
            lambda: machine.post("set", {"inputs.count": flag}),
            lambda: machine.post("force", {"gear.RatioNumerator": ratio}),
            lambda: machine.post("force", {"shaft.velocity": f"{ratio} cm/s", "late.q": flag}),
            lambda: machine.post("release", {"signals": ["gear.RatioNumerator"]}),
            lambda: machine.post("release", {"signals": ["shaft.velocity", "late.q"]}),
            lambda: machine.post("pause"), lambda: machine.post("resume"), lambda: machine.post("resume"),
            lambda: machine.post("step", {"scans": rng.randrange(1, 20)}),
            lambda: machine.post("speed", {"speed": rng.choice([0.3, 1, 5, 30])}),
            lambda: client.write_coil(5, flag), lambda: client.write_coil(6, flag),
            lambda: client.write_registers(10, list(struct.unpack(">HH", struct.pack(">f", ratio)))),
        ])()
        time.sleep(rng.random() * 0.01)
    client.close()


def check_recordings(count, seed):
    rng = random.Random(seed)
    entries = 0
    for number in range(count):
        machine = Machine("--trace", "live.csv", "--record", "live.yaml", "--speed", rng.choice(["0.5", "1", "10"]),
                          "--late", rng.choice(["skip", "catch_up"]))
        until = time.monotonic() + 0.7
        writers = [threading.Thread(target=write_at_random, args=(machine, random.Random(rng.random()), until))
                   for _ in range(3)]
        for writer in writers:
            writer.start()
        for writer in writers:
            writer.join()
        code, out, errors = machine.end()
        assert code == 0, (seed, number, errors)
        again = run("run", "program.yaml", "--recording", "live.yaml", "--trace", "again.csv")
        assert again.returncode == 0, (seed, number, again.stderr)
        for live, played in (("live.csv", "again.csv"), ("live.events.csv", "again.events.csv")):
            lines, others = ((FOLDER / name).read_text().splitlines() for name in (live, played))
            assert lines == others, (seed, number, live, len(lines), len(others), set(lines) ^ set(others))
        entries += (FOLDER / "live.yaml").read_text().count("\n- ")
    print(f"{count} recordings of {entries} entries played back to the same bytes, seed {seed}")


def check_checkpoint(seed):
    """Gone on from a checkpoint, a machine leaves the bytes that it left by going on itself."""
    rng = random.Random(seed)
    files = ("--trace", "live.csv", "--record", "live.yaml", "--for", "60 s")
    machine = Machine(*files)
    until = time.monotonic() + 0.5
    write_at_random(machine, rng, until)
    machine.post("pause")
    machine.post("set", {"inputs.go": True})
    machine.post("force", {"gear.RatioNumerator": 0.5, "shaft.velocity": "3 cm/s"})
    request = urllib.request.Request(f"http://127.0.0.1:{machine.port}/api/checkpoint", b"")
    with urllib.request.urlopen(request, timeout=20) as response:
        (FOLDER / "at.checkpoint").write_bytes(response.read())
    machine.post("speed", {"speed": "max"})
    machine.post("resume")
    assert machine.process.wait(30) == 0
    wanted = [(FOLDER / name).read_bytes() for name in ("live.csv", "live.events.csv", "live.yaml")]
    killed = Machine(*files, "--resume", "--checkpoint", "at.checkpoint")
    killed.post("set", {"inputs.ratio": 0.25})
    killed.end(signal.SIGKILL)
    again = Machine(*files, "--resume", "--checkpoint", "at.checkpoint", "--speed", "max")
    assert again.process.wait(30) == 0, again.process.stderr.read()
    for name, bytes_ in zip(("live.csv", "live.events.csv", "live.yaml"), wanted):
        assert (FOLDER / name).read_bytes() == bytes_, (seed, name)
    assert run("run", "program.yaml", "--recording", "live.yaml", "--trace", "again.csv").returncode == 0
    assert (FOLDER / "again.csv").read_bytes() == wanted[0], seed
    (FOLDER / "live.yaml").unlink()
    lost = run("serve", "program.yaml", *files, "--resume", "--checkpoint", "at.checkpoint", "--http", "off")
    assert lost.returncode == 2 and "L0512" in lost.stderr, lost.stderr
    of_serve = run("run", "program.yaml", "--resume", "--checkpoint", "at.checkpoint")
    assert of_serve.returncode == 2 and "the checkpoint is of 'serve'" in of_serve.stderr and "'serve' goes on from what it wrote" in of_serve.stderr, of_serve.stderr
    other = run("serve", "program.yaml", "--resume", "--checkpoint", "at.checkpoint", "--http", "off")
    assert other.returncode == 2 and "--record" in other.stderr, other.stderr


class Writer(threading.Thread):
    """Sets a signal of its own to 1, 2, 3... until the machine is gone, and keeps what was acknowledged."""

    def __init__(self, machine, number):
        super().__init__()
        self.machine, self.number, self.kept = machine, number, 0
        self.start()

    def run(self):
        try:
            self.write_by_modbus() if self.number % 2 else self.write_by_http()
        except (OSError, http.client.HTTPException):
            pass  # it was killed

    def write_by_http(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.machine.port, timeout=20)
        while True:
            connection.request("POST", "/api/set", json.dumps({f"inputs.w{self.number}": self.kept + 1}))
            response = connection.getresponse()
            response.read()
            assert response.status == 200, response.status
            self.kept += 1

    def write_by_modbus(self):
        client = connected(self.machine.modbus_port)
        while True:
            request = struct.pack(">HHHBBHH", 1, 0, 6, 1, 6, self.number, self.kept + 1)
            client.sendall(request)
            answer = client.recv(100)
            if not answer:
                return
            assert answer == request, answer
            self.kept += 1


def check_kills(count, seed):
    """Whenever a machine is killed, its recording has all that it has acknowledged, and is played back."""
    rng = random.Random(seed)
    names = [f"w{number}" for number in range(8)]
    registers = ", ".join(f"{k}: {{signal: inputs.{name}, type: uint16, write: true}}" for k, name in enumerate(names))
    (FOLDER / "kept.yaml").write_text(
        "lineshaft: 1\ntasks: {main: {every: 2 ms}}\ninputs: {" + ", ".join(f"{name}: 0" for name in names) + "}\n"
        "blocks: {late: {type: ton, task: main, in: true, pt: 1 s}, "
        "counter: {type: ctu, task: main, cu: late.q, pv: inputs.w0}}\n"
        f"modbus: {{holding_registers: {{{registers}}}}}\nrun: {{for: 1 s}}\n", encoding="utf-8")
    acknowledged = 0
    for number in range(count):
        for old in FOLDER.glob("killed*.yaml"):
            old.unlink()
        machine = Machine("--record", "killed.yaml", "--record-sync", rng.choice(["each", "10 ms", "none"]),
                          program="kept.yaml")
        writers = [Writer(machine, k) for k in range(8)]
        time.sleep(rng.random() * 0.3)
        machine.end(signal.SIGKILL)
        for writer in writers:
            writer.join()
        text = (FOLDER / "killed.yaml").read_text(encoding="ascii")
        whole = text[:text.rfind("\n") + 1]
        for writer in writers:
            found = set(map(int, re.findall(rf"inputs\.w{writer.number}: (\d+)}}", whole)))
            missing = set(range(1, writer.kept + 1)) - found
            assert not missing, (seed, number, writer.number, missing)
            acknowledged += writer.kept
        again = run("run", "kept.yaml", "--recording", "killed.yaml", "--json")
        assert again.returncode == 0, (seed, number, again.stderr)
        last = re.findall(r"at: ([0-9.]+) s", whole) or ["0"]
        assert abs(json.loads(again.stdout)["machine_time_s"] - float(last[-1])) < 1e-12, (seed, number)
    print(f"{count} machines killed with 8 writers, {acknowledged} writes acknowledged, 0 of them missing, seed {seed}")


def check_kept():
    """A recording of a machine that was killed stays; what is no recording, too; a full disk is told."""
    files = ("--record", "mine.yaml")
    for number in range(2):
        machine = Machine(*files)
        machine.post("set", {"inputs.ratio": 2 + number})
        assert machine.get("state")["recording"] == {"file": "mine.2.yaml" if number else "mine.yaml", "error": None}
        machine.end(signal.SIGKILL)
    third = Machine(*files)
    assert third.get("state")["recording"]["file"] == "mine.3.yaml"
    assert third.end(signal.SIGHUP)[0] == 0
    again = Machine(*files)
    assert again.get("state")["recording"]["file"] == "mine.3.yaml", "that one had ended"
    again.end()
    assert "ratio: 2" in (FOLDER / "mine.yaml").read_text() and "ratio: 3" in (FOLDER / "mine.2.yaml").read_text()
    (FOLDER / "notes.txt").write_text("my notes\n")
    other = run("serve", "program.yaml", "--allow-write", "--record", "notes.txt", "--http", "off")
    assert other.returncode == 2 and "L0512" in other.stderr and (FOLDER / "notes.txt").read_text() == "my notes\n"

    machine = Machine("--record", "full.yaml", limits=[(resource.RLIMIT_FSIZE, 2000)])
    client, kept = machine.modbus(), 0
    while (answer := machine.ask("/api/set", {"inputs.ratio": kept + 1}))[0] == 200:
        kept += 1
    assert answer[0] == 507 and "L0512" == answer[1]["code"], answer
    assert client.write_coil(5, True).exception_code == 4
    assert "full.yaml" in machine.get("state")["recording"]["error"]
    assert machine.get("values")["values"]["inputs.go"] is False, "what is refused is not carried out"
    code, _, errors = machine.end()
    assert code == 3 and "full.yaml" in errors, errors
    text = (FOLDER / "full.yaml").read_text()
    assert all(f"inputs.ratio: {value}}}" in text for value in range(1, kept + 1)), (kept, text)


def check_retained():
    """A recording keeps the retained values that the machine began with; a client's value that a port cannot hold is refused."""
    (FOLDER / "own.st").write_text("""PROGRAM Main
VAR_INPUT n : INT; END_VAR
VAR_OUTPUT RETAIN total : DINT; END_VAR
total := total + n;
END_PROGRAM
""")
    (FOLDER / "own.yaml").write_text("""lineshaft: 1
tasks: {main: {every: 10 ms}}
sources: own.st
blocks: {m: {type: Main, task: main, n: inputs.n}}
inputs: {n: 1}
modbus: {holding_registers: {0: {signal: inputs.n, type: int32, write: true}}}
run: {for: 1 s}
trace: {task: main, signals: [m.total]}
""")
    for trace in ("first.csv", "second.csv"):
        machine = Machine("--retain-file", "kept", "--record", "own.recording.yaml", "--trace", trace, program="own.yaml")
        machine.post("set", {"inputs.n": 3})
        status, answer = machine.ask("/api/set", {"inputs.n": 40000})
        assert status == 400 and answer["code"] == "L0305", answer
        client = machine.modbus()
        assert client.write_registers(0, [1, 0]).exception_code == 3
        assert not client.write_registers(0, [0, 5]).isError()
        assert machine.end()[0] == 0
    assert "retained: " in (FOLDER / "own.recording.yaml").read_text()
    again = run("run", "own.yaml", "--recording", "own.recording.yaml", "--trace", "again.csv")
    assert again.returncode == 0, again.stderr
    assert (FOLDER / "again.csv").read_bytes() == (FOLDER / "second.csv").read_bytes()


def check_types():
    """A value is one of the signal's type; a name may have any letters."""
    (FOLDER / "types.scl").write_text("""FUNCTION_BLOCK taker
VAR_INPUT single : REAL; large : ULINT; small : SINT; "größe" : INT; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
q := single > 1.0;
END_FUNCTION_BLOCK
""", encoding="utf-8")
    (FOLDER / "types.yaml").write_text("""lineshaft: 1
tasks: {main: {every: 1 ms}}
sources: [types.scl]
blocks: {fb: {type: taker, task: main}}
modbus: {coils: {0: fb.q}}
run: {for: 1 s}
""", encoding="utf-8")
    machine = Machine("--record", "types_recorded.yaml", program="types.yaml")
    for values, status in (({"fb.single": 1e300}, 400), ({"fb.single": -1e39}, 400), ({"fb.single": 1e38}, 200),
                           ({"fb.large": -1}, 400), ({"fb.large": 2**62}, 200), ({"fb.small": 128}, 400),
                           ({"fb.small": -128}, 200), ({"fb.größe": 7}, 200), ({"fb.größe": 40000}, 400)):
        answer = machine.ask("/api/set", values)
        assert answer[0] == status, (values, answer)
        assert machine.ask("/api/force", values)[0] == status, values
    eventually(lambda: machine.get("values?signals=fb.gr%C3%B6%C3%9Fe")["values"]["fb.größe"] == 7)
    assert machine.end()[0] == 0
    again = run("run", "types.yaml", "--recording", "types_recorded.yaml")
    assert again.returncode == 0, again.stderr


def check_protocol():
    """What HTTP says of methods, of bodies, of connections that stay."""
    machine = Machine("--audit", "audit.jsonl", "--token-file", "token.txt")
    assert machine.ask("/api/set", {"inputs.go": True}, {"Authorization": "beARer  " + TOKEN})[0] == 200
    assert machine.ask("/api/set", {"inputs.go": False}, {"Authorization": "Bearer wrong"})[0] == 403
    machine.modbus().write_coil(5, True)
    machine.modbus().write_coil(99, True)
    connection = http.client.HTTPConnection("127.0.0.1", machine.port, timeout=20)
    for method, path, status, allow in (("PUT", "/api/state", 405, "GET, HEAD"), ("DELETE", "/api/set", 405, "POST"),
                                        ("GET", "/api/set", 405, "POST"), ("OPTIONS", "/api/pause", 405, "POST"),
                                        ("HEAD", "/api/state", 200, None), ("HEAD", "/", 200, None),
                                        ("HEAD", "/api/stream", 200, None), ("HEAD", "/api/nothing", 404, None)):
        connection.request(method, path)
        response = connection.getresponse()
        body = response.read()
        assert (response.status, response.getheader("Allow")) == (status, allow), (method, path, response.status)
        assert method != "HEAD" or body == b"", (path, body)
        assert "frame-ancestors 'none'" in response.getheader("Content-Security-Policy")
    stays = int(re.search(r"timeout=(\d+)", response.getheader("Keep-Alive"))[1])
    assert stays > 2
    time.sleep(1.5)  # a second more than it stayed before
    connection.request("POST", "/api/pause")
    assert connection.getresponse().status == 200
    blanks = " " * (65536 - len('{"inputs.go": true}'))
    (FOLDER / "body").write_text('{"inputs.go": true}' + blanks)
    for options in ([], ["-H", "Expect: 100-continue"], ["-H", "Content-Type: application/json"]):
        curl = subprocess.run(["curl", "-s", "-d", "@body", *options, f"http://127.0.0.1:{machine.port}/api/set"],
                              cwd=FOLDER, capture_output=True, text=True, timeout=20)
        assert "time_ns" in curl.stdout, (options, curl.stdout)
    (FOLDER / "body").write_text('{"inputs.go": true}' + blanks + " ")
    curl = subprocess.run(["curl", "-s", "-o", "/dev/null", "-w", "%{http_code}", "-d", "@body",
                           f"http://127.0.0.1:{machine.port}/api/set"], cwd=FOLDER, capture_output=True, text=True, timeout=20)
    assert curl.stdout == "413", curl.stdout
    code, _, errors = machine.end(signal.SIGHUP)
    assert code == 0 and "127.0.0.1 has sent a wrong token" in errors, errors
    lines = [json.loads(line) for line in (FOLDER / "audit.jsonl").read_text().splitlines()]
    answers = [(line["by"], line["answer"].split()[0]) for line in lines]
    assert answers[:4] == [("HTTP", "200"), ("HTTP", "403"), ("Modbus", "done"), ("Modbus", "exception")], answers
    assert all(line["peer"] == "127.0.0.1" and line["date"].endswith("Z") for line in lines)
    assert '"inputs.go": true' in lines[0]["asked"] and lines[0]["time_ns"] > 0 and "time_ns" not in lines[1]
    os.chmod(FOLDER / "token.txt", 0o644)
    warned = run("serve", "program.yaml", "--token-file", "token.txt", "--http", "off", "--for", "10 ms")
    assert warned.returncode == 0 and "chmod 600" in warned.stderr, warned.stderr
    os.chmod(FOLDER / "token.txt", 0o600)


def check_owner():
    """With 64 idle clients of Modbus and 200 of HTTP that send byte by byte the owner is answered, each time."""
    machine = Machine("--token-file", "token.txt")
    idle = [connected(machine.modbus_port) for _ in range(64)]
    slow = [begun_connection(machine.port) for _ in range(200)]
    for number in range(40):
        for client in slow:
            try:
                client.send(b"G")
            except OSError:
                pass  # it had to go
        assert machine.ask("/api/set", {"inputs.ratio": 1 + number}, {"Authorization": "Bearer " + TOKEN})[0] == 200
        assert reads_coil(machine.modbus_port)
    for client in idle + slow:
        client.close()
    assert machine.end()[0] == 0


def check_memory(program, hours):
    """However long a machine is served, and whatever its clients want, it takes no more memory."""
    machine = Machine("--speed", "max", "--record", "long.yaml", program=program)
    sizes, scans, watch = [], 0, Watch(machine, "servo")
    while len(sizes) < 5 or scans < hours * 3600 * 500:  # of 2 ms
        machine.post("set", {"inputs.ratio": 1 + len(sizes) % 3})
        machine.post("force", {"inputs.ratio": 1 + len(sizes) % 2})
        machine.post("release", {"signals": ["inputs.ratio"]})
        scans = watch.scans()
        sizes.append(resident(machine.process))
    assert machine.end()[0] == 0
    assert sizes[-1] < sizes[1] + 2, sizes
    print(f"{hours} h and more with a client, {len(sizes)} rounds of what it wants: {sizes[1]:.1f} MB at first, {sizes[-1]:.1f} MB at the end")


def main():
    global COMMAND, FOLDER
    COMMAND, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    recordings = int(sys.argv[3]) if len(sys.argv) > 3 else 4
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**9)
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(folder)
        (FOLDER / "program.yaml").write_text(PROGRAM, encoding="utf-8")
        (FOLDER / "token.txt").write_text(TOKEN + "\n", encoding="ascii")
        os.chmod(FOLDER / "token.txt", 0o600)
        check_api()
        check_refusals()
        check_protocol()
        check_types()
        check_kept()
        check_retained()
        check_privileges()
        if recordings >= 100:
            check_capture()
        check_stream()
        check_streams_end()
        check_hostile()
        check_limits()
        check_owner()
        check_other_addresses()
        check_recordings(recordings, seed)
        check_checkpoint(seed)
        check_kills(2 * max(2, recordings), seed)
        check_memory(source / "programs" / "13_served_line.yaml", 24 if recordings >= 100 else 12)
    return 0


if __name__ == "__main__":
    sys.exit(main())
