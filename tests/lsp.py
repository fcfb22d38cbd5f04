#!/usr/bin/python3
"""The language server by its protocol: what it says of every file of tests/bad and tests/st/bad is what `lineshaft check`
says, also behind random edits; messages that are none are answered as the protocol has it.

usage: lsp.py LINESHAFT SOURCE_DIR [EDITS] [SEED]
"""

import json
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from language_client import Client, framed, path_of, uri_of

lineshaft, source = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
edits = int(sys.argv[3]) if len(sys.argv) > 3 else 60
seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
checks = []


def check(function):
    checks.append(function)
    return function


def told_by_command(path):
    """(line, column, code, message, help) of one file, as `lineshaft check` has them."""
    answer = subprocess.run([lineshaft, "check", "--json", path], capture_output=True, check=False)
    if not answer.stdout.startswith(b"{"):
        return set()
    if path.suffix == ".yaml" and not re.search(rb"lineshaft[:_]", path.read_bytes()):
        return set()  # the server takes it for another one's
    return {(max(d["line"], 1), max(d["column"], 1), d["code"], d["message"], d["help"])
            for d in json.loads(answer.stdout)["diagnostics"] if d["file"] in (str(path), "")}


def told_by_server(client, path, text):
    """Likewise; columns in characters."""
    lines = text.replace("\r\n", "\n").split("\n")
    found = set()
    for d in client.diagnosed(path):
        start = d["range"]["start"]
        line = lines[start["line"]] if start["line"] < len(lines) else ""
        before = line.encode("utf-16-le")[:2 * start["character"]].decode("utf-16-le")
        related = d.get("relatedInformation")
        found.add((start["line"] + 1, len(before) + 1, d["code"], d["message"], related[0]["message"] if related else ""))
    return found


def bad_files():
    for folder in sorted((source / "tests/bad").iterdir()):
        yield from sorted(folder.glob("*.yaml"))
    yield from sorted(p for p in (source / "tests/st/bad").iterdir() if p.suffix in (".st", ".scl"))


def readable(path):
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        return None
    return None if "\0" in text or len(text) > 1 << 19 else text


@check
def golden_messages_are_diagnostics():
    client, count = Client(lineshaft), 0
    for path in bad_files():
        text = readable(path)
        if text is None or "\r" in text.replace("\r\n", ""):
            continue
        wanted = told_by_command(path)
        client.open(path, text.removeprefix("\ufeff"))
        got = told_by_server(client, path, text.removeprefix("\ufeff"))
        assert got == wanted, f"{path}\n  server only: {got - wanted}\n  command only: {wanted - got}"
        client.close(path)
        count += bool(got)
    assert count > 300, count
    assert client.end() == 0
    return f"{count} files with mistakes"


