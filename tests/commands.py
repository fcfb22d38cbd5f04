#!/usr/bin/python3
"""Every command that README.md, programs/README.md and the lessons of the course show runs as it is written, one after the
other, and what a lesson says will be seen (-> `...`) is seen. What is to be tried out and fails says so there (FAILED).

usage: commands.py LINESHAFT PROJECT [FILE...]
"""

import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from built import has_pages

lineshaft, project = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
COMMAND = re.compile(r"(lineshaft|curl|printf|python3) ")


def of_page(path):
    """Commands of the blocks without a language; nothing is said of what will be seen."""
    text = (project / path).read_text(encoding="utf-8")
    blocks = re.findall(r"^```\n(.*?)^```$", text, re.M | re.S)
    return [(line, "") for block in blocks for line in block.splitlines() if COMMAND.match(line)]


def of_lesson(path):
    """Commands of the comment above the program, each with what is said below it."""
    found = []
    for line in path.read_text(encoding="utf-8").split("lineshaft: 1")[0].splitlines():
        line = line.removeprefix("#")
        if COMMAND.match(line.strip()) and line.startswith("   "):
            found.append([line.strip(), ""])
        elif found and line.startswith("     "):
            found[-1][1] += line
        elif found and "$lineshaft" not in line:
            raise AssertionError(f"{path.name}: {line!r} follows the commands")
    return [tuple(one) for one in found]


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Terminal:
    """A folder with what a checkout has that the commands name, in which they run one after the other."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        for part in "programs", "config", "tools/python":
            shutil.copytree(project / part, self.folder / part)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/lineshaft").symlink_to(lineshaft)
        self.served, self.since = None, 0
        self.ports = {port: str(free_port()) for port in ("8080", "1502")}

    def run(self, command, said):
        for port, other in self.ports.items():
            command = command.replace(f"127.0.0.1:{port}", f"127.0.0.1:{other}")
        if command.startswith("lineshaft") and self.served:
            self.end_serving()
        if command.startswith("lineshaft serve"):
            return self.serve(command)
        answer = subprocess.run(["bash", "-c", f"set -o pipefail; PATH=$PWD/bin:/usr/bin:/bin; {command}"], cwd=self.folder,
                                capture_output=True, text=True, timeout=900, check=False)
        text = answer.stdout + answer.stderr
        wanted = 1 if "FAILED" in said else 0
        assert answer.returncode == wanted, f"exit code {answer.returncode}\n{text}"
        for seen in re.findall("`([^`]+)`", said):
            assert seen in text, f"{seen!r} is not seen in\n{text}"

    def serve(self, command):
        self.served = subprocess.Popen(["bash", "-c", f"exec bin/{command.split('#')[0]} --http 127.0.0.1:{self.ports['8080']}"],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for _ in range(200):
            with socket.socket() as s:
                if s.connect_ex(("127.0.0.1", int(self.ports["8080"]))) == 0:
                    self.since = time.monotonic()
                    return
            time.sleep(0.05)
        raise AssertionError("it does not serve")

    def end_serving(self):
        time.sleep(max(0, self.since + 4 - time.monotonic()))
        self.served.send_signal(signal.SIGINT)
        text = self.served.communicate(timeout=30)[0]
        assert self.served.returncode in (0, 130), text
        self.served = None


def main():
    failures, count = [], 0
    lessons = sorted((project / "programs").glob("[0-9]*.yaml"))
    pages = {path: of_page(path) for path in ("README.md", "programs/README.md")}
    shown = pages | {path.name: of_lesson(path) for path in lessons}
    assert len(pages["README.md"]) == 18 and len(pages["programs/README.md"]) > 15, "six jobs with three commands each"
    assert sum("->" in said for commands in shown.values() for _, said in commands) >= 8
    for path, commands in shown.items():
        if path not in (sys.argv[3:] or shown):
            continue
        terminal = Terminal()
        for command, said in commands:
            if shutil.which("genhtml") is None and "genhtml" in command:
                print(f"skipped: {command}: genhtml is not installed")
                continue
            if re.search("lineshaft report|--report ", command) and not has_pages(lineshaft, command):
                continue
            count += 1
            start = time.monotonic()
            try:
                terminal.run(command, said)
            except (AssertionError, subprocess.SubprocessError) as failure:
                failures.append(f"{path}: {command}\n    {failure}")
            if (seconds := time.monotonic() - start) > 5:
                print(f"{seconds:.0f} s: {command}")
        if terminal.served:
            terminal.end_serving()
        shutil.rmtree(terminal.folder)
    print("\n".join(failures) or f"{count} commands")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
