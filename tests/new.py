#!/usr/bin/python3
"""`lineshaft new NAME`: every command that it says and writes runs as it is written, also of a name that a shell takes apart.
What it does not write it tells.

usage: new.py LINESHAFT
"""

import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from built import has_pages

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())


def run(*arguments, code=0, **options):
    done = subprocess.run([lineshaft, *arguments], cwd=work, capture_output=True, text=True, timeout=60, **options)
    assert done.returncode == code, (arguments, done)
    return done.stdout + done.stderr


def commands_in(name):
    """Of the comment above the program, each without what is said of it behind some blanks."""
    return [re.split(r" {2,}", line)[0] for line in re.findall(r"^#   lineshaft (.+)$", (work / name).read_text(), re.M)]


def check_words():
    said = run("new", "mine")
    assert said == "mine.yaml: a program that runs; try: lineshaft run mine.yaml\n", said
    found = commands_in("mine.yaml")
    assert [command.split()[0] for command in found] == ["run", "report", "test", "blocks"], found
    for command in ["run mine.yaml", *found]:
        if not command.startswith("report") or has_pages(lineshaft, "what `new` says of a page"):
            run(*shlex.split(command))
    assert (work / "mine.csv").read_text().startswith("time,scan,x.position,"), "no trace"
    setting = re.search(r"^parameters: +# (--set \S+)$", (work / "mine.yaml").read_text(), re.M)[1]
    run("run", "mine.yaml", *shlex.split(setting))


def check_names():
    """The ending may be there, may be .yml, may be left out."""
    for name, made in (("a.yaml", "a.yaml"), ("b.yml", "b.yaml"), ("c.d", "c.d.yaml"), ("of two words", "of two words.yaml")):
        said = run("new", name)
        assert (work / made).is_file(), made
        for command in [re.search(r"try: lineshaft (.+)", said)[1], commands_in(made)[0]]:
            run(*shlex.split(command))
    assert run("new", "quiet", "--quiet") == ""


def check_refusals():
    before = (work / "mine.yaml").read_bytes()
    said = run("new", "mine", code=2)
    assert "'mine.yaml' is there already; name another file" in said, said
    assert (work / "mine.yaml").read_bytes() == before
    (work / "file").write_text("")
    said = run("new", "file/mine", code=3)
    assert "file/mine.yaml" in said and (work / "file").read_text() == "", said
    said = run("new", "around", "--from", "nothing", code=2)
    assert "nothing" in said and not (work / "around.yaml").exists(), said


with tempfile.TemporaryDirectory() as folder:
    work = pathlib.Path(folder)
    check_words()
    check_names()
    check_refusals()
print("what `new` says runs")
