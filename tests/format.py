#!/usr/bin/python3
"""`lineshaft format`: every source of programs/ and tests/ in the style is the same code, and stays as it is.

usage: format.py LINESHAFT SOURCE_DIR
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

lineshaft, source = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
endings = {".st", ".scl", ".s7dcl", ".udt", ".db", ".exp", ".typ", ".var", ".fun"}


def run(*arguments):
    return subprocess.run([lineshaft, *arguments], capture_output=True, text=True, timeout=120, check=False)


def said(path):
    """What is wrong with a file, without the places."""
    answer = run("check", "--json", path).stdout
    found = json.loads(answer)["diagnostics"] if answer.startswith("{") else []
    return sorted((d["code"], re.sub(r"\d+", "N", d["message"])) for d in found)


def bare(text):
    return re.sub(r"\s+", "", text)


def in_style(text, ending=".st"):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / f"one{ending}"
        path.write_text(text, encoding="utf-8")
        assert run("format", path).returncode == 0
        return path.read_text(encoding="utf-8")


def not_in_style(paths):
    return set(re.findall(r"^(.+) is not in the style$", run("format", "--check", *paths).stdout, re.M))


def check_tree(folder):
    """All files at once, as a process for each takes longer than what it does."""
    before = {p: p.read_bytes() for p in sorted(folder.rglob("*")) if p.suffix.lower() in endings}
    first = not_in_style(before)
    answer = run("format", *before)
    refused = [str(p) for p in before if f"{p} is left as it is: " in answer.stderr]
    assert answer.returncode == (2 if refused else 0), answer
    changed = [p for p, text in before.items() if p.read_bytes() != text]
    assert first == set(map(str, changed)) == set(answer.stdout.splitlines()) and not first & set(refused), (first, changed)
    assert not_in_style(before) == set()
    for path in changed:
        after, told = path.read_bytes(), said(path)
        assert bare(after.decode("utf-8")) == bare(before[path].decode("utf-8", errors="replace")), path
        path.write_bytes(before[path])
        assert said(path) == told, (path, told, said(path))
    return len(before) - len(refused), len(changed), len(refused)


def links_stay():
    """A link is none of the files that are written: what it leads to is, with its permissions. One that leads to itself is told."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        real, link, ring = folder / "real.st", folder / "link.st", folder / "ring.st"
        real.write_text("PROGRAM Main\nVAR x:INT; END_VAR\nx:=1;\nEND_PROGRAM\n", encoding="utf-8")
        real.chmod(0o640)
        link.symlink_to("real.st")
        assert run("format", link).returncode == 0
        assert link.is_symlink() and "x : INT" in real.read_text(encoding="utf-8") and real.stat().st_mode & 0o777 == 0o640
        ring.symlink_to("ring.st")
        for command in (["format", folder], ["check", folder], ["format", ring], ["check", ring]):
            answer = run(*command)
            assert answer.returncode == 2 and "Too many levels of symbolic links" in answer.stderr and "filesystem error" not in answer.stderr, (command, answer)
        answer = run("test", folder)
        assert answer.returncode in (1, 2) and "Too many levels" in answer.stdout + answer.stderr and "filesystem error" not in answer.stderr, answer
        (folder / "empty").mkdir()
        assert run("format", folder / "empty").returncode == 2


def main():
    assert in_style("FUNCTION_BLOCK a\nVAR x,y:INT ;END_VAR\nIF x>1 AND(y<-2) THEN\nx:=f( 1,y [ 2 ] );  // so\nELSE\ny := 1;\n\n\n"
                    "END_IF\nCASE x OF\n1,2 : y:=1;\n3:\nx:=2;\nELSE\nx:=3;\nEND_CASE;\nEND_FUNCTION_BLOCK\n") == \
        "FUNCTION_BLOCK a\nVAR x, y : INT; END_VAR\nIF x > 1 AND (y < -2) THEN\n    x := f(1, y[2]);  // so\nELSE\n    y := 1;\n\n" \
        "END_IF\nCASE x OF\n    1, 2: y := 1;\n    3:\n        x := 2;\nELSE\n    x := 3;\nEND_CASE;\nEND_FUNCTION_BLOCK\n"
    assert in_style("\ufeffFUNCTION_BLOCK a\nVAR x:INT; END_VAR\nlab : x:=1;\nGOTO lab;\nCASE x OF\n1 : x:=2;\nEND_CASE;\nEND_FUNCTION_BLOCK\n", ".scl") == \
        "\ufeffFUNCTION_BLOCK a\nVAR x : INT; END_VAR\nlab: x := 1;\nGOTO lab;\nCASE x OF\n    1: x := 2;\nEND_CASE;\nEND_FUNCTION_BLOCK\n"
    assert in_style("FUNCTION_BLOCK a\nTITLE = A title   \nVERSION : 0.1\nAUTHOR : me\nVAR x:INT; END_VAR\nBEGIN\nREGION   What, it does: x=1\nx:=1;\nREGION inner\t\nIF x>1 THEN\n"
                    "x:=2;\nEND_IF;\nEND_REGION inner\nEND_REGION ;\nREGION\nEND_REGION\nEND_FUNCTION_BLOCK\n", ".scl") == \
        "FUNCTION_BLOCK a\nTITLE = A title\nVERSION : 0.1\nAUTHOR : me\nVAR x : INT; END_VAR\nBEGIN\nREGION What, it does: x=1\n    x := 1;\n    REGION inner\n        IF x > 1 THEN\n" \
        "            x := 2;\n        END_IF;\n    END_REGION inner\nEND_REGION ;\nREGION\nEND_REGION\nEND_FUNCTION_BLOCK\n"
    assert in_style("PROGRAM Main\nVAR x:INT; END_VAR\nx:=x+1;\nIF x>3 THEN\nx:=0;\nEND_IF;\n") == \
        "PROGRAM Main\nVAR x : INT; END_VAR\nx := x + 1;\nIF x > 3 THEN\n    x := 0;\nEND_IF;\n"
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "left_out.st"
        path.write_text("FUNCTION_BLOCK a\nVAR x : INT; END_VAR\n{IF defined(FOO)}\nx := 1;\n{END_IF}\nx := 2;\nEND_FUNCTION_BLOCK\n", encoding="utf-8")
        answer = run("format", path)
        assert answer.returncode == 2 and "left_out.st:4" in answer.stdout + answer.stderr, answer
    links_stay()
    total = [0, 0, 0]
    with tempfile.TemporaryDirectory() as folder:
        for part in "programs", "tests/st", "tests/st_tests", "tests/cases":
            shutil.copytree(source / part, pathlib.Path(folder) / part)
            total = [a + b for a, b in zip(total, check_tree(pathlib.Path(folder) / part))]
    assert total[0] > 200 and total[2] < 60, total
    print(f"{total[0]} sources, {total[1]} of them not in the style before; {total[2]} are no Structured Text")


if __name__ == "__main__":
    main()
