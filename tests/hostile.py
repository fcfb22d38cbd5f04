#!/usr/bin/python3
"""Every example, study, fit and controller, cut off after each byte and with each line left out, through `lineshaft
check`: each answer within 0.2 s of processor time and 64 MB, exit code 2 and a place in the message, or 0 where the
rest is still valid.

usage: hostile.py LINESHAFT SOURCE_DIR [STEP]
    STEP   try every STEP-th cut only, and every STEP/10-th line; default: 1, all
LINESHAFT_MEMORY_LIMITS=off: for a build with sanitizers or counters, which need more
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST_SECONDS = 0.2
MOST_KILOBYTES = float("inf") if os.environ.get("LINESHAFT_MEMORY_LIMITS") == "off" else 64 * 1024
HEAD = re.compile(rb"^(\S+:\d+:\d+: )?error", re.MULTILINE)


def variants(text, step):
    """Name and text of each."""
    for end in range(0, len(text), step):
        yield f"first {end} bytes", text[:end]
    lines = text.splitlines(keepends=True)
    for i in range(0, len(lines), max(1, step // 10)):
        yield f"without line {i + 1}", b"".join(lines[:i] + lines[i + 1:])


def answer(lineshaft, arguments, folder, scratch):
    """Exit code, what it said, processor time [s], greatest memory [kB]."""
    with open(scratch, "w+b") as said:
        process = subprocess.Popen([lineshaft, "check", *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return process.returncode, said.read(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss


def mistakes(code, said, seconds, kilobytes):
    if code not in (0, 2):
        yield f"exit code {code}"
    heads = HEAD.findall(said)
    if code == 2 and (not heads or not all(heads)):
        yield "no place in the message"
    if seconds > MOST_SECONDS:
        yield f"{seconds:.2f} s"
    if kilobytes > MOST_KILOBYTES:
        yield f"{kilobytes} kB"


def try_file(lineshaft, source, relative, step):
    """One file of the tree, in a copy of its own. Figures, and what is wrong."""
    figures, wrong = [], []
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        root = pathlib.Path(folder)
        for part in ("programs", "config"):
            shutil.copytree(source / part, root / part)
        file = root / relative
        text = file.read_bytes()
        checked = file
        if relative.parts[0] == "config":
            checked = root / "user.yaml"
            checked.write_text(f"lineshaft: 1\ncontroller: {relative}\nblocks: {{}}\nrun: {{for: 1 s}}\n")
        for name, variant in variants(text, step):
            file.write_bytes(variant)
            result = answer(lineshaft, [checked.name], checked.parent, root / "said")
            figures.append((result[0], result[2], result[3]))
            wrong += [f"{relative}, {name}: {mistake}\n{result[1].decode(errors='replace')[:400]}"
                      for mistake in mistakes(*result)]
    return figures, wrong


def main():
    lineshaft, source = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    step = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    files = sorted(p.relative_to(source) for part in ("programs", "config") for p in (source / part).rglob("*.yaml"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda file: try_file(lineshaft, source, file, step), files))
    figures = [figure for result in results for figure in result[0]]
    wrong = [line for result in results for line in result[1]]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    print(f"{len(figures)} variants of {len(files)} files, {sum(f[0] == 0 for f in figures)} still valid; "
          f"at most {max(f[1] for f in figures):.3f} s and {max(f[2] for f in figures) / 1024:.1f} MB; "
          f"{len(wrong)} wrong")
    return 1 if wrong or not figures else 0


if __name__ == "__main__":
    sys.exit(main())
