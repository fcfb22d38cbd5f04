#!/usr/bin/python3
"""What a reader can take in at once, and what spreads where nobody looks.

- A function of runtime/, blocks/ and tools/lineshaft/ has at most 60 lines, from the line that its signature begins in to its
  brace; tables and the machine's loop, named below, may be longer. A file of runtime/ has at most 500, a class of
  runtime/st/ at most 40 methods.
- A switch over an enumeration named below has a case for each of its values and no `default:`, which would take what is
  added later for something else; the compiler tells which is missing.
- What differs between dialects is a field of `Dialect`. So many comparisons with a vendor or with a row are left, and so
  many comments that begin with "Of" and are no sentence: both numbers below are what was counted, and only become less.

usage: measures.py SOURCE_DIR
"""

import bisect
import collections
import pathlib
import re
import sys

LINES_OF_FUNCTION, LINES_OF_FILE, METHODS_OF_CLASS = 60, 500, 40
LONG_FUNCTIONS = {
    "blocks/axis/axis.cpp:fields",
    "blocks/axis/servo_drive.cpp:fields",
    "blocks/catalog.cpp:make_catalog",
    "runtime/program/program_form.cpp:program_form",
    "runtime/st/code/machine.cpp:run",  # the loop of the machine
}
CLOSED_ENUMERATIONS = {"Command", "GroupCommand", "TestCall", "PathFault", "PlanResult", "RegisterType"}
COMPARISONS_OF_DIALECTS = 7
COMMENTS_WITH_OF = 0

source = pathlib.Path(sys.argv[1])
wrong = []


def files(*folders, endings=(".cpp", ".hpp")):
    return [path for folder in folders for path in sorted((source / folder).rglob("*")) if path.suffix in endings]


def blank(match):
    """As many lines and characters, none of which is code."""
    return re.sub(r"[^\n]", " ", match[0])


def code_of(path):
    """A file's text without comments, texts and preprocessor lines, as long as it was."""
    text = path.read_text(encoding="utf-8")
    text = re.sub(r'R"(\w*)\((?s:.*?)\)\1"|//[^\n]*|/\*(?s:.*?)\*/|"(?:\\.|[^"\\\n])*"|'
                  r"(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'", blank, text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.M)


def without_templates(head):
    """A declaration without what stands between angle brackets."""
    before = None
    while before != head:
        before, head = head, re.sub(r"<[^<>;{}]*>", "", head)
    return head


def kind_of(head):
    """What a brace opens, behind this text: namespace, class, function or something else; and its name."""
    head = without_templates(re.sub(r"\[\[.*?\]\]", "", head, flags=re.S))
    if re.search(r"\bnamespace\b|^\s*extern\s*$", head):
        return "namespace", ""
    if found := re.search(r"^\s*(?:\w+:\s*)*(?:template\s*)?(?:class|struct|union)\s+([\w:]+)[^(=]*$", head):
        return "class", found[1]
    found = re.search(r"(operator\s*\S+?|~?\w+)\s*\(", head)
    if found and not re.search(r"\benum\b", head) and "=" not in head[:found.start(1)]:
        return "function", found[1]
    return "other", ""


class Measured:
    """A file's functions as (name, first line, lines) and its classes' methods."""

    def __init__(self, path):
        self.text = code_of(path)
        self.ends = [at for at, character in enumerate(self.text) if character == "\n"]
        self.functions, self.methods = [], collections.Counter()
        self.opened = [("namespace", "", 0)]
        self.begin = 0
        for found in re.finditer(r"[{};]", self.text):
            self.meet(found[0], found.start())

    def line(self, at):
        return bisect.bisect_left(self.ends, at) + 1

    def meet(self, sign, at):
        kind, name, _ = self.opened[-1]
        head = self.text[self.begin:at]
        if sign == "{":
            opens, named = kind_of(head) if kind in ("namespace", "class") else ("other", "")
            if opens == "function" and kind == "class":
                self.methods[name] += 1
            first = self.begin + len(head) - len(head.lstrip())
            self.opened.append((opens, named, first))
        elif sign == "}":
            self.close(at)
            if self.opened[-1][0] in ("namespace", "class") and kind == "other":
                return  # `int a{};`, `: a_{a}, b_(b) {`: it goes on
        elif kind == "class" and self.is_method(head):
            self.methods[name] += 1
        if self.opened[-1][0] in ("namespace", "class"):
            self.begin = at + 1

    def close(self, at):
        kind, name, first = self.opened.pop()
        if kind == "function":
            begin = self.line(first)
            self.functions.append((name, begin, self.line(at) - begin + 1))

    @staticmethod
    def is_method(head):
        head = without_templates(head)
        return re.search(r"\w\s*\(", head) and not re.search(r"\b(?:friend|using|static_assert)\b|=[^=]*\(", head)


