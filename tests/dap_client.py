"""A client of the Debug Adapter Protocol over the streams of `lineshaft debug`."""

import json
import os
import queue
import subprocess
import threading


class Refused(Exception):
    pass


class Client:
    def __init__(self, lineshaft, *args, cwd=None):
        self.process = subprocess.Popen([lineshaft, "debug", *args], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, cwd=cwd)
        self.seq = 0
        self.messages = queue.Queue()
        self.events = []
        self.errors = []
        threading.Thread(target=self._read, daemon=True).start()
        threading.Thread(target=lambda: self.errors.extend(self.process.stderr), daemon=True).start()

    def _read(self):
        stream = self.process.stdout
        while True:
            length = None
            while (line := stream.readline()) not in (b"\r\n", b""):
                key, value = line.decode().split(":")
                if key.lower() == "content-length":
                    length = int(value)
            if length is None:
                self.messages.put(None)
                return
            self.messages.put(json.loads(stream.read(length)))

    def _next(self, wanted):
        message = self.messages.get(timeout=60)
        if message is None:
            raise AssertionError(f"no {wanted}: it ended; {b''.join(self.errors).decode()}")
        return message

    def request(self, command, **arguments):
        self.seq += 1
        body = json.dumps({"seq": self.seq, "type": "request", "command": command, "arguments": arguments}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()
        while True:
            message = self._next(command)
            if message["type"] == "event":
                self.events.append(message)
            elif message["request_seq"] == self.seq:
                if not message["success"]:
                    raise Refused(message["message"])
                return message.get("body", {})

    def event(self, name):
        """The body of the next event of that name; those before it are left out."""
        while True:
            while self.events:
                message = self.events.pop(0)
                if message["event"] == name:
                    return message.get("body", {})
            message = self._next(name)
            if message["type"] == "event":
                self.events.append(message)

    def launch(self, program=None, breakpoints=None, **arguments):
        """Up to the run's first stop or end. `breakpoints`: by path."""
        self.capabilities = self.request("initialize", adapterID="lineshaft", linesStartAt1=True)
        self.request("launch", **({"program": str(program)} if program else {}), **arguments)
        self.event("initialized")
        placed = {path: self.breakpoints(path, *lines) for path, lines in (breakpoints or {}).items()}
        self.request("setExceptionBreakpoints", filters=[])
        self.request("configurationDone")
        return placed

    def breakpoints(self, path, *lines):
        wanted = [line if isinstance(line, dict) else {"line": line} for line in lines]
        return self.request("setBreakpoints", source={"path": os.path.abspath(path)}, breakpoints=wanted)["breakpoints"]

    def step(self, command, thread=1, **arguments):
        """Why it stands still then."""
        self.request(command, threadId=thread, **arguments)
        return self.event("stopped")

    def stack(self, thread=1):
        return self.request("stackTrace", threadId=thread)["stackFrames"]

    def line(self, thread=1):
        top = self.stack(thread)[0]
        return top["name"], top["line"]

    def inside(self, reference, **page):
        return {v["name"]: v for v in self.request("variables", variablesReference=reference, **page)["variables"]}

    def scopes(self, frame):
        return {s["name"]: s["variablesReference"] for s in self.request("scopes", frameId=frame)["scopes"]}

    def value(self, scope, name, thread=1, frame=0):
        """Of a variable in the innermost frame."""
        reference = self.scopes(self.stack(thread)[frame]["id"])[scope]
        return self.inside(reference)[name]["value"]

    def end(self):
        """The exit code, when it has ended by itself or is ended now."""
        self.request("disconnect")
        self.process.stdin.close()
        return self.process.wait(timeout=60)
