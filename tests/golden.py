#!/usr/bin/python3
"""Runs lineshaft in every folder below tests/bad and compares what it says with expected.txt.

A folder holds a program.yaml with a mistake, and what else it needs:
    args          the command line, one argument a line; default: check, program.yaml
    exit          the exit code; default: 2; of warnings 0
    command_line  present when the mistake is in the command line or the machine: messages have no place
    expected.txt  what stands on stderr, byte for byte

usage: golden.py LINESHAFT FOLDER [--update-expected] [NAME...]
"""

import difflib
import pathlib
import re
import subprocess
import sys
import time

LONGEST_SECONDS = 2.0
PLACED = re.compile(r"^[^:\s]+:\d+:\d+: (error|warning)\[L\d{4}\]: ")
HEAD = re.compile(r"(error|warning)(\[L\d{4}\])?: ")


def read(path, default):
    return path.read_text(encoding="utf-8") if path.exists() else default


def check(lineshaft, folder, update):
    """What is wrong with the answer in `folder`, as lines."""
    arguments = read(folder / "args", "check\nprogram.yaml\n").splitlines()
    start = time.monotonic()
    answer = subprocess.run([lineshaft, *arguments], cwd=folder, capture_output=True, timeout=60)
    seconds = time.monotonic() - start
    stderr = answer.stderr.decode("utf-8", errors="replace")
    if update:
        (folder / "expected.txt").write_text(stderr, encoding="utf-8")
    wrong = list(
        difflib.unified_diff(
            read(folder / "expected.txt", "").splitlines(),
            stderr.splitlines(),
            "expected",
            "answer",
            lineterm="",
        )
    )
    wanted = int(read(folder / "exit", "2"))
    if answer.returncode != wanted:
        wrong.append(f"exit code {answer.returncode} instead of {wanted}")
    if seconds > LONGEST_SECONDS:
        wrong.append(f"took {seconds:.1f} s")
    if not stderr:
        wrong.append("said nothing")
    if not (folder / "command_line").exists():
        heads = [line for line in stderr.splitlines() if HEAD.search(line) and "|" not in line]
        wrong += ["no place: " + line for line in heads if not PLACED.match(line)]
        if not heads:
            wrong.append("no message")
    return wrong


def main():
    update = "--update-expected" in sys.argv
    lineshaft, root, *names = [a for a in sys.argv[1:] if not a.startswith("--")]
    lineshaft = str(pathlib.Path(lineshaft).resolve())
    folders = sorted(f for f in pathlib.Path(root).iterdir() if f.is_dir())
    folders = [f for f in folders if not names or f.name in names]
    failed = 0
    for folder in folders:
        wrong = check(lineshaft, folder, update)
        if wrong:
            failed += 1
            print(f"{folder.name}:", *wrong, sep="\n    ")
    print(f"{len(folders)} folders, {failed} failed")
    return 1 if failed or not folders else 0


if __name__ == "__main__":
    sys.exit(main())