def check_sizes():
    """The number of functions."""
    count = 0
    for path in files("runtime", "blocks", "tools/lineshaft"):
        place, measured = path.relative_to(source), Measured(path)
        count += len(measured.functions)
        for name, line, lines in measured.functions:
            if lines > LINES_OF_FUNCTION and f"{place}:{name}" not in LONG_FUNCTIONS:
                wrong.append(f"{place}:{line}: {name} has {lines} lines, {LINES_OF_FUNCTION} at most")
        if place.parts[:2] == ("runtime", "st"):
            for name, methods in measured.methods.items():
                if methods > METHODS_OF_CLASS:
                    wrong.append(f"{place}: {name} has {methods} methods, {METHODS_OF_CLASS} at most")
        lines = path.read_text(encoding="utf-8").count("\n")
        if place.parts[0] == "runtime" and lines > LINES_OF_FILE:
            wrong.append(f"{place} has {lines} lines, {LINES_OF_FILE} at most")
    return count


def switches(text):
    """Where a switch begins, and what stands directly in its braces."""
    for found in re.finditer(r"\bswitch\s*\(", text):
        depth, body = 0, []
        for at in range(text.index("{", found.end()), len(text)):
            depth += (text[at] == "{") - (text[at] == "}")
            if depth == 0:
                break
            if depth == 1:
                body.append(text[at])
        yield found.start(), "".join(body)


def check_switches():
    for path in files("runtime", "blocks", "tools/lineshaft"):
        text = code_of(path)
        aliases = dict(re.findall(r"\busing (\w+) = (\w+);", text))
        for at, body in switches(text):
            over = {aliases.get(name, name) for name in re.findall(r"\bcase\s+(?:\w+::)*?(\w+)::\w+:", body)}
            if over & CLOSED_ENUMERATIONS and re.search(r"\bdefault:", body):
                wrong.append(f"{path.relative_to(source)}:{text.count(chr(10), 0, at) + 1}: "
                             f"a switch over {', '.join(sorted(over))} has a default")


def compare(what, found, most):
    """Tells all of them when there are more."""
    if len(found) > most:
        wrong.extend(found)
        wrong.append(f"there are {len(found)} {what}, {most} at most")
    elif len(found) < most:
        print(f"there are {len(found)} {what}: tests/measures.py still allows {most}")


def check_dialects():
    compared = re.compile(r"[!=]=\s*Vendor::|Vendor::\w+\s*[!=]=|case Vendor::|dialect(?:\(\))?\s*[!=]=\s*&")
    found = [f"{path.relative_to(source)}:{text.count(chr(10), 0, match.start()) + 1}: compares with a vendor or a dialect"
             for path in files("runtime", "blocks", "tools/lineshaft") if path.name != "dialect.cpp"
             for text in [code_of(path)] for match in compared.finditer(text)]
    compare("comparisons with a vendor or a dialect", found, COMPARISONS_OF_DIALECTS)


def check_comments():
    found = [f"{path.relative_to(source)}:{number}: a comment begins with 'Of'"
             for path in files("runtime", "blocks", "tools", "tests", endings=(".cpp", ".hpp", ".st"))
             for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
             if re.search(r"(?://+<?|\(\*) *Of\b", line)]
    compare("comments that begin with 'Of'", found, COMMENTS_WITH_OF)


functions = check_sizes()
check_switches()
check_dialects()
check_comments()
print("\n".join(wrong) or f"{functions} functions fit their measures")
sys.exit(bool(wrong) or functions < 1000)
