"""A client of `lineshaft lsp`: requests, answers, and what the server tells by itself."""

import json
import pathlib
import subprocess
import urllib.parse


def uri_of(path):
    return "file://" + urllib.parse.quote(str(path))


def path_of(uri):
    return urllib.parse.unquote(uri.removeprefix("file://"))


def framed(message):
    body = message if isinstance(message, bytes) else json.dumps(message).encode()
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


class Client:
    """An editor with one folder open, or none."""

    def __init__(self, lineshaft, folder=None, encodings=None, related=True):
        self.process = subprocess.Popen([str(lineshaft), "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.count, self.diagnostics, self.texts, self.versions = 0, {}, {}, {}
        capabilities = {"textDocument": {"publishDiagnostics": {"relatedInformation": related}}}
        if encodings:
            capabilities["general"] = {"positionEncodings": encodings}
        self.about = self.ask("initialize", {"processId": None, "rootUri": folder and uri_of(folder), "capabilities": capabilities})
        self.tell("initialized", {})

    def write(self, message):
        self.process.stdin.write(framed(message))
        self.process.stdin.flush()

    def read(self):
        """The next message."""
        length = None
        while line := self.process.stdout.readline().strip():
            key, value = line.split(b":")
            length = int(value) if key.lower() == b"content-length" else length
        assert length is not None, "the server ended"
        message = json.loads(self.process.stdout.read(length))
        if message.get("method") == "textDocument/publishDiagnostics":
            params = message["params"]
            self.diagnostics[path_of(params["uri"])] = params
        return message

    def tell(self, method, params):
        self.write({"jsonrpc": "2.0", "method": method, "params": params})

    def answer(self, method, params):
        """The whole answer to a request."""
        self.count += 1
        self.write({"jsonrpc": "2.0", "id": self.count, "method": method, "params": params})
        while (message := self.read()).get("id") != self.count:
            pass
        return message

    def ask(self, method, params):
        message = self.answer(method, params)
        assert "error" not in message, message["error"]
        return message["result"]

    def at(self, path, line, character, **more):
        return {"textDocument": {"uri": uri_of(path)}, "position": {"line": line, "character": character}, **more}

    def open(self, path, text=None):
        path = pathlib.Path(path)
        text = path.read_text(encoding="utf-8") if text is None else text
        self.texts[str(path)], self.versions[str(path)] = text, 1
        self.tell("textDocument/didOpen", {"textDocument": {"uri": uri_of(path), "languageId": "x", "version": 1, "text": text}})

    def change(self, path, text, *changes):
        """The text is this one now, by these changes or as a whole."""
        path = str(path)
        self.versions[path] += 1
        self.texts[path] = text
        self.tell("textDocument/didChange", {"textDocument": {"uri": uri_of(path), "version": self.versions[path]},
                                             "contentChanges": list(changes) or [{"text": text}]})

    def close(self, path):
        self.tell("textDocument/didClose", {"textDocument": {"uri": uri_of(path)}})

    def diagnosed(self, path):
        """What is wrong with the file as it is now."""
        path = str(path)
        while self.diagnostics.get(path, {}).get("version") != self.versions[path]:
            self.read()
        return self.diagnostics[path]["diagnostics"]

    def end(self):
        """The exit code behind `shutdown` and `exit`."""
        assert self.ask("shutdown", None) is None
        self.tell("exit", None)
        self.process.stdin.close()
        return self.process.wait(timeout=10)