def random_edit(text, rng):
    """(text, change) of an edit as people type: a piece removed, put in or put elsewhere."""
    begin = rng.randrange(len(text) + 1)
    end = min(len(text), begin + rng.choice((0, 0, 1, 1, 2, 5, 40)))
    piece = rng.choice(("", "x", " ", "\n", ":", ";", "END_IF", "'", "(*", "{", "é", "𝄞", "  - ", text[-30:], "1.5 mm"))
    where = [{"line": text.count("\n", 0, at), "character": len(text[text.rfind("\n", 0, at) + 1:at].encode("utf-16-le")) // 2}
             for at in (begin, end)]
    return text[:begin] + piece + text[end:], {"range": {"start": where[0], "end": where[1]}, "text": piece}


@check
def random_edits_are_checked_as_if_fresh():
    rng = random.Random(seed)
    names = ("programs/01_axis.yaml", "programs/08_state_machine.yaml", "programs/08_state_machine.scl", "programs/02_gear.yaml",
             "tests/st/blocks.st", "tests/st/charts.st", "tests/st/classes.st", "tests/st/texts.st", "tests/st/siemens.scl",
             "programs/paper/wei2025_table1.yaml", "config/s7_1515.yaml")
    client, times = Client(lineshaft), []
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()  # other tests read the sources while these are edited
        for part in "programs", "config", "tests/st":
            shutil.copytree(source / part, root / "opened" / part)
            shutil.copytree(source / part, root / "checked" / part)  # a program without a name has that of its file
        files = [root / "opened" / name for name in names if (source / name).exists()]
        assert len(files) >= 8, files
        for file in files:
            start = text = file.read_text(encoding="utf-8")
            written = root / "checked" / file.relative_to(root / "opened")
            client.open(file, text)
            for i in range(edits // len(files) + 1):
                if i % 8 == 0:
                    client.change(file, start)
                    text = start
                text, change = random_edit(text, rng)
                begun = time.perf_counter()
                client.change(file, text, change)
                got = told_by_server(client, file, text)
                times.append(time.perf_counter() - begun)
                written.write_text(text, encoding="utf-8", newline="")
                wanted = {(l, c, code, m.replace("/checked/", "/opened/"), h.replace("/checked/", "/opened/"))
                          for l, c, code, m, h in told_by_command(written)}
                assert got == wanted, f"{file}\n{text}\n  server: {got - wanted}\n  command: {wanted - got}"
            client.close(file)
            written.write_text(start, encoding="utf-8", newline="")
    assert client.end() == 0
    times.sort()
    return f"{len(times)} edits, 95 % told within {times[int(0.95 * len(times))] * 1000:.1f} ms"


@check
def sources_are_read_as_the_editor_has_them():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program, block = folder / "line.yaml", folder / "job.st"
        block.write_text("FUNCTION_BLOCK Job\nVAR_INPUT go : BOOL; END_VAR\nVAR_OUTPUT done : BOOL; END_VAR\ndone := go;\n"
                         "END_FUNCTION_BLOCK\n", encoding="utf-8")
        program.write_text("lineshaft: 1\ntasks: {main: {every: 2 ms}}\nsources: [job.st]\ninputs: {go: true}\nblocks:\n"
                           "  job: {type: Job, task: main, go: inputs.go}\noutputs: {done: job.done}\nrun: {for: 10 ms}\n",
                           encoding="utf-8")
        client = Client(lineshaft, folder)
        client.open(program)
        client.open(block)
        assert client.diagnosed(program) == [], client.diagnosed(program)
        assert client.diagnosed(block) == [], client.diagnosed(block)
        client.change(block, client.texts[str(block)].replace("go : BOOL", "begin : BOOL").replace(":= go", ":= begin"))
        assert client.diagnosed(block) == []
        while not client.diagnostics[str(program)]["diagnostics"]:
            client.read()
        [told] = client.diagnostics[str(program)]["diagnostics"]
        assert told["code"] == "L0203" and told["range"]["start"] == {"line": 5, "character": 31}, told
        client.change(block, client.texts[str(block)].replace("done := begin;", "done := wrong;"))
        [told] = client.diagnosed(block)
        assert told["code"] == "L0904" and told["range"] == {"start": {"line": 3, "character": 8}, "end": {"line": 3, "character": 13}}
        client.close(block)  # what stands on the disk counts again
        while client.diagnostics[str(block)]["diagnostics"] or client.diagnostics[str(program)]["diagnostics"]:
            client.read()
        assert client.end() == 0


@check
def positions_count_as_agreed():
    text = "FUNCTION_BLOCK a\nVAR x : INT; END_VAR\n(* 𝄞é *) y := 1;\nx := 1;\nEND_FUNCTION_BLOCK\n"
    for encodings, column in ((None, 10), (["utf-16"], 10), (["utf-8", "utf-16"], 13)):
        client = Client(lineshaft, encodings=encodings)
        assert client.about["capabilities"]["positionEncoding"] == ("utf-8" if column == 13 else "utf-16")
        path = source / "tests/no_such_file.st"
        client.open(path, text)
        [told] = client.diagnosed(path)
        assert told["range"]["start"] == {"line": 2, "character": column}, told
        end = {"line": 2, "character": column + 1}
        client.change(path, text.replace("y :=", "x :="), {"range": {"start": told["range"]["start"], "end": end}, "text": "x"})
        assert client.diagnosed(path) == []
        assert client.end() == 0


@check
def without_related_information_the_help_is_in_the_message():
    client, path = Client(lineshaft, related=False), source / "tests/st/no_such_file.st"
    client.open(path, "FUNCTION_BLOCK a\nVAR speed : INT; END_VAR\nspede := 1;\nEND_FUNCTION_BLOCK\n")
    [told] = client.diagnosed(path)
    assert told["message"] == "'spede' is not declared\ndid you mean 'speed'?", told
    assert client.end() == 0


@check
def messages_that_are_none_are_refused():
    process = subprocess.Popen([lineshaft, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    client = Client.__new__(Client)
    client.process, client.count, client.diagnostics = process, 0, {}
    refused = [
        (b"{", -32700, None), (b"[]", -32600, None), (b"1", -32600, None), (b'{"id": 7}', -32600, 7),
        (b'{"id": null, "method": "initialize"}', -32600, None), (b'{"id": 1.5, "method": "initialize"}', -32600, None),
        (b'{"id": "a", "method": "textDocument/hover", "params": {}}', -32002, "a"),
    ]
    for body, code, identity in refused:
        client.write(body)
        message = client.read()
        assert message["error"]["code"] == code and message["id"] == identity, (body, message)
    client.write(b'{"method": "textDocument/didOpen", "params": {"textDocument": {}}}')  # before 'initialize': dropped
    process.stdin.write(b"Nonsense\r\n\r\n" + framed({"id": 1, "method": "initialize", "params": {"capabilities": {}}}))
    process.stdin.flush()
    assert "capabilities" in client.read()["result"]
    for body, code in ((b'{"id": 2, "method": "initialize", "params": {}}', -32600), (b'{"id": 3, "method": "x/y"}', -32601),
                       (b'{"id": 4, "method": "$/x"}', -32601)):
        client.write(body)
        assert client.read()["error"]["code"] == code
    for body in (b'{"method": "textDocument/didOpen"}', b'{"method": "textDocument/didChange", "params": {"textDocument": 3}}',
                 b'{"method": "$/cancelRequest", "params": {"id": 3}}', b'{"id": 9, "result": null}', b'{"method": "x/y", "params": []}'):
        client.write(body)
    assert client.ask("shutdown", None) is None
    client.write(b'{"id": 5, "method": "shutdown"}')
    assert client.read()["error"]["code"] == -32600
    client.tell("exit", None)
    process.stdin.close()
    assert process.wait(timeout=10) == 0
    for last, wanted in ((b'{"method": "exit"}', 1), (b'{"id": 1, "method": "initialize", "params": {}}', 1)):
        answer = subprocess.run([lineshaft, "lsp"], input=framed(last), capture_output=True, timeout=10, check=False)
        assert answer.returncode == wanted, answer


BLOCK = """(* Limits a speed *)
FUNCTION_BLOCK Limiter
VAR_INPUT
    wanted : REAL; (* what is asked for *) {unit := 'mm/s'}
END_VAR
VAR_OUTPUT allowed : REAL {unit := 'mm/s'}; END_VAR
VAR CONSTANT most : REAL := 2.0 * 5.0; END_VAR
VAR delay : TON; last : REAL; END_VAR
delay(IN := wanted > most, PT := T#1s);
last := Clamp(x := wanted, limit := most);
allowed := last;
END_FUNCTION_BLOCK

FUNCTION Clamp : REAL
VAR_INPUT x, limit : REAL; END_VAR
Clamp := MIN(x, limit);
END_FUNCTION
"""
PROGRAM = """lineshaft: 1
tasks: {main: {every: 2 ms}}
sources: [limiter.st]
inputs: {speed: 3 mm/s}
blocks:
  first: {type: Limiter, task: main, wanted: inputs.speed}
  second: {type: Limiter, task: main, wanted: first.allowed}
outputs: {shown: second.allowed}
run: {for: 10 ms}
"""


class Folder:
    """A program, its source, and a client that has both open."""

    def __init__(self):
        self.temporary = tempfile.TemporaryDirectory()
        folder = pathlib.Path(self.temporary.name)
        self.program, self.block = folder / "line.yaml", folder / "limiter.st"
        self.program.write_text(PROGRAM, encoding="utf-8")
        self.block.write_text(BLOCK, encoding="utf-8")
        self.client = Client(lineshaft, folder)
        for path in self.block, self.program:
            self.client.open(path)
            assert self.client.diagnosed(path) == [], self.client.diagnosed(path)

    def where(self, path, text, part=None, more=0, nth=0):
        """The place of a part of a text that stands in the file."""
        whole = self.client.texts[str(path)]
        at = -1
        for _ in range(nth + 1):
            at = whole.index(text, at + 1)
        at += text.index(part or text) + more
        return {"textDocument": {"uri": uri_of(path)},
                "position": {"line": whole.count("\n", 0, at), "character": at - whole.rfind("\n", 0, at) - 1}}

    def ask(self, method, path, text, part=None, more=0, nth=0, **params):
        return self.client.ask("textDocument/" + method, self.where(path, text, part, more, nth) | params)

    def labels(self, path, text, part=None, more=0, nth=0):
        return [item["label"] for item in self.ask("completion", path, text, part, more, nth)["items"]]

    def end(self):
        assert self.client.end() == 0
        self.temporary.cleanup()


@check
def hover_says_type_unit_value_and_documentation():
    on = Folder()
    for path, text, part, wanted in (
            (on.block, "IN := wanted", "wanted", ("wanted : REAL", "VAR_INPUT", "mm/s", "what is asked for")),
            (on.block, "limit := most", "most", ("most : REAL := 10",)), (on.block, "MIN(x", "MIN", ("MIN(", "the least")),
            (on.block, "Clamp(x", "Clamp", ("FUNCTION Clamp(x : REAL; limit : REAL) : REAL",)),
            (on.program, "wanted: inputs", "wanted", ("wanted : REAL", "mm/s")), (on.program, "every: 2", "every", ("every",)),
            (on.program, "type: Limiter", "Limiter", ("FUNCTION_BLOCK Limiter(", "Limits a speed"))):
        text = on.ask("hover", path, text, part)["contents"]["value"]
        for piece in wanted:
            assert piece in text, (part, piece, text)
    on.end()


@check
def definitions_and_references_go_across_files():
    on = Folder()
    declared = on.where(on.block, "wanted : REAL")["position"]
    for path, text, part in ((on.block, "x := wanted", "wanted"), (on.program, "wanted: first", "wanted")):
        found = on.ask("definition", path, text, part)
        assert found["uri"] == uri_of(on.block) and found["range"]["start"] == declared, found
    found = on.ask("definition", on.program, "first.allowed", "first")
    assert found["range"]["start"] == on.where(on.program, "first: {")["position"], found
    assert on.ask("definition", on.program, "type: Limiter", "Limiter")["uri"] == uri_of(on.block)
    found = on.ask("references", on.block, "wanted : REAL", context={"includeDeclaration": True})
    assert [pathlib.Path(r["uri"]).name for r in found] == ["limiter.st"] * 3 + ["line.yaml"] * 2, found
    found = on.ask("references", on.program, "first.allowed", "allowed", context={"includeDeclaration": False})
    assert len(found) == 3, found
    on.end()


@check
def renamed_names_leave_what_a_program_does():
    on = Folder()
    before = subprocess.run([lineshaft, "run", on.program, "--json"], capture_output=True, check=False)
    for text, part, name in (("wanted : REAL", None, "asked"), ("allowed : REAL", None, "given"), ("Clamp : REAL", None, "Bounded"),
                             ("last : REAL", None, "kept"), ("FUNCTION_BLOCK Limiter", "Limiter", "Bound"), ("most : REAL", None, "top")):
        assert on.ask("prepareRename", on.block, text, part)
        changes = on.ask("rename", on.block, text, part, newName=name)["changes"]
        for path in (on.block, on.program):
            whole = on.client.texts[str(path)].split("\n")
            for edit in sorted(changes.get(uri_of(path), []), key=lambda e: (e["range"]["start"]["line"], e["range"]["start"]["character"]), reverse=True):
                start, end = edit["range"]["start"], edit["range"]["end"]
                assert start["line"] == end["line"]
                line = whole[start["line"]]
                whole[start["line"]] = line[:start["character"]] + edit["newText"] + line[end["character"]:]
            on.client.change(path, "\n".join(whole))
            path.write_text("\n".join(whole), encoding="utf-8")
        for path in (on.block, on.program):
            assert on.client.diagnosed(path) == [], (name, path, on.client.texts[str(path)], on.client.diagnosed(path))
    assert "type: Bound, task: main, asked: first.given" in on.client.texts[str(on.program)]
    after = subprocess.run([lineshaft, "run", on.program, "--json"], capture_output=True, check=False)
    assert before.returncode == after.returncode == 0, (before, after)
    answer = on.client.answer("textDocument/rename", on.where(on.block, "kept := ", None) | {"newName": "top"})
    assert answer["error"]["code"] == -32602, answer
    on.end()


@check
def names_that_cannot_be_given_are_refused():
    on = Folder()
    named = lambda name: on.client.answer("textDocument/rename", on.where(on.block, "most : REAL") | {"newName": name})
    for name in ("IF", "TRUE", "END_VAR", "INT", "9a", "a b", "last", ""):
        assert named(name)["error"]["code"] == -32602, name
    for name in ("größe", "MOST"):
        [edit, *_] = named(name)["result"]["changes"][uri_of(on.block)]
        assert edit["newText"] == name, edit
    half = on.block.with_name("half.st")
    half.write_text("FUNCTION_BLOCK Other\nVAR l : Limiter; most : INT; END_VAR\nmost := ;\nEND_FUNCTION_BLOCK\n", encoding="utf-8")
    on.client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": uri_of(half), "type": 1}]})
    for text, part, name in (("FUNCTION_BLOCK Limiter", "Limiter", "Bound"), ("Clamp : REAL", None, "Other")):
        answer = on.client.answer("textDocument/rename", on.where(on.block, text, part) | {"newName": name})
        assert "has a mistake (half.st)" in answer["error"]["message"], answer
    on.end()


@check
def a_method_is_renamed_with_its_family():
    on = Folder()
    text = ("INTERFACE ITurn\nMETHOD Turn : INT\nEND_METHOD\nEND_INTERFACE\n"
            "FUNCTION_BLOCK Plain IMPLEMENTS ITurn\nMETHOD Turn : INT\nTurn := 1;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
            "FUNCTION_BLOCK Better EXTENDS Plain\nMETHOD OVERRIDE Turn : INT\nTurn := 2;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
            "FUNCTION_BLOCK Apart\nVAR b : Better; END_VAR\nMETHOD Turn : INT\nTurn := b.Turn();\nEND_METHOD\nEND_FUNCTION_BLOCK\n")
    path = on.block.with_name("turn.st")
    path.write_text(text, encoding="utf-8")
    on.client.open(path)
    assert on.client.diagnosed(path) == [], on.client.diagnosed(path)
    for nth in range(3):
        [edits] = on.ask("rename", path, "Turn : INT", nth=nth, newName="Rotate")["changes"].values()
        assert sorted({e["range"]["start"]["line"] for e in edits}) == [1, 5, 6, 10, 11, 17], edits
    on.end()


THINGS = {
    "IThing.st": "INTERFACE IThing\nMETHOD Act : INT\nVAR_INPUT k : INT; END_VAR\nEND_METHOD\nEND_INTERFACE\n",
    "Thing.st": "FUNCTION_BLOCK Thing IMPLEMENTS IThing\nMETHOD PUBLIC Act : INT\nVAR_INPUT k : INT; END_VAR\nAct := k;\nEND_METHOD\nEND_FUNCTION_BLOCK\n",
    "Better.st": "FUNCTION_BLOCK Better EXTENDS Thing\nMETHOD PUBLIC OVERRIDE Act : INT\nVAR_INPUT k : INT; END_VAR\nAct := 2 * k;\nEND_METHOD\nEND_FUNCTION_BLOCK\n",
    "Plain.st": "FUNCTION_BLOCK Plain\nMETHOD PUBLIC Act : INT\nVAR_INPUT k : INT; END_VAR\nAct := 3 * k;\nEND_METHOD\nEND_FUNCTION_BLOCK\n",
    "Joins.st": "(* has the name of neither method *)\nFUNCTION_BLOCK Joins EXTENDS Plain IMPLEMENTS IThing\nEND_FUNCTION_BLOCK\n",
    "Apart.st": "FUNCTION_BLOCK Apart\nMETHOD PUBLIC Act : INT\nVAR_INPUT k : INT; END_VAR\nAct := k;\nEND_METHOD\nEND_FUNCTION_BLOCK\n",
    "Main.st": "PROGRAM Main\nVAR t : Thing; i : IThing; n : INT; END_VAR\nVAR_EXTERNAL gCount : INT; END_VAR\ni := t;\nn := i.Act(k := gCount);\nEND_PROGRAM\n",
    "Globals.st": "VAR_GLOBAL\ngCount : INT := 7;\nEND_VAR\n",
    "test_thing.st": "TEST 'all'\nVAR m : Main; j : Joins; b : Better; a : Apart; END_VAR\nm();\nASSERT_EQUAL(7, m.n);\n"
                     "ASSERT_EQUAL(6, j.Act(k := 2));\nASSERT_EQUAL(4, b.Act(k := 2));\nASSERT_EQUAL(2, a.Act(k := 2));\nEND_TEST\n",
}


class Opened:
    """Files of a folder, each of which is open alone while it is asked about."""

    def __init__(self, files):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name).resolve()
        for name, text in files.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        self.client = Client(lineshaft, self.folder)

    def answer(self, method, name, text, **params):
        path = self.folder / name
        self.client.open(path)
        whole = self.client.texts[str(path)]
        at = whole.index(text)
        answer = self.client.answer(f"textDocument/{method}", {"textDocument": {"uri": uri_of(path)}, **params, "position": {
            "line": whole.count("\n", 0, at), "character": at - whole.rfind("\n", 0, at) - 1}})
        self.client.close(path)
        return answer

    def changes(self, name, text, new):
        answer = self.answer("rename", name, text, newName=new)
        assert "error" not in answer, (name, text, answer)
        return answer["result"]["changes"]

    def rename(self, name, text, new):
        """What the folder's files are then, by their names."""
        made = {path.name: path.read_text(encoding="utf-8") for path in self.folder.iterdir()}
        for uri, found in self.changes(name, text, new).items():
            file = pathlib.Path(path_of(uri)).name
            lines = made[file].split("\n")
            for edit in sorted(found, key=lambda e: (e["range"]["start"]["line"], e["range"]["start"]["character"]), reverse=True):
                at, end = edit["range"]["start"], edit["range"]["end"]
                lines[at["line"]] = lines[at["line"]][:at["character"]] + edit["newText"] + lines[at["line"]][end["character"]:]
            made[file] = "\n".join(lines)
        return made

    def end(self):
        assert self.client.end() == 0
        self.temporary.cleanup()


@check
def a_hierarchy_is_renamed_in_all_files_from_wherever_one_stands():
    on = Opened(THINGS)
    for new, places in (("Perform", [("IThing.st", "Act"), ("Thing.st", "Act"), ("Better.st", "Act"), ("Better.st", "Act :="), ("Plain.st", "Act"), ("Main.st", "Act"), ("test_thing.st", "Act")]),
                        ("much", [("IThing.st", "k :"), ("Thing.st", "k :"), ("Better.st", "k;"), ("Plain.st", "k;"), ("Main.st", "k :=")]),
                        ("IActs", [("IThing.st", "IThing"), ("Thing.st", "IThing"), ("Joins.st", "IThing"), ("Main.st", "IThing")]),
                        ("Base", [("Thing.st", "Thing"), ("Better.st", "Thing"), ("Main.st", "Thing;")]),
                        ("gAll", [("Globals.st", "gCount"), ("Main.st", "gCount :"), ("Main.st", "gCount)")])):
        old = re.match(r"\w+", places[0][1])[0]
        wanted = {name: re.sub(rf"\b{old}\b", new, text) for name, text in THINGS.items()}
        if old in ("Act", "k"):  # what is apart keeps its name
            wanted["Apart.st"] = THINGS["Apart.st"]
            wanted["test_thing.st"] = wanted["test_thing.st"].replace("a.Perform(", "a.Act(").replace("a.Act(much", "a.Act(k")
        for name, text in places:
            found = on.rename(name, text, new)
            assert found == wanted, (name, text, {n: t for n, t in found.items() if t != wanted[n]})
            count = sum(len(re.findall(rf"\b{new}\b", t)) for t in wanted.values())
            assert len(on.answer("references", name, text, context={"includeDeclaration": True})["result"]) == count, (name, text)
    for name, text in wanted.items():
        (on.folder / name).write_text(text, encoding="utf-8")
    subprocess.run([lineshaft, "test", on.folder], check=True, capture_output=True)
    refused = on.answer("rename", "Globals.st", "gAll", newName="k")
    assert "there is a 'k'" in refused["error"]["message"], refused
    on.end()


@check
def a_tag_is_renamed_in_its_table():
    table = ('<?xml version="1.0" encoding="utf-8"?>\n<Document>\n<Engineering version="V17" />\n<SW.Tags.PlcTagTable ID="0">\n<AttributeList><Name>T</Name></AttributeList>\n'
             '<ObjectList>\n<SW.Tags.PlcTag ID="1" CompositionName="Tags">\n<AttributeList><DataTypeName>Bool</DataTypeName><LogicalAddress>%I0.7</LogicalAddress>\n'
             "<Name>Start</Name></AttributeList>\n</SW.Tags.PlcTag>\n</ObjectList>\n</SW.Tags.PlcTagTable>\n</Document>\n")
    files = {"Tags.xml": table, "job.scl": 'FUNCTION_BLOCK "Job"\nVAR_OUTPUT q : Bool; END_VAR\nBEGIN\n  #q := "Start";\nEND_FUNCTION_BLOCK\n'}
    on = Opened(files)
    found = on.rename("job.scl", "Start", "Go")
    assert found == {name: text.replace("Start", "Go") for name, text in files.items()}, found
    found = on.answer("definition", "job.scl", "Start")["result"]["range"]
    assert found == {"start": {"line": 8, "character": 6}, "end": {"line": 8, "character": 11}}, found
    found = on.rename("job.scl", "q :=", "lamp")
    assert found["job.scl"] == files["job.scl"].replace("q", "lamp"), found
    (on.folder / "Tags.xml").write_text(table.replace("Start", "St&#97;rt"), encoding="utf-8")
    on.client.tell("workspace/didChangeWatchedFiles", {"changes": []})
    refused = on.answer("rename", "job.scl", "Start", newName="Go")
    assert "Tags.xml:9; rename it there" in refused["error"]["message"], refused
    on.end()


def twincat(kind, name, declaration, body="", more=""):
    code = f"    <Implementation>\n      <ST><![CDATA[{body}]]></ST>\n    </Implementation>\n" if body else ""
    return (f'<?xml version="1.0" encoding="utf-8"?>\n<TcPlcObject Version="1.1.0.1">\n  <{kind} Name="{name}">\n'
            f"    <Declaration><![CDATA[{declaration}]]></Declaration>\n{code}{more}  </{kind}>\n</TcPlcObject>\n")


MACHINE = {
    "Machine.plcproj": '<?xml version="1.0" encoding="utf-8"?>\n<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003">\n'
                       "  <PropertyGroup><Name>Machine</Name></PropertyGroup>\n  <ItemGroup>\n"
                       + "".join(f'    <Compile Include="{name}"><SubType>Code</SubType></Compile>\n'
                                 for name in ("MAIN.TcPOU", "FB_Lamp.TcPOU", "E_Mode.TcDUT", "GVL.TcGVL")) + "  </ItemGroup>\n</Project>\n",
    "MAIN.TcPOU": twincat("POU", "MAIN", "PROGRAM MAIN\nVAR\n    lamp : FB_Lamp;\n    n : INT;\nEND_VAR\n",
                          "lamp(on := GVL.start);\nn := lamp.Count(k := 2);\nIF lamp.mode = E_Mode.Lit THEN\n    n := n + GVL.step;\nEND_IF\n"),
    "FB_Lamp.TcPOU": twincat("POU", "FB_Lamp", "FUNCTION_BLOCK FB_Lamp\nVAR_INPUT\n    on : BOOL; // what a lamp is told\nEND_VAR\nVAR_OUTPUT\n    mode : E_Mode;\nEND_VAR\n",
                             "mode := SEL(on, E_Mode.Dark, E_Mode.Lit);\n",
                             "    <Method Name=\"Count\">\n      <Declaration><![CDATA[METHOD Count : INT\nVAR_INPUT\n    k : INT;\nEND_VAR\n]]></Declaration>\n"
                             "      <Implementation>\n        <ST><![CDATA[Count := 3 * k;\n]]></ST>\n      </Implementation>\n    </Method>\n"),
    "E_Mode.TcDUT": twincat("DUT", "E_Mode", "TYPE E_Mode :\n(\n    Dark := 0,\n    Lit := 7\n) UDINT;\nEND_TYPE\n"),
    "GVL.TcGVL": twincat("GVL", "GVL", "VAR_GLOBAL\n    start : BOOL;\n    step : INT := 4;\nEND_VAR\n"),
}


@check
def objects_of_twincat_are_told_at_their_places():
    on = Opened(MACHINE)
    for name, right, wrong in (("MAIN.TcPOU", "n := lamp", "m := lamp"), ("FB_Lamp.TcPOU", "3 * k", "3 * kk"),
                               ("E_Mode.TcDUT", "Lit := 7", "Lit := seven"), ("GVL.TcGVL", "INT := 4", "INT := TRUE")):
        path, text = on.folder / name, MACHINE[name].replace(right, wrong)
        on.client.open(path)
        assert on.client.diagnosed(path) == [], (name, on.client.diagnosed(path))
        on.client.change(path, text)
        told = told_by_server(on.client, path, text)
        path.write_text(text, encoding="utf-8")
        answer = subprocess.run([lineshaft, "check", "--json", on.folder], capture_output=True, check=False)
        wanted = {(d["line"], d["column"], d["code"], d["message"], d["help"])
                  for d in json.loads(answer.stdout)["diagnostics"] if d["file"] == str(path)}
        assert told and told == wanted, (name, told, wanted)
        path.write_text(MACHINE[name], encoding="utf-8")
        on.client.change(path, MACHINE[name])
        assert on.client.diagnosed(path) == [], name
        on.client.close(path)
    on.end()


@check
def names_in_objects_of_twincat_lead_where_they_stand():
    on = Opened(MACHINE)

    def found(method, name, text, **params):
        return on.answer(method, name, text, **params)["result"]
    for name, text, wanted in (("MAIN.TcPOU", "on :=", ("on : BOOL", "VAR_INPUT", "what a lamp is told")), ("MAIN.TcPOU", "Count", ("Count",)),
                               ("MAIN.TcPOU", "Lit", ("E_Mode.Lit = 7", "- Dark = 0")), ("FB_Lamp.TcPOU", "Dark", ("E_Mode.Dark = 0",)),
                               ("MAIN.TcPOU", "step", ("step : INT", "VAR_GLOBAL"))):
        said = found("hover", name, text)["contents"]["value"]
        assert all(piece in said for piece in wanted), (name, text, said)
    for name, text, file, place in (("MAIN.TcPOU", "on :=", "FB_Lamp.TcPOU", "on : BOOL"), ("MAIN.TcPOU", "Lit", "E_Mode.TcDUT", "Lit :="),
                                    ("MAIN.TcPOU", "step", "GVL.TcGVL", "step :"), ("MAIN.TcPOU", "Count", "FB_Lamp.TcPOU", "Count : INT")):
        place = MACHINE[file].index(place)
        line = MACHINE[file].count("\n", 0, place)
        told = found("definition", name, text)
        assert told["uri"] == uri_of(on.folder / file) and told["range"]["start"]["line"] == line, (name, text, told)
    places = found("references", "E_Mode.TcDUT", "Lit", context={"includeDeclaration": True})
    assert sorted(pathlib.Path(path_of(p["uri"])).name for p in places) == ["E_Mode.TcDUT", "FB_Lamp.TcPOU", "MAIN.TcPOU"], places
    assert on.rename("FB_Lamp.TcPOU", "Lit", "Bright") == {n: t.replace("Lit", "Bright") for n, t in MACHINE.items()}
    assert on.rename("MAIN.TcPOU", "Count", "Sum") == {n: t.replace('"Count"', "@").replace("Count", "Sum").replace("@", '"Count"')
                                                       for n, t in MACHINE.items()}
    [symbol] = found("documentSymbol", "FB_Lamp.TcPOU", "FB_Lamp")
    assert symbol["name"] == "FB_Lamp" and [c["name"] for c in symbol["children"]] == ["on", "mode", "Count"], symbol
    line = MACHINE["FB_Lamp.TcPOU"].split("METHOD Count")[0].count("\n")
    assert symbol["children"][2]["selectionRange"]["start"] == {"line": line, "character": len("      <Declaration><![CDATA[METHOD ")}, symbol
    assert found("completion", "MAIN.TcPOU", "n := lamp") is None
    on.end()


MODES = {
    "modes.st": "TYPE E_Mode : (Dark := 1, Lit := 7, Both := Lit + 1); END_TYPE\nFUNCTION_BLOCK Lamp\nVAR_INPUT wanted : E_Mode; END_VAR\n"
                "VAR_OUTPUT mode : E_Mode := E_Mode#Lit; END_VAR\nCASE wanted OF\n    Lit: mode := E_Mode#Lit;\nELSE\n    mode := Dark;\nEND_CASE\nEND_FUNCTION_BLOCK\n",
    "lamps.yaml": "lineshaft: 1\ntasks: {main: {every: 10 ms}}\nsources: [modes.st]\nblocks:\n"
                  "  first: {type: Lamp, task: main, wanted: Both}\n  second: {type: Lamp, task: main, wanted: Lit}\nrun: {for: 10 ms}\n"
                  "stimulus: [{at: 5 ms, set: {first.wanted: Lit}}]\nexpect:\n  - {at: end, first.mode: Lit}\n  - {always: second.mode, equals: E_Mode.Lit}\n",
}


@check
def values_of_enumerations_are_shown_renamed_and_offered():
    on = Opened(MODES)
    subprocess.run([lineshaft, "run", on.folder / "lamps.yaml"], check=True, capture_output=True)
    said = on.answer("hover", "modes.st", "Lit: mode")["result"]["contents"]["value"]
    assert "E_Mode.Lit = 7" in said and "- Both = 8" in said, said
    found = on.rename("modes.st", "Lit :=", "Bright")
    assert found["modes.st"] == MODES["modes.st"].replace("Lit", "Bright"), found
    assert found["lamps.yaml"] == MODES["lamps.yaml"].replace("Lit", "Bright"), found
    for name, text in found.items():
        (on.folder / name).write_text(text, encoding="utf-8")
    subprocess.run([lineshaft, "run", on.folder / "lamps.yaml"], check=True, capture_output=True)
    on.client.tell("workspace/didChangeWatchedFiles", {"changes": []})
    path = on.folder / "lamps.yaml"
    on.client.open(path)
    assert on.client.diagnosed(path) == []
    labels = {i["label"] for i in on.answer("completion", "lamps.yaml", "Bright")["result"]["items"]}
    assert labels >= {"Dark", "Bright", "Both"}, labels
    path.write_text(path.read_text().replace("blocks:\n", "inputs: {mode: Dark}\nblocks:\n").replace("wanted: Both", "wanted: inputs.mode")
                    .replace("set: {first.wanted: Bright}", "set: {inputs.mode: Dark}").replace("first.mode: Bright", "first.mode: Dark"))
    on.client.open(path)
    on.client.change(path, path.read_text())
    assert on.client.diagnosed(path) == []
    for at in ("Dark}\nblocks", "Dark}}]"):
        whole = on.client.texts[str(path)]
        before = whole[:whole.index(at)]
        place = {"line": before.count("\n"), "character": len(before) - before.rfind("\n") - 1}
        found = on.client.answer("textDocument/completion", {"textDocument": {"uri": uri_of(path)}, "position": place})["result"]["items"]
        assert {i["label"] for i in found} == {"Dark", "Bright", "Both"}, (at, found)
    on.end()


@check
def yaml_of_others_is_left_alone():
    on = Folder()
    path = on.program.with_name("docker-compose.yaml")
    path.write_text("services:\n  web: {image: nginx}\n", encoding="utf-8")
    on.client.open(path)
    assert on.client.diagnosed(path) == []
    on.end()


@check
def completion_offers_what_fits():
    on = Folder()
    text = on.client.texts[str(on.block)]
    on.client.change(on.block, text.replace("allowed := last;", "allowed := last;\ndelay.\nClamp(\nla"))
    names = {name.lower() for name in on.labels(on.block, "delay.\n", None, 6)}
    assert names == {"in", "pt", "q", "et"}, names
    on.client.change(on.block, text.replace("PT := T#1s", "PT := T#"))
    assert on.labels(on.block, "PT := T#", None, 8) == []
    better = text + "FUNCTION_BLOCK Better EXTENDS Limiter\nVAR own : INT; END_VAR\nown := 1;\nEND_FUNCTION_BLOCK\n"
    on.client.change(on.block, better)
    assert on.client.diagnosed(on.block) == []
    on.client.change(on.block, better.replace("own := 1;", "own := 1; SUPER^."))
    assert {"wanted", "allowed"} <= set(on.labels(on.block, "SUPER^.", None, 7))
    mover = text + "FUNCTION_BLOCK Mover\nVAR_IN_OUT axis : AXIS_REF; END_VAR\nVAR v : LREAL; END_VAR\nv := 1.0;\nEND_FUNCTION_BLOCK\n"
    on.client.change(on.block, mover)
    on.client.diagnosed(on.block)
    on.client.change(on.block, mover.replace("v := 1.0;", "v := axis."))
    assert {"position", "velocity", "state"} <= set(on.labels(on.block, "axis.\n", None, 5))
    on.client.change(on.block, text.replace("allowed := last;", "allowed := last;\ndelay.\nClamp(\nla"))
    names = on.labels(on.block, "Clamp(\n", None, 6)
    assert names[:2] == ["x", "limit"], names[:5]
    assert {"last", "wanted", "most", "Clamp", "MIN", "IF", "ton"} <= set(on.labels(on.block, "\nla", None, 3))
    help = on.ask("signatureHelp", on.block, "x := wanted, limit", None, 14)
    assert help["activeParameter"] == 1 and "Clamp(" in help["signatures"][0]["label"], help
    on.client.change(on.block, text.replace("allowed := last;", "allowed := last; // delay.\ndelay(\n(* delay. *)"))
    help = on.ask("signatureHelp", on.block, "delay(\n", None, 6)
    assert "(in : BOOL; pt : TIME" in help["signatures"][0]["label"].lower().replace("bool", "BOOL").replace("time", "TIME"), help
    for comment in ("// delay.", "(* delay."):
        assert on.labels(on.block, comment, None, len(comment)) == [], comment
    text = on.client.texts[str(on.program)]
    on.client.change(on.program, text + "ex\n")
    assert {"expect", "trace", "stimulus"} <= set(on.labels(on.program, "ex\n", None, 2))
    on.client.change(on.program, text.replace("  second:", "  third: {type: Limiter, task: main, w\n  second:"))
    assert "wanted" in on.labels(on.program, "main, w\n", None, 7)
    on.client.change(on.program, text.replace("  second:", "  third: {type: L\n  second:"))
    assert {"Limiter", "axis", "MC_GearIn"} <= set(on.labels(on.program, "type: L\n", None, 7))
    on.client.change(on.program, text.replace("wanted: first.allowed", "wanted: f"))
    assert {"first.allowed", "inputs.speed"} <= set(on.labels(on.program, "wanted: f", None, 9))
    on.client.change(on.program, text.replace("for: 10 ms", "for: 10 m"))
    assert {"ms", "s"} <= set(on.labels(on.program, "for: 10 m", None, 9))
    on.end()


@check
def what_is_opened_broken_is_completed():
    """As far as it can be read: what is half-written is left out, before and behind it."""
    for broken in ("delay.\nIF wanted > THEN\n", "last := wanted +\nEND_IF\nla"):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "limiter.st")
            path.write_text(BLOCK.replace("allowed := last;", f"allowed := last;\n{broken}"), encoding="utf-8")
            client = Client(lineshaft, pathlib.Path(folder))
            client.open(path)
            assert client.diagnosed(path)
            line = client.texts[str(path)].splitlines().index(broken.splitlines()[-1 if broken.endswith("la") else 0])
            place = {"textDocument": {"uri": uri_of(path)}, "position": {"line": line, "character": len(broken.splitlines()[-1 if broken.endswith("la") else 0])}}
            names = {item["label"].lower() for item in client.ask("textDocument/completion", place)["items"]}
            assert ({"q", "et"} if broken.startswith("delay") else {"last", "wanted", "clamp"}) <= names, sorted(names)[:20]
            assert client.end() == 0


@check
def units_are_those_of_the_block():
    on = Folder()
    text = on.client.texts[str(on.program)].replace("  second:", "  x: {type: axis, task: main, unit: deg, default_velocity: 1 deg/s}\n  second:") \
        .replace("shown: second.allowed", "shown: x.velocity")
    on.client.change(on.program, text)
    assert on.client.diagnosed(on.program) == []
    for where in ("x.velocity", "default_velocity"):
        told = json.dumps(on.ask("hover", on.program, where, None, len(where) - 2))
        assert "deg/s" in told and "{unit}" not in told, told
    on.end()


@check
def outline_folding_lenses_and_quick_fixes():
    on = Folder()
    document = {"textDocument": {"uri": uri_of(on.block)}}
    symbols = on.client.ask("textDocument/documentSymbol", document)
    assert [s["name"] for s in symbols] == ["Limiter", "Clamp"]
    assert [c["name"] for c in symbols[0]["children"]] == ["wanted", "allowed", "most", "delay", "last"]
    folds = {(f["startLine"], f["endLine"]) for f in on.client.ask("textDocument/foldingRange", document)}
    assert {(1, 11), (2, 4), (13, 16)} <= folds, folds
    on.client.change(on.block, "TYPE P : STRUCT\nx : INT;\nEND_STRUCT END_TYPE\n" + on.client.texts[str(on.block)])
    assert [f["endLine"] for f in on.client.ask("textDocument/foldingRange", document) if f["startLine"] == 0] == [2]
    on.client.change(on.block, on.client.texts[str(on.block)].split("\n", 3)[3])
    program = {"textDocument": {"uri": uri_of(on.program)}}
    names = [s["name"] for s in on.client.ask("textDocument/documentSymbol", program)]
    assert names == ["lineshaft", "tasks", "sources", "inputs", "blocks", "outputs", "run"], names
    assert {"startLine": 4, "endLine": 6} in on.client.ask("textDocument/foldingRange", program)
    lenses = on.client.ask("textDocument/codeLens", program)
    assert [lens["command"]["title"] for lens in lenses] == ["run", "debug", "test"]
    on.client.change(on.block, on.client.texts[str(on.block)].replace("x := wanted", "x := wnated"))
    [told] = on.client.diagnosed(on.block)
    [action] = on.client.ask("textDocument/codeAction", document | {"range": told["range"], "context": {"diagnostics": [told]}})
    [edit] = action["edit"]["changes"][uri_of(on.block)]
    assert edit == {"range": told["range"], "newText": "wanted"}, action
    on.end()


@check
def tests_of_fixtures_have_lenses():
    on = Opened({"t.st": "NAMESPACE N\n{TestFixture}\nCLASS T\n{Test}\nMETHOD PUBLIC One\nEND_METHOD\n{Test(x := 3)}\nMETHOD PUBLIC Two\n"
                         "VAR_INPUT x : INT; END_VAR\nEND_METHOD\nMETHOD PUBLIC Three\nEND_METHOD\nEND_CLASS\nEND_NAMESPACE\n"})
    lenses = on.answer("codeLens", "t.st", "T")["result"]
    assert [(lens["range"]["start"]["line"], lens["command"]["title"], lens["command"]["arguments"][1]) for lens in lenses] == [
        (4, "test", "T.One"), (4, "debug", "T.One"), (7, "test", "T.Two(x := 3)"), (7, "debug", "T.Two(x := 3)")], lenses
    on.end()


@check
def every_request_answers_whatever_is_written():
    rng, on, times = random.Random(seed), Folder(), []
    asked = ("hover", "definition", "references", "prepareRename", "completion", "signatureHelp", "documentSymbol", "foldingRange",
             "codeLens")
    for path in (on.block, on.program):
        start = text = on.client.texts[str(path)]
        for i in range(edits):
            text, change = random_edit(start if i % 10 == 0 else text, rng)
            on.client.change(path, text, *([change] if i % 10 else []))
            at = rng.randrange(len(text) + 1)
            place = {"line": text.count("\n", 0, at), "character": at - text.rfind("\n", 0, at) - 1}
            begun = time.perf_counter()
            on.client.ask("textDocument/" + rng.choice(asked), {"textDocument": {"uri": uri_of(path)}, "position": place})
            times.append(time.perf_counter() - begun)
    on.end()
    times.sort()
    return f"{len(times)} requests, 95 % answered within {times[int(0.95 * len(times))] * 1000:.1f} ms"


def main():
    failed = 0
    for function in checks:
        start = time.monotonic()
        signal.alarm(300 + edits)  # nobody waits for ever
        try:
            said = function() or ""
            print(f"ok    {function.__name__} ({time.monotonic() - start:.1f} s) {said}")
        except Exception as failure:
            failed += 1
            print(f"wrong {function.__name__}: {type(failure).__name__} {failure}")
            if not isinstance(failure, AssertionError):
                import traceback
                traceback.print_exc()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
