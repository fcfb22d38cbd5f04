#!/usr/bin/python3
"""Compiles every file of tests/st/bad and compares what is said of it with the file NAME.txt beside it.

usage: st_bad.py COMPILE_ST FOLDER [--update-expected] [NAME...]
"""

import difflib
import pathlib
import re
import resource
import subprocess
import sys

LONGEST_SECONDS = 0.1
HEAD = re.compile(r"^\S+:\d+:\d+: (error|warning)\[L\d{4}\]: \S")


def used():
    """Processor time of all that ended so far, whatever else the machine does."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def ask(compiler, path):
    """The answer about one file, and the seconds that it took."""
    start = used()
    answer = subprocess.run([compiler, path.name], cwd=path.parent, capture_output=True, timeout=60)
    return answer, used() - start


def check(compiler, path, update):
    """What is wrong with the answer about one file, as lines."""
    answer, seconds = ask(compiler, path)
    for _ in range(4):  # a busy machine takes longer for the same
        if seconds > LONGEST_SECONDS:
            seconds = ask(compiler, path)[1]
    said = answer.stderr.decode("utf-8", errors="replace")
    golden = path.with_suffix(".txt")
    if update:
        golden.write_text(said, encoding="utf-8")
    expected = golden.read_text(encoding="utf-8") if golden.exists() else ""
    wrong = list(difflib.unified_diff(expected.splitlines(), said.splitlines(), "expected", "answer", lineterm=""))
    if answer.returncode != (2 if "error[" in expected else 0):
        wrong.append(f"exit code {answer.returncode}")
    if seconds > LONGEST_SECONDS:
        wrong.append(f"took {seconds:.2f} s")
    heads = [line for line in said.splitlines() if "[L" in line and " | " not in line]
    wrong += ["no place: " + line for line in heads if not HEAD.match(line)]
    return wrong or ([] if heads else ["said nothing"])


def main():
    update = "--update-expected" in sys.argv
    compiler, root, *names = [a for a in sys.argv[1:] if not a.startswith("--")]
    files = sorted(f for f in pathlib.Path(root).iterdir() if f.suffix in (".st", ".scl", ".EXP"))
    files = [f for f in files if not names or f.stem in names]
    failed = 0
    for path in files:
        wrong = check(str(pathlib.Path(compiler).resolve()), path, update)
        if wrong:
            failed += 1
            print(f"{path.name}:", *wrong, sep="\n    ")
    print(f"{len(files)} files, {failed} failed")
    return 1 if failed or not files else 0


if __name__ == "__main__":
    sys.exit(main())
