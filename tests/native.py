#!/usr/bin/python3
"""Native code of Structured Text, what a compiler makes of it (--native) and its interpreter: the same trace, the same
messages of faults, and a checkpoint of the one is resumed by the others. Where the system refuses executable memory it is
interpreted, and where it has no compiler, or no folder of the user alone, code is copied, which is told once.

usage: native.py LINESHAFT
"""

import ctypes
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = """\
lineshaft: 1
tasks: {main: {every: 1 ms}}
sources: [job.st]
blocks: {job: {type: Job, task: main}}
run: {for: 300 ms}
trace: {task: main, signals: [job.n, job.level, job.error]}
"""
JOB = """\
FUNCTION Share : LREAL
VAR_INPUT a, b : DINT; END_VAR
Share := DINT_TO_LREAL(a / b);
END_FUNCTION
FUNCTION_BLOCK Job
VAR_OUTPUT n : DINT; level : LREAL; END_VAR
VAR i : DINT; t : ARRAY[0..9] OF LREAL; name : STRING[20]; END_VAR
n := n + 1;
FOR i := 0 TO 9 DO t[i] := t[i] * 0.5 + SIN(DINT_TO_LREAL(n + i)); END_FOR;
name := CONCAT('part ', DINT_TO_STRING(n));
CASE n MOD 7 OF
    0: level := t[0]; 1: level := t[n MOD 10]; 2: level := -level; 3: level := 1.0; 5: level := 2.0;
END_CASE;
level := level + Share(1000, LAST - n);
END_FUNCTION_BLOCK
"""
SET_MDWE, REFUSE_EXEC_GAIN = 65, 1  # prctl(2), Linux 6.3
INTERPRETED = "refuses executable memory"


def refuse():
    assert ctypes.CDLL(None).prctl(SET_MDWE, REFUSE_EXEC_GAIN, 0, 0, 0) == 0


def refuses():
    try:
        return subprocess.run(["true"], preexec_fn=refuse).returncode == 0
    except subprocess.SubprocessError:
        return False


class Runs:
    def __init__(self, lineshaft, folder):
        self.lineshaft, self.folder = lineshaft, folder

    def environment(self, **changes):
        whole = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache"), **changes}
        return {name: str(value) for name, value in whole.items() if value is not None}

    def run(self, *arguments, code=0, before=None, **changes):
        """What it wrote and told."""
        trace = self.folder / "out.csv"
        answer = subprocess.run(
            [self.lineshaft, "run", "program.yaml", "--quiet", "--trace", trace, *arguments], cwd=self.folder,
            capture_output=True, text=True, preexec_fn=before, timeout=300, env=self.environment(**changes))
        assert answer.returncode == code, answer
        return trace.read_bytes() if trace.exists() else None, answer.stdout, answer.stderr

    def write(self, last):
        (self.folder / "program.yaml").write_text(PROGRAM, encoding="utf-8")
        (self.folder / "job.st").write_text(JOB.replace("LAST", last), encoding="utf-8")


def check_ways(runs, code):
    native = runs.run(code=code)
    assert native[0] and INTERPRETED not in native[2], native
    assert native == runs.run("--no-native", code=code)
    for _ in "cold", "warm":
        assert native == runs.run("--native", code=code)
    if not refuses():
        print("this system cannot refuse executable memory")
        return native
    trace, out, err = runs.run(code=code, before=refuse)
    assert (trace, out) == native[:2] and err.count(INTERPRETED) == 1, err
    rest = "".join(line for line in err.splitlines(True) if INTERPRETED not in line)
    assert rest == native[2], (rest, native[2])
    assert runs.run("--no-native", code=code, before=refuse) == native
    return native


def check_checkpoints(runs):
    """Both leave the same one, and each goes on from the other's."""
    ways = (), ("--no-native",), ("--native",)
    kept, left = [runs.folder / f"{number}.checkpoint" for number in range(len(ways))], []
    for way, file in zip(ways, kept):
        whole = runs.run(*way, "--checkpoint", file, "--checkpoint-every", "50 ms")[0]
        left.append((whole, file.read_bytes()))
    assert left[0] == left[1] == left[2]
    for way in ways:
        for file in kept:
            assert runs.run(*way, "--checkpoint", file, "--resume")[0] == whole


def libraries(runs):
    return sorted((runs.folder / "cache/lineshaft").glob("*.so"))


def compiler(runs, *more):
    """A compiler that writes down that it was called."""
    script, log = runs.folder / "compiler", runs.folder / "compiled"
    script.write_text(f"#!/bin/sh\necho >>'{log}'\nexec {os.environ.get('CXX', 'c++')} \"$@\" {' '.join(more)}\n")
    script.chmod(0o755)
    log.unlink(missing_ok=True)
    return script, log


def check_told(runs, native, why, **changes):
    """The same bytes, and one line that says why."""
    trace, out, err = runs.run("--native", **changes)
    lines = [line for line in err.splitlines(True) if "--native" in line]
    assert len(lines) == 1 and why in lines[0], (why, err)
    assert (trace, out, err.replace(lines[0], "")) == native, why


