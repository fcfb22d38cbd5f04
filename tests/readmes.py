#!/usr/bin/python3
"""What a folder's README names is there, and nothing that is there is left out.

A README names files and folders between backticks or as links: `axis.hpp`, `axis` (both files of that name), `*.st`,
`serve/`. It speaks for its folder and for what is below it up to the next README; in tests/, whose folders mirror what
they test, for its folder alone. Each folder of runtime/ and blocks/ with code in it has one.

usage: readmes.py SOURCE_DIR
"""

import fnmatch
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1]).resolve()
made = {pathlib.PurePath(line.strip("/")).name for line in (source / ".gitignore").read_text(encoding="utf-8").split()}
beside = {"README.md", "CMakeLists.txt", "CMakePresets.json", "LICENSE", "corpus"} | made
code = {".cpp", ".hpp", ".c", ".h", ".py", ".js", ".mjs"}
wrong = []


def entries(folder):
    return sorted(path for path in folder.iterdir() if path.name not in beside and not path.name.startswith("."))


def spans(text):
    """What stands between backticks or in a link, outside of what is shown as typed."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    return [word for span in re.findall(r"`([^`]+)`", text) for word in re.split(r"[\s,]+", span) if word] \
        + re.findall(r"\]\(([^)#:]+)\)", text)


def listed(text):
    """The first cells of tables of files or folders."""
    for table in re.findall(r"^\| (?:files?|folder|room|module) \|.*\n\|.*\n((?:\|.*\n)+)", text, re.M):
        for row in table.splitlines():
            yield from re.findall(r"`([^`]+)`", row.split("|")[1])


def is_there(word, readme):
    """Beside the README, below it, or counted from a folder above."""
    pattern = word.strip("/")
    for base in [readme.parent, *readme.parents]:
        if source not in [base, *base.parents]:
            break
        if any(True for _ in base.glob(pattern)) or any(True for _ in base.glob(f"{pattern}.[a-z]*")):
            return True
    return any(True for _ in readme.parent.glob(f"*/{pattern}"))


def looks_like_code(word):
    plain = re.fullmatch(r"[\w./*-]*\w[\w./*-]*", word) and not re.search(r"[A-Z]{3,}", word)
    return plain and (pathlib.PurePath(word).suffix in code or word.endswith("/") and "/" in word[:-1])


def names(word, path):
    """`axis`, `axis.cpp` and `axis/` name what is called so before its ending; `axis/README.md` names the folder."""
    *folders, last = word.strip("/").split("/")
    stem = last.split(".")[0] if pathlib.PurePath(last).suffix in code else last
    return path.name in folders or fnmatch.fnmatch(path.name, last) or path.name.split(".")[0] == stem


def owned(folder):
    """What the folder's README speaks for."""
    for path in entries(folder):
        yield path
        if path.is_dir() and not (path / "README.md").exists() and "tests" not in path.relative_to(source).parts:
            yield from owned(path)


def check(readme):
    text = readme.read_text(encoding="utf-8")
    words = set(spans(text))
    place = readme.relative_to(source)
    for word in sorted({word for word in words if looks_like_code(word)} | set(listed(text))):
        if not is_there(word, readme):
            wrong.append(f"{place}: there is no {word}")
    for path in owned(readme.parent):
        if not any(names(word, path) for word in words):
            wrong.append(f"{place} leaves out {path.relative_to(readme.parent)}")


readmes = [path for path in sorted(source.rglob("README.md")) if not beside & {*path.relative_to(source).parts[:-1]}]
for readme in readmes:
    check(readme)
for folder in sorted(path for top in ("runtime", "blocks") for path in (source / top).rglob("*") if path.is_dir()):
    if any(path.suffix in code for path in folder.iterdir()) and not (folder / "README.md").exists():
        wrong.append(f"{folder.relative_to(source)} has no README.md")
print("\n".join(wrong) or f"{len(readmes)} READMEs name what is there")
sys.exit(bool(wrong) or len(readmes) < 10)