def check_loaded(runs):
    """It is what the dynamic linker loads."""
    log = runs.folder / "linker"
    runs.run("--native", LD_DEBUG="files", LD_DEBUG_OUTPUT=log)
    text = "".join(file.read_text(errors="replace") for file in runs.folder.glob("linker.*"))
    assert any(file.name in text for file in libraries(runs)), "no library of the cache was loaded"


def check_hardened(runs, native):
    cache = runs.folder / "cache/lineshaft"
    check_told(runs, native, "no c++, g++ or clang++ in PATH", PATH="/nowhere", CXX=None)
    check_told(runs, native, "no compiler 'nothing'", CXX="nothing")
    check_told(runs, native, "cannot make /proc/lineshaft", XDG_CACHE_HOME="/proc")
    check_told(runs, native, "HOME names", XDG_CACHE_HOME=None, HOME=None)
    false = shutil.which("false")
    check_told(runs, native, f"{false} failed: exit code 1", CXX=false)
    cache.chmod(0o755)
    check_told(runs, native, "others may use")
    cache.chmod(0o700)
    cache.rename(runs.folder / "elsewhere")
    cache.symlink_to(runs.folder / "elsewhere")
    check_told(runs, native, "cannot use")
    cache.unlink()
    (runs.folder / "elsewhere").rename(cache)
    check_told(runs, native, "has other results", CXX=compiler(runs, "-ffast-math")[0])
    if os.geteuid() != 0:
        print("only root can give a folder away, or mount one")
        return
    os.chown(cache, 12345, -1)
    check_told(runs, native, "others may use")
    os.chown(cache, 0, -1)
    check_noexec(runs, native)


def check_noexec(runs, native):
    folder = runs.folder / "noexec"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "noexec", "lineshaft", folder], capture_output=True).returncode != 0:
        print("this system mounts nothing")
        return
    try:
        check_told(runs, native, "may be executed (noexec)", XDG_CACHE_HOME=folder)
    finally:
        subprocess.run(["umount", folder], check=True)


def check_damaged(runs, native):
    """What is cut short is not loaded, but made again."""
    script, log = compiler(runs)
    before = set(libraries(runs))
    assert runs.run("--native", CXX=script) == native
    made, = set(libraries(runs)) - before
    whole = made.read_bytes()
    for damaged in whole[:len(whole) // 2], b"", whole[:100] + b"?" + whole[101:]:
        made.write_bytes(damaged)
        assert runs.run("--native", CXX=script) == native
        assert made.read_bytes()[:4] == b"\x7fELF" and len(made.read_bytes()) == len(whole)
    assert runs.run("--native", CXX=script) == native
    assert log.read_text().count("\n") == 4, log.read_text()


def check_bounded(runs, native):
    """256 MiB remain in the cache: what was unused longest goes, and what is loaded is used."""
    cache, (script, _) = runs.folder / "cache/lineshaft", compiler(runs)
    before = set(libraries(runs))
    assert runs.run("--native", CXX=script) == native
    made, = set(libraries(runs)) - before
    os.utime(made, (1, 1))
    assert runs.run("--native", CXX=script) == native
    assert made.stat().st_mtime > 1
    for name, used in ("older.so", 2), ("old.so", 3):
        with open(cache / name, "wb") as file:
            file.truncate(150 << 20)
        os.utime(cache / name, (used, used))
    assert runs.run("--native", CXX=compiler(runs)[0]) == native
    assert made.exists() and (cache / "old.so").exists() and not (cache / "older.so").exists()
    (cache / "old.so").unlink()


def check_side_by_side(runs):
    """One compiler for all of them."""
    script, log = compiler(runs)
    shutil.rmtree(runs.folder / "cache")
    both = [subprocess.Popen([runs.lineshaft, "run", "program.yaml", "--quiet", "--native", "--trace", f"side{number}.csv"],
                             cwd=runs.folder, env=runs.environment(CXX=script), stderr=subprocess.PIPE, text=True)
            for number in range(3)]
    assert [(process.communicate()[1], process.returncode) for process in both] == [("", 0)] * 3
    traces = {(runs.folder / f"side{number}.csv").read_bytes() for number in range(3)}
    assert len(traces) == 1 and len(libraries(runs)) == 1 and log.read_text().count("\n") == 1
    left = sorted(file.suffix for file in (runs.folder / "cache/lineshaft").iterdir())
    assert left == ["", ".so"], left


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(lineshaft, pathlib.Path(folder))
        runs.write("1000")
        native = check_ways(runs, 0)
        check_checkpoints(runs)
        check_loaded(runs)
        check_hardened(runs, native)
        check_damaged(runs, native)
        check_bounded(runs, native)
        check_side_by_side(runs)
        runs.write("100")
        told = check_ways(runs, 3)[2]
        assert "job.st:3:" in told and "called by Job (line 14)" in told, told
    print("native code, copied or compiled, and the interpreter write the same")


main()
