#!/usr/bin/python3
"""`lineshaft debug`: a client of the protocol steps a program forwards and back; what it writes is what `run` writes.

usage: debug.py LINESHAFT SOURCE_DIR
"""

import pathlib
import random
import subprocess
import sys
import tempfile

from dap_client import Client, Refused

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
source = pathlib.Path(sys.argv[2]).resolve()
motor, program = source / "tests/debug/motor.st", source / "tests/debug/motor.yaml"
folder = pathlib.Path(tempfile.mkdtemp())
lines = {}
for number, text in enumerate(motor.read_text().splitlines(), 1):
    lines.setdefault(text.strip(), number)


def line(text):
    return lines[text]


def run(path, *arguments):
    """The bytes of the trace and its events of a run in a piece."""
    trace = folder / "run.csv"
    answer = subprocess.run([lineshaft, "run", path, "--trace", trace, "--quiet", *arguments], capture_output=True)
    assert answer.returncode in (0, 1), answer  # an expectation may fail, of what was changed by hand
    return trace.read_bytes(), (folder / "run.events.csv").read_bytes()


def traced(name):
    return (folder / f"{name}.csv").read_bytes(), (folder / f"{name}.events.csv").read_bytes()


def test_run_without_breakpoints():
    client = Client(lineshaft)
    client.launch(program, args=["--trace", str(folder / "free.csv")])
    assert client.event("exited") == {"exitCode": 0}
    client.event("terminated")
    assert client.end() == 0
    assert traced("free") == run(program)


def test_capabilities():
    client = Client(lineshaft, program)
    client.launch()
    for name in ("supportsConfigurationDoneRequest", "supportsStepBack", "supportsTerminateRequest"):
        assert client.capabilities[name] is True, name
    client.end()


def test_lines():
    client = Client(lineshaft)
    blank = line("steps : INT;")
    placed = client.launch(program, {motor: [line("b := a;"), blank, 10_000], program: [3]}, stopOnEntry=True)
    first, second, behind = placed[motor]
    assert first["verified"] and first["line"] == line("b := a;")
    assert second["verified"] and second["line"] == line("steps := steps + 1;")
    assert not behind["verified"] and not placed[program][0]["verified"]
    assert client.event("stopped")["reason"] == "entry"
    client.end()


def test_stops_and_values():
    client = Client(lineshaft)
    client.launch(program, {motor: [line("mode := Mode#running;")]})
    stop = client.event("stopped")
    assert stop["reason"] == "breakpoint" and stop["threadId"] == 2, stop
    assert [t["name"] for t in client.request("threads")["threads"]] == ["fast", "main"]
    assert client.line(2) == ("Motor (motor)", line("mode := Mode#running;"))
    assert client.stack(2)[-1]["name"] == "task main at 0.03 s"
    assert [f["name"] for f in client.stack(1)] == ["task fast at 0.03 s"]
    assert client.value("Inputs", "start", 2) == "TRUE"
    assert client.value("Outputs", "speed", 2) == "1.5 mm/s"
    assert client.value("Locals", "mode", 2) == "Mode#idle"
    table = client.inside(client.scopes(client.stack(2)[0]["id"])["Locals"])["table"]
    assert table["indexedVariables"] == 300
    page = client.inside(table["variablesReference"], start=1, count=2)
    assert {n: v["value"] for n, v in page.items()} == {"[2]": "6", "[3]": "9"}
    ramp = client.inside(client.scopes(client.stack(2)[0]["id"])["Locals"])["ramp"]
    outputs = client.inside(ramp["variablesReference"])["Outputs"]
    assert client.inside(outputs["variablesReference"])["speed"]["value"] == "1.5 mm/s"
    blocks = client.inside(client.scopes(client.stack(1)[0]["id"])["Blocks"])
    inputs = client.inside(client.inside(blocks["delay"]["variablesReference"])["Inputs"]["variablesReference"])
    assert inputs["in"]["type"] == "boolean, from motor.running", inputs
    client.end()


def test_steps():
    client = Client(lineshaft)
    client.launch(program, {motor: [line("ramp(goal := 3.0, speed => speed);")]})
    client.event("stopped")
    client.breakpoints(motor)
    client.step("stepIn", 2)
    assert client.line(2) == ("Ramp", line("steps := steps + 1;"))
    assert client.stack(2)[1]["name"] == "Motor (motor)"
    client.step("next", 2)
    client.step("stepIn", 2)
    assert client.line(2) == ("Clamp", line("IF x > most THEN"))
    assert client.value("Inputs", "x", 2) == "0.5"
    client.step("stepOut", 2)
    assert client.line(2) == ("Motor (motor)", line("FOR i := 1 TO 3 DO"))
    client.step("stepBack", 2)
    assert client.line(2) == ("Motor (motor)", line("ramp(goal := 3.0, speed => speed);"))
    client.step("next", 2)
    assert client.value("Outputs", "speed", 2) == "0.5 mm/s"
    client.step("lineshaft/nextScan", 2)
    assert client.line(2) == ("Motor (motor)", line("a := count;"))
    assert client.value("Outputs", "count", 2) == "1"
    client.step("next", 2)
    assert client.line(2) == ("Motor (motor)", line("b := a;"))
    assert (client.value("Locals", "a", 2), client.value("Locals", "b", 2)) == ("1", "0")
    client.step("stepBack", 2)
    client.step("stepBack", 2)
    assert client.line(2) == ("Motor (motor)", line("count := count + 1;"))
    assert client.value("Outputs", "count", 2) == "0"
    client.end()


def test_guarded_moves():
    """`IF b < 5 THEN b := a; END_IF` is one instruction; both of its statements are stopped at."""
    client = Client(lineshaft)
    client.launch(program, {motor: [line("IF b < 5 THEN")]})
    client.event("stopped")
    client.step("next", 2)
    assert client.line(2)[1] == line("IF b < 5 THEN") + 1
    client.step("next", 2)
    assert client.line(2)[1] == line("ramp(goal := 3.0, speed => speed);")
    client.end()


def test_back_and_forth():
    client = Client(lineshaft)
    trace = folder / "back.csv"
    client.launch(program, {motor: [line("count := count + 1;")]}, args=["--trace", str(trace)])
    client.event("stopped")
    for _ in range(20):
        client.step("continue", 2)
    assert client.value("Outputs", "count", 2) == "20"
    for count in (19, 18, 17):
        assert client.step("reverseContinue", 2)["reason"] == "breakpoint"
        assert client.value("Outputs", "count", 2) == str(count)
    client.step("continue", 2)
    assert client.value("Outputs", "count", 2) == "18"
    client.breakpoints(motor)
    assert client.step("reverseContinue", 2)["reason"] == "entry"
    client.request("continue", threadId=2)
    client.event("exited")
    assert client.end() == 0
    assert traced("back") == run(program)


def test_conditions():
    client = Client(lineshaft)
    count = line("count := count + 1;")
    client.launch(program, {motor: [{"line": count, "condition": "count >= 7 AND mode = Mode#running"}]})
    client.event("stopped")
    assert client.value("Outputs", "count", 2) == "7"
    client.breakpoints(motor, {"line": count, "hitCondition": "% 5"})
    found = []
    for _ in range(3):
        client.step("continue", 2)
        found.append(client.value("Outputs", "count", 2))
    assert found == ["12", "17", "22"], found
    client.step("reverseContinue", 2)
    assert client.value("Outputs", "count", 2) == "17"
    client.step("continue", 2)
    assert client.value("Outputs", "count", 2) == "22"
    placed = client.breakpoints(motor, {"line": count, "condition": "count >"}, {"line": count, "hitCondition": "often"})
    assert not any(b["verified"] for b in placed), placed
    client.breakpoints(motor, {"line": count, "logMessage": "speed {speed}, count {count * 2}"},
                       {"line": count, "condition": "count = 25"})
    client.step("continue", 2)
    client.end()


def test_counts_of_what_is_passed_over():
    """Who goes to a place far away has come to the breakpoints on the way."""
    client = Client(lineshaft)
    client.launch(program, {motor: [{"line": line("count := count + 1;"), "hitCondition": "30"}]}, stopOnEntry=True)
    client.event("stopped")
    client.step("lineshaft/goTo", 2, time=200_000_000, scan=1, statement=1)
    assert client.value("Outputs", "count", 2) == "20"
    client.step("continue", 2)
    assert client.value("Outputs", "count", 2) == "29"
    client.end()


def test_log_points():
    client = Client(lineshaft)
    client.launch(program, {motor: [{"line": line("count := count + 1;"), "logMessage": "now {speed} {count * 2} {no} {{x}} }} {{{count}}}"}]})
    logged = []
    while (event := client._next("output"))["event"] != "exited":
        if event["event"] == "output" and event["body"]["output"].startswith("now"):
            logged.append(event["body"]["output"])
    assert len(logged) == 101 and logged[5] == "now 3.0 mm/s 10 <'no' is not known here> {x} } {5}\n", logged[:7]
    client.end()


def test_watches():
    client = Client(lineshaft)
    client.launch(program, {motor: [line("ramp(goal := 3.0, speed => speed);")]})
    for _ in range(6):
        client.event("stopped")
        client.request("continue", threadId=2)
    client.event("stopped")
    frame = client.stack(2)[0]["id"]

    def value(text):
        return client.request("evaluate", expression=text, frameId=frame)["result"]

    for text, wanted in (("count", "6"), ("count + 2 * 3", "12"), ("speed > 2.0", "TRUE"), ("ramp.steps", "6"),
                         ("table[2] = 12", "TRUE"), ("mode", "Mode#running"), ("mode = Mode#idle", "FALSE"),
                         ("speed", "3.0 mm/s"), ("NOT (a = b) OR FALSE", "FALSE"), ("count MOD 4", "2"),
                         ("T#1s + T#500ms", "T#1s500ms"), ("motor.speed", "3 mm/s"), ("inputs.start", "true")):
        assert value(text) == wanted, (text, value(text))
    for text, wanted in (("nothing", "not known"), ("table[301]", "index"), ("count / 0", "zero"), ("Clamp(1.0, 2.0)", "changes"),
                         ("count :=", "expected"), ("1; 2", "statement"), ("1; count", "one expression")):
        try:
            raise AssertionError((text, value(text)))
        except Refused as why:
            assert wanted in str(why), (text, why)
    client.end()


def parts():
    """A program with blocks in blocks, of which one waits at its last statement."""
    path = folder / "parts.yaml"
    path.write_text("lineshaft: 1\ntasks: {t: {every: 10 ms}}\nsources: parts.st\nblocks: {main: {type: Main, task: t}, other: {type: Main, task: t}}\n"
                    "run: {for: 0.1 s}\ntrace: {task: t, signals: [main.n]}\n", encoding="utf-8")
    path.with_suffix(".st").write_text(
        "TYPE Mode : (off, slow, fast); END_TYPE\n"
        "FUNCTION_BLOCK Inner\nVAR_INPUT goal : REAL; END_VAR\nVAR_OUTPUT total : INT; END_VAR\nVAR seen : BOOL; END_VAR\n"
        "total := total + 1;\nseen := TRUE;\nEND_FUNCTION_BLOCK\n"
        "PROGRAM Main\nVAR b : BOOL; mode : Mode; n : INT; r : REAL := 1.1; tm : TIME := T#1s; day : DATE; w : WORD; long : LREAL;\n"
        "name : STRING := 'abc'; t : TON; c : Inner; table : ARRAY[1..3] OF INT; END_VAR\n"
        "n := n + 1;\nt(IN := TRUE, PT := T#20ms);\nc();\nb := NOT b;\nEND_PROGRAM\n", encoding="utf-8")
    return path, path.with_suffix(".st")


def test_memory_that_is_shared():
    """Members of a UNION, and variables at addresses as they stand there now; neither is set by hand."""
    source, of_it = folder / "shared.st", folder / "shared.yaml"
    source.write_text("VAR_GLOBAL lamp AT %QW4 : WORD; END_VAR\n"
                      "TYPE Pair : STRUCT low, high : WORD; END_STRUCT END_TYPE\n"
                      "TYPE Bytes : UNION whole : DWORD; each : ARRAY[0..3] OF BYTE; real : REAL; pair : Pair; END_UNION END_TYPE\n"
                      "PROGRAM Main\n"
                      "VAR all : ARRAY[1..2] OF Bytes; beside : LWORD := 16#1122334455667788;\n"
                      "word AT %MW10 : WORD; bit AT %QX0.1 : BOOL; END_VAR\n"
                      "all[2].whole := 16#3F800001; word := 16#ABCD; bit := TRUE; lamp := 7;\n"
                      "beside := beside;\nEND_PROGRAM\n", encoding="utf-8")
    of_it.write_text("lineshaft: 1\ntasks: {main: {every: 10 ms}}\ndialect: codesys\nsources: shared.st\n"
                     "blocks: {p: {type: Main, task: main}}\nrun: {for: 10 ms}\n", encoding="utf-8")
    client = Client(lineshaft)
    client.launch(of_it, {source: [{"line": 8, "condition": "all[2].each[3] = 16#3F"}]})
    client.event("stopped")
    frame = client.stack()[0]["id"]

    def value(text):
        return client.request("evaluate", expression=text, frameId=frame)["result"]

    members = {"whole": "16#3F800001", "each[0]": "16#1", "each[3]": "16#3F", "real": "1.0000001", "pair.low": "16#1",
               "pair.high": "16#3F80"}
    assert {name: value("all[2]." + name) for name in members} == members
    assert [value(name) for name in ("all[1].pair.high", "word", "bit", "lamp", "word + 1")] == ["16#0", "16#ABCD", "TRUE", "16#7", "43982"]
    shown = client.inside(client.request("evaluate", expression="all[2].pair", frameId=frame)["variablesReference"])
    assert {name: v["value"] for name, v in shown.items()} == {"low": "16#1", "high": "16#3F80"}
    assert (client.value("Locals", "word"), client.value("Locals", "bit")) == ("16#ABCD", "TRUE")
    client.end()


def test_watches_as_the_program_reckons():
    """Types of the language: REAL in its own precision, INT that leaves its range; names of the program and of the catalogue."""
    path, text = parts()
    client = Client(lineshaft)
    client.launch(path, {text: [{"line": 15, "condition": "r = 1.1 AND n >= 3"}]})
    assert client.event("stopped")["reason"] == "breakpoint"
    frame = client.stack()[0]["id"]

    def value(text):
        return client.request("evaluate", expression=text, frameId=frame)["result"]

    for watched, wanted in (("r = 1.1", "TRUE"), ("r + 0.2", "1.3000001"), ("n + INT#32767", "-32766"), ("t.ET", "T#20ms"), ("t.Q", "TRUE"),
                            ("NOT t.q", "FALSE"), ("other.n > 1", "TRUE"), ("other.r = 1.1", "TRUE"), ("main.t.q = TRUE", "TRUE"),
                            ("other.mode = Mode#off", "TRUE"), ("mode = off", "TRUE"), ("mode = Mode.off", "TRUE"), ("other.table[2] + 1", "1"),
                            ("ABS(-3)", "3"), ("LEN(name)", "3"), ("DINT_TO_REAL(7)", "7.0"), ("MAX(n, 40)", "40"),
                            ("n > 5 AND_THEN table[n] > 0", "FALSE"), ("tm + T#1s", "T#2s"), ("name = 'abc'", "TRUE")):
        assert value(watched) == wanted, (watched, value(watched))
    for watched, wanted in (("t.none", "not known"), ("other.none", "not"), ("c = 1", "no value"), ("Mode#none", "no value")):
        try:
            raise AssertionError((watched, value(watched)))
        except Refused as why:
            assert wanted in str(why), (watched, why)
    client.end()


def test_axis_of_a_call():
    """What an AXIS_REF is to has the values that the scan sees, in a condition, a text to log and a watch."""
    path = folder / "axis.yaml"
    path.write_text("lineshaft: 1\ntasks: {servo: {every: 1 ms, priority: 20}, main: {every: 10 ms}}\nsources: axis.st\n"
                    "blocks: {x: {type: axis, task: servo}, job: {type: Job, task: main, axis: x}}\nrun: {for: 0.5 s}\n", encoding="utf-8")
    text = path.with_suffix(".st")
    text.write_text("FUNCTION_BLOCK Job\nVAR_IN_OUT axis : AXIS_REF; END_VAR\nVAR move : MC_MoveRelative; none : AXIS_REF; seen : LREAL; END_VAR\n"
                    "seen := axis.position;\n"
                    "move(Axis := axis, Execute := TRUE, Distance := 10.0, Velocity := 50.0);\nEND_FUNCTION_BLOCK\n", encoding="utf-8")
    client = Client(lineshaft)
    placed = client.launch(path, {text: [{"line": 5, "condition": "axis.position > 5.0"}]})
    assert placed[text][0]["verified"]
    stopped = client.event("stopped")
    assert stopped["reason"] == "breakpoint"
    frame = client.stack(stopped["threadId"])[0]["id"]

    def value(text):
        return client.request("evaluate", expression=text, frameId=frame)["result"]

    assert 5.0 < float(value("axis.position")) < 6.0, value("axis.position")
    assert value("axis.Position = seen") == "TRUE"
    for watched, wanted in (("axis", "x"), ("none", "none"), ("axis.velocity > 40.0", "TRUE"), ("axis.state", "axis.state#discrete_motion")):
        assert value(watched) == wanted, (watched, value(watched))
    for watched, wanted in (("axis.none", "not known"), ("none.position", "to nothing")):
        try:
            raise AssertionError((watched, value(watched)))
        except Refused as why:
            assert wanted in str(why), (watched, why)
    shown = client.inside(client.scopes(frame)["In and out"])["axis"]
    of_block = client.inside(client.inside(client.scopes(frame)["Locals"])["move"]["variablesReference"])["Axis"]
    assert (shown["value"], of_block["value"], of_block["type"]) == ("x", "x", "axis"), (shown, of_block)
    assert client.inside(of_block["variablesReference"]).keys() == client.inside(shown["variablesReference"]).keys()
    assert float(client.inside(of_block["variablesReference"])["position"]["value"]) == float(value("axis.position"))
    assert value(of_block["evaluateName"]) == "x"
    client.end()


def test_parts_are_changed():
    """Whatever is a signal of the program, from each frame, as the view of variables shows its value."""
    path, text = parts()
    client = Client(lineshaft)
    client.launch(path, {text: [7]})
    client.event("stopped")

    def change(frame, way, name, value):
        reference = client.scopes(client.stack()[frame]["id"])[way[0]]
        for step in way[1:]:
            reference = client.inside(reference)[step]["variablesReference"]
        evaluated = client.inside(reference)[name]["evaluateName"]
        log = len(client.events)
        client.request("setVariable", variablesReference=reference, name=name, value=value)
        return evaluated, client.events[log:]

    def refused(*what):
        try:
            raise AssertionError((what, change(*what)))
        except Refused as why:
            return str(why)

    assert change(0, ["Outputs"], "total", "5")[0] == "main.c.total"
    assert change(0, ["Locals"], "seen", "TRUE")[0] == "main.c.seen"
    assert change(0, ["Inputs"], "goal", "REAL#1.5")[0] == "main.c.goal"
    assert change(1, ["Locals", "c", "Outputs"], "total", "16#7F")[0] == "main.c.total"
    assert change(1, ["Locals", "table"], "[2]", "12")[0] == "main.table[2]"
    assert change(1, ["Locals", "t"], "et", "T#10ms")[0] == "main.t.et"
    for name, value in (("b", "FALSE"), ("mode", "Mode#fast"), ("mode", "FAST"), ("tm", "t#2s"), ("tm", "LTIME#2s"), ("tm", "2 s"),
                        ("day", "D#2024-02-29"), ("w", "WORD#16#00FF"), ("n", "-1_000"), ("long", "LREAL#1.0E3")):
        assert change(1, ["Locals"], name, value)[0] == f"main.{name}"
    assert refused(1, ["Locals"], "n", "99999") == "'99999' is out of range for 'main.n'"
    assert refused(1, ["Locals"], "mode", "77") == "'77' is not a value of 'main.mode'"
    placed = client.request("setFunctionBreakpoints", breakpoints=[
        {"name": "main.mode"}, {"name": "main.mode = Mode#fast"}, {"name": "main.n", "condition": "TRUE"}, {"name": "main.n > 1", "hitCondition": "2"}])
    assert [b.get("message", "")[:40] for b in placed["breakpoints"]] == [
        "'true' is not a value of 'main.mode'", "", *["the name is the condition, and counts no"] * 2], placed
    client.breakpoints(text)
    client.request("continue", threadId=1)
    assert client.event("stopped")["text"] == "main.mode = Mode#fast"
    client.step("stepBack")
    client.end()


def test_watches_through_references():
    """Pointers into arrays, REFERENCE TO, THIS, lists of globals and bits, as the machine finds them."""
    tests = folder / "links_test.st"
    tests.write_text("DATA_BLOCK Recipe\nVAR target : INT := 3; END_VAR\nBEGIN\nEND_DATA_BLOCK\n"
                     "TYPE Row : STRUCT a : INT; b : DINT; END_STRUCT END_TYPE\n"
                     "VAR_GLOBAL limit : INT := 7; END_VAR\n"
                     "FUNCTION_BLOCK Link\nVAR rows : ARRAY[0..3] OF Row; at : REF_TO Row; seen : REF_TO Link; w : WORD := 16#28; sum : INT; END_VAR\n"
                     "METHOD Follow : INT\nVAR_INPUT step : INT; END_VAR\n"
                     "rows[2].b := 25;\nat := REF(rows[2]);\nseen := REF(THIS^);\nFollow := step + limit;\nsum := Follow;\n"
                     "END_METHOD\nEND_FUNCTION_BLOCK\n"
                     "TEST 'follows'\nVAR link : Link; END_VAR\nASSERT_EQ(link.Follow(step := 2), 9);\nEND_TEST\n", encoding="utf-8")
    client = Client(lineshaft)
    client.launch(tests, {tests: [15]}, test="follows")
    client.event("stopped")
    frame = client.stack()[0]["id"]

    def value(text):
        return client.request("evaluate", expression=text, frameId=frame)["result"]

    for text, wanted in (("at^.b", "25"), ("seen^.rows[2].b + step", "27"), ("THIS^.at^.b", "25"), ("limit", "7"),
                         ("links_test.limit", "7"), ("w.3", "TRUE"), ("w.%X4", "FALSE"), ("seen^.seen^.w", "16#28"), ("Follow", "9")):
        assert value(text) == wanted, (text, value(text))
    for text, wanted in (("step^", "no pointer"), ("w.77", "not known"), ("nowhere.x", "not known"),
                         ("nowhere.limit", "not known"), ("target", "not known")):
        try:
            raise AssertionError((text, value(text)))
        except Refused as why:
            assert wanted in str(why), (text, why)
    client.breakpoints(tests)
    client.request("continue", threadId=1)
    client.event("exited")
    client.end()


def test_signals():
    client = Client(lineshaft)
    client.launch(program, stopOnEntry=True)
    client.event("stopped")
    placed = client.request("setFunctionBreakpoints", breakpoints=[
        {"name": "motor.speed >= 2 mm/s"}, {"name": "delay.q"}, {"name": "time >= 500 ms"}, {"name": "motor.none"}])
    assert [b["verified"] for b in placed["breakpoints"]] == [True, True, True, False]
    found = []
    for _ in range(3):
        stop = client.step("continue", 2)
        assert stop["reason"] == "function breakpoint", stop
        found.append((stop["text"], client.stack(1)[0]["name"]))
    assert found == [("motor.speed >= 2 mm/s", "task fast at 0.03 s"), ("delay.q", "task fast at 0.052 s"),
                     ("time >= 500 ms", "task fast at 0.5 s")], found
    stop = client.step("reverseContinue", 2)
    assert (stop["reason"], stop["text"]) == ("function breakpoint", "delay.q"), stop
    assert client.stack(1)[0]["name"] == "task fast at 0.052 s"
    client.end()


def test_changes_by_hand():
    """What was changed is recorded, and run again to the same bytes; in the past it cuts off what was to come."""
    recording = folder / "hand.yaml"
    client = Client(lineshaft)
    client.launch(program, {motor: [line("count := count + 1;")]},
                  args=["--trace", str(folder / "hand.csv"), "--record", str(recording)])
    client.event("stopped")

    def change(scope, name, value):
        reference = client.scopes(client.stack(2)[0]["id"])[scope]
        client.request("setVariable", variablesReference=reference, name=name, value=value)

    for _ in range(10):
        client.step("continue", 2)
    change("Outputs", "count", "50")
    client.step("continue", 2)
    client.step("continue", 2)
    late = client.value("Outputs", "count", 2)
    for _ in range(6):
        client.step("reverseContinue", 2)
    assert client.value("Outputs", "count", 2) == "6"
    for _ in range(6):
        client.step("continue", 2)
    assert client.value("Outputs", "count", 2) == late
    client.breakpoints(motor)
    client.request("continue", threadId=2)
    client.event("exited")
    client.end()
    assert "motor.count: 50" in recording.read_text(), recording.read_text()
    assert traced("hand")[0] != run(program)[0]
    assert traced("hand")[0] == run(program, "--recording", recording)[0]


def test_last_writer():
    client = Client(lineshaft)
    client.launch(program, {motor: [line("a := count;")]})
    client.event("stopped")
    for _ in range(5):
        client.step("continue", 2)
    reference = client.scopes(client.stack(2)[0]["id"])["Locals"]
    client.step("lineshaft/lastWriter", 2, variablesReference=reference, name="mode")
    assert client.line(2)[1] == line("mode := Mode#running;")
    assert client.value("Locals", "mode", 2) == "Mode#idle"
    client.end()


def test_random_points(points=60, seed=1):
    """Forwards, back, forwards: the state is that of the run in a piece."""
    client = Client(lineshaft)
    client.launch(program, {motor: [line("table[i] := table[i] + i;"), line("Clamp := x;")]})
    client.event("stopped")
    known = []
    for _ in range(120):
        known.append(client.request("lineshaft/state"))
        client.step("continue", 2)
    chance = random.Random(seed)
    for _ in range(points):
        at = chance.randrange(1, len(known) - 1)
        for step, command in ((0, "lineshaft/goTo"), (1, "continue"), (0, "reverseContinue")):
            place = {k: known[at][k] for k in ("time", "scan", "statement")} if step == 0 and "goTo" in command else {}
            client.step(command, 2, **place)
            found = client.request("lineshaft/state")
            for key in ("time", "scan", "statement", "fingerprint"):
                assert found[key] == known[at + step][key], (key, at, command, found, known[at + step])
    client.end()


def test_plain_tasks():
    """A task without Structured Text is stepped scan by scan."""
    client = Client(lineshaft)
    client.launch(program, stopOnEntry=True)
    client.event("stopped")
    for time in ("0.004", "0.008", "0.012"):
        client.step("next", 1)
        assert client.stack(1)[0]["name"] == f"task fast at {time} s", client.stack(1)
    client.step("stepBack", 1)
    assert client.stack(1)[0]["name"] == "task fast at 0.008 s", client.stack(1)
    client.end()


def test_pause_and_terminate():
    long = folder / "long.yaml"
    long.write_text(program.read_text().replace("for: 1 s", "for: 100 h").replace("sources: ", f"sources: {source}/tests/debug/"))
    client = Client(lineshaft)
    client.launch(long, args=["--include-dir", str(source)])
    try:
        client.request("stackTrace", threadId=1)
        raise AssertionError("a stack of a machine that runs")
    except Refused as why:
        assert "runs" in str(why)
    assert client.step("pause", 1)["reason"] == "pause"
    client.request("terminate")
    client.event("terminated")
    assert client.end() == 130


def refused_launch(tests, name):
    """What is said of a TEST that cannot be launched."""
    client = Client(lineshaft, tests, "--test", name)
    client.request("initialize")
    try:
        raise AssertionError(client.request("launch"))
    except Refused as why:
        return str(why)
    finally:
        client.end()


def test_structured_text_tests():
    """A TEST is a machine whose only scan runs it; what fails is told, SETUP and TEARDOWN are scans of their own."""
    tests = folder / "mark_test.st"
    tests.write_text("FUNCTION_BLOCK Adder VAR_INPUT a : INT; END_VAR VAR_OUTPUT sum : INT; END_VAR\n"
                     "sum := sum + a;\nEND_FUNCTION_BLOCK\n"
                     "SETUP\nVAR adder : Adder; END_VAR\nadder(a := 40);\nEND_SETUP\n"
                     "TEST 'adds'\nVAR more : INT; END_VAR\nmore := 2;\nadder(a := more);\nASSERT_EQ(adder.sum, 42);\nEND_TEST\n"
                     "TEST 'adds wrong'\nASSERT_EQ(adder.sum, 41);\nEND_TEST\n"
                     "TEARDOWN\nadder(a := 0);\nEND_TEARDOWN\n", encoding="utf-8")
    client = Client(lineshaft)
    placed = client.launch(tests, {tests: [2, 11]}, test="adds")
    assert [b["verified"] for b in placed[tests]] == [True, True], placed
    seen = []
    client.event("stopped")
    for _ in range(3):
        seen.append(client.line())
        client.step("continue")
    assert seen == [("Adder", 2), ("TEST 'adds' (TEST)", 11), ("Adder", 2)], seen
    frame = client.stack()[1]["id"]
    assert client.line() == ("Adder", 2) and client.stack()[1]["line"] == 18, client.stack()
    assert client.request("evaluate", expression="adder.sum", frameId=frame)["result"] == "42"
    client.step("reverseContinue")
    assert client.line() == ("Adder", 2) and client.stack()[1]["line"] == 11, client.stack()
    client.step("reverseContinue")
    assert client.line() == ("TEST 'adds' (TEST)", 11) and client.value("Locals", "more") == "2", client.line()
    client.breakpoints(tests)
    client.request("continue", threadId=1)
    assert client.event("exited") == {"exitCode": 0}
    client.end()
    client = Client(lineshaft)
    client.launch(tests, test="adds wrong")
    assert client.event("exited") == {"exitCode": 1}
    told = "".join(e["body"]["output"] for e in client.events if e["event"] == "output")
    assert client.end() == 1
    failing = folder / "fails_test.st"
    failing.write_text(tests.read_text().replace("TEARDOWN\nadder", "TEST 'divides'\nASSERT_EQ(Divided(0), 1);\nEND_TEST\nTEARDOWN\nadder") +
                       "FUNCTION Divided : INT\nVAR_INPUT parts : INT; END_VAR\nDivided := 100 / parts;\nEND_FUNCTION\n")
    for test, wanted in (("adds wrong", [("TEST 'adds wrong' (TEST)", 15)]), ("divides", [("Divided", 25), ("TEST 'divides' (TEST)", 18)])):
        client = Client(lineshaft)
        client.launch(failing, test=test, stopOnEntry=True)
        client.event("stopped")
        client.request("setExceptionBreakpoints", filters=["block_error"])
        assert client.step("continue")["reason"] == "exception"
        found = [(each["name"], each["line"]) for each in client.stack()][:-1]
        assert found == wanted, found  # where it failed, whatever TEARDOWN calls behind that
        client.end()
    client = Client(lineshaft)  # in a folder, beside what is no test and what has mistakes
    whole = folder / "whole/test"
    whole.mkdir(parents=True)
    (whole / "mark_test.st").write_text(tests.read_text())
    (whole / "bad_test.st").write_text("TEST 'adds'\nnothing := 1;\nEND_TEST\n")
    (whole.parent / "plain.yaml").write_text("lineshaft: 1\n")
    client.launch(whole.parent, {whole / "mark_test.st": [11]}, test="adds")
    client.event("stopped")
    assert client.line() == ("TEST 'adds' (TEST)", 11), client.line()
    client.end()
    assert "adds, adds wrong" in refused_launch(tests, "nothing")
    suite = folder / "suite.TcPOU"
    suite.write_text('<?xml version="1.0"?>\n<TcPlcObject><POU Name="MAIN"><Declaration>PROGRAM MAIN</Declaration>'
                     "<Implementation><ST>TcUnit.RUN();</ST></Implementation></POU></TcPlcObject>\n")
    assert "lineshaft new suites --from" in refused_launch(suite, "adds")


def value_in(client, frame):
    return lambda text: client.request("evaluate", expression=text, frameId=frame)["result"]


def refusals_of(value, *cases):
    """Of each expression what is said of it."""
    for text, wanted in cases:
        try:
            raise AssertionError((text, value(text)))
        except Refused as why:
            assert wanted in str(why), (text, why)


def test_properties():
    """GET is called on a copy: nothing of the run changes, whatever it does, and one without an end is stopped."""
    text, path = folder / "properties.st", folder / "properties.yaml"
    text.write_text("INTERFACE IAny\nPROPERTY Twice : INT GET END_GET END_PROPERTY\nEND_INTERFACE\n"
                    "FUNCTION Sum : INT\nVAR_INPUT a : INT; END_VAR\nIF a > 0 THEN Sum := a + Sum(a - 1); END_IF\nEND_FUNCTION\n"
                    "TYPE Pair : STRUCT a, b : INT; END_STRUCT END_TYPE\n"
                    "FUNCTION_BLOCK Base IMPLEMENTS IAny\nVAR n : INT := 4; calls : INT := 3; list : ARRAY[1..3] OF INT; END_VAR\n"
                    "{attribute 'monitoring' := 'call'}\nPROPERTY Twice : INT\nGET\ncalls := calls + 1; list[1] := 7; Twice := n * 2;\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY Deep : INT\nGET\nDeep := Sum(calls);\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY Name : STRING\nGET\nName := 'me';\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY Both : Pair\nGET\nBoth.a := n; Both.b := calls;\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY Wrong : INT\nGET\nWrong := list[n];\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY Endless : INT\nGET\nWHILE n > 0 DO Endless := 1; END_WHILE\nEND_GET\nEND_PROPERTY\n"
                    "PROPERTY First : REFERENCE TO INT\nGET\nFirst REF= list[1];\nEND_GET\nEND_PROPERTY\nEND_FUNCTION_BLOCK\n"
                    "FUNCTION_BLOCK Derived EXTENDS Base\nVAR more : INT; END_VAR\n"
                    "PROPERTY OVERRIDE Twice : INT\nGET\nTwice := SUPER^.Twice + 1000;\nEND_GET\nEND_PROPERTY\n"
                    "METHOD Also\nmore := more + 1;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
                    "PROGRAM Main\nVAR m : Base; d : ARRAY[0..2] OF Derived; at : REF_TO Base; i, none : IAny; r, scans : INT; END_VAR\n"
                    "at := REF(d[1]);\ni := d[2];\nd[1].Also();\nr := at^.Twice + i.Twice;\nscans := scans + 1;\nEND_PROGRAM\n", encoding="utf-8")
    path.write_text("lineshaft: 1\ntasks: {t: {every: 10 ms}}\nsources: properties.st\nblocks: {main: {type: Main, task: t}}\n"
                    "run: {for: 0.1 s}\ntrace: {task: t, signals: [main.r, main.m.calls]}\n", encoding="utf-8")
    at = {line: number for number, line in enumerate(text.read_text().splitlines(), 1)}
    client = Client(lineshaft)
    client.launch(path, {text: [{"line": at["scans := scans + 1;"], "condition": "m.Twice = 8 AND scans = 2"}]},
                  args=["--trace", str(folder / "properties.csv")])
    assert client.event("stopped")["reason"] == "breakpoint"
    frame = client.stack()[0]["id"]
    value, before = value_in(client, frame), client.request("lineshaft/state")["fingerprint"]
    for watched, wanted in (("scans", "2"), ("m.Twice", "8"), ("m.Twice + m.calls", "11"), ("m.Deep", "6"), ("m.Name", "'me'"), ("LEN(m.Name)", "2"),
                            ("m.Both.b", "3"), ("m.First", "0"), ("d[0].Twice", "1008"), ("at^.Twice", "1008"), ("i.Twice", "1008")):
        assert value(watched) == wanted, (watched, value(watched))
    refusals_of(value, ("m.Wrong", "GET of Base.Wrong ends with the fault array_bounds, at"), ("m.Endless", "the fault no_end"),
                ("none.Twice", "'none' is to nothing"), ("m.None", "not known"), ("m.Also()", "changes nothing"))
    of_m = client.inside(client.inside(client.scopes(frame)["Locals"])["m"]["variablesReference"])
    shown = client.inside(of_m["Properties"]["variablesReference"])
    assert {name: (v["value"], v["evaluateName"]) for name, v in shown.items()} == {"Twice": ("8", "m.Twice")}, shown
    assert client.request("lineshaft/state")["fingerprint"] == before
    client.breakpoints(text, at["more := more + 1;"])
    client.step("continue")
    value = value_in(client, client.stack()[0]["id"])
    assert [value(each) for each in ("Twice", "THIS^.Twice", "SUPER^.Twice", "SUPER^.n")] == ["1008", "1008", "8", "4"]
    client.breakpoints(text)
    client.request("continue", threadId=1)
    client.event("exited")
    client.end()
    assert traced("properties") == run(path)


def test_watches_of_all_that_the_language_names():
    """ARRAY[*] by its bounds, bytes of other values, characters, SIZEOF, addresses as the scan has them, WSTRING."""
    text, path = folder / "named.st", folder / "named.yaml"
    text.write_text("FUNCTION Total : INT\nVAR_IN_OUT ar : ARRAY[*] OF INT; two : ARRAY[*, *] OF INT; END_VAR\n"
                    "Total := ar[LOWER_BOUND(ar, 1)] + two[2, 1];\nEND_FUNCTION\n"
                    "PROGRAM Main\nVAR list : ARRAY[3..6] OF INT := [30, 40, 50, 60]; grid : ARRAY[1..2, 0..2] OF INT; motor, main : INT := 5;\n"
                    "w : WORD := 16#1234; pb : POINTER TO BYTE; pi : POINTER TO INT; s : STRING(20) := 'abc'; wide : WSTRING(10) := \"a'$\"b\";\n"
                    "word AT %MW10 : WORD; r, n : INT; END_VAR\n"
                    "grid[2, 1] := 21; pb := ADR(w) + 1; pi := ADR(list[4]); word := word + 1;\nr := Total(list, grid);\nn := n + 1;\nEND_PROGRAM\n",
                    encoding="utf-8")
    path.write_text("lineshaft: 1\ntasks: {t: {every: 10 ms}}\ndialect: codesys\nsources: named.st\nblocks: {main: {type: Main, task: t}}\n"
                    "run: {for: 0.1 s}\ntrace: {task: t, signals: [main.r, '%MW10']}\n", encoding="utf-8")
    client = Client(lineshaft)
    client.launch(path, {text: [3]})
    client.event("stopped")
    frame = client.stack()[0]["id"]
    value, scopes = value_in(client, frame), client.scopes(frame)
    assert [value(each) for each in ("ar[4]", "two[2, 1]", "two[2][1]", "ar[4] + 1")] == ["40", "21", "21", "41"]
    refusals_of(value, ("ar[2]", "'2' is not an index from 3 to 6"))
    given = client.inside(scopes["In and out"])
    assert list(given) == ["ar", "two"] and given["ar"]["value"] == "ARRAY[3..6] OF INT" and given["ar"]["indexedVariables"] == 4, given
    elements = client.inside(given["ar"]["variablesReference"])
    assert {name: v["value"] for name, v in elements.items()} == {"[3]": "30", "[4]": "40", "[5]": "50", "[6]": "60"}
    client.breakpoints(text, 11)
    client.step("continue")
    value = value_in(client, client.stack()[0]["id"])
    for watched, wanted in (("pb^", "16#12"), ("pb[0]", "16#12"), ("pi^", "40"), ("pi[1]", "50"), ("s[0]", "16#61"), ("s[3]", "16#0"),
                            ("SIZEOF(s)", "21"), ("SIZEOF(grid)", "12"), ("SIZEOF(INT)", "2"), ("wide", "\"a'$\"b\""), ("wide[1]", "16#27"),
                            ("%MW10", "16#1"), ("%MB20", "16#1"), ("%MX20.0", "TRUE"), ("main", "5"), ("list", "ARRAY[3..6] OF INT")):
        assert value(watched) == wanted, (watched, value(watched))
    assert value("main.r") in ("0", "51"), value("main.r")  # the signal, though 'main' is a number here
    refusals_of(value, ("pi[9]", "to nothing"), ("s[30]", "no such character"), ("%MW9999", "not in the memory"))
    shown = client.inside(client.scopes(client.stack()[0]["id"])["Locals"])
    assert [client.inside(shown[name]["variablesReference"])[part]["evaluateName"] for name, part in (("grid", "[1]"), ("pb", "^"))] == ["grid[1]", "pb^"]
    client.end()


def test_what_is_no_signal_is_changed():
    """Texts and members of a UNION, as an assignment gives them a value, and what is shown before it counts."""
    text, path = folder / "unions.st", folder / "unions.yaml"
    text.write_text("TYPE Mode : (off, slow, fast); END_TYPE\nTYPE Pair : STRUCT low, high : WORD; END_STRUCT END_TYPE\n"
                    "TYPE Bytes : UNION whole : DWORD; pair : Pair; each : ARRAY[0..3] OF BYTE; END_UNION END_TYPE\n"
                    "FUNCTION_BLOCK Inner\nVAR name : STRING(5) := 'abc'; END_VAR\nname := name;\nEND_FUNCTION_BLOCK\n"
                    "PROGRAM Main\nVAR u : Bytes; w : WSTRING(9); c : Inner; at : REF_TO INT; mode : Mode; n : INT; seen : INT; END_VAR\nVAR_TEMP t : STRING(9); END_VAR VAR CONSTANT fixed : STRING(9) := 'f'; END_VAR\n"
                    "n := n + 1;\nc();\nseen := LEN(c.name);\nEND_PROGRAM\n", encoding="utf-8")
    path.write_text("lineshaft: 1\ntasks: {t: {every: 10 ms}}\nsources: unions.st\nblocks: {main: {type: Main, task: t}}\n"
                    "run: {for: 0.1 s}\ntrace: {task: t, signals: [main.seen, main.n]}\n", encoding="utf-8")
    client = Client(lineshaft)
    client.launch(path, {text: [12]}, args=["--trace", str(folder / "unions.csv")])
    client.event("stopped")

    def change(way, name, value):
        """The answer, and what a watch shows before the next scan."""
        reference = client.scopes(client.stack()[0]["id"])[way[0]]
        for step in way[1:]:
            reference = client.inside(reference)[step]["variablesReference"]
        name_of = client.inside(reference)[name]["evaluateName"].removeprefix("main.")
        answer = client.request("setVariable", variablesReference=reference, name=name, value=value)["value"]
        assert answer == client.request("evaluate", expression=name_of, frameId=client.stack()[0]["id"])["result"], answer
        return answer

    assert change(["Locals", "u", "pair"], "high", "16#1234") == "16#0 (16#1234 from the next instant on)"
    assert change(["Locals", "u", "each"], "[0]", "255") == "16#0 (16#FF from the next instant on)"
    assert change(["Locals"], "w", '"it"') == '"" ("it" from the next instant on)'
    assert change(["Locals", "c", "Locals"], "name", "'four'") == "'abc' ('four' from the next instant on)"
    assert change(["Locals"], "mode", "2") == "Mode#off (fast from the next instant on)"
    for way, name, value, wanted in ((["Locals"], "mode", "3", "not a value"), (["Temporaries"], "t", "'a'", "no place that lasts"),
                                     (["Locals", "c", "Locals"], "name", "'too long'", "too long"), (["Locals", "u"], "pair", "1", "part by part"),
                                     (["Locals", "u"], "whole", "'a'", "DWORD"),
                                     (["Locals"], "fixed", "'a'", "nothing that can be set"), (["Locals"], "at", "NULL", "refers to something")):
        try:
            raise AssertionError(change(way, name, value))
        except Refused as why:
            assert wanted in str(why), (name, why)
    client.step("continue")
    value = value_in(client, client.stack()[0]["id"])
    assert [value(each) for each in ("u.whole", "w", "c.name", "mode")] == ["16#123400FF", '"it"', "'four'", "Mode#fast"]
    client.step("reverseContinue")
    assert value_in(client, client.stack()[0]["id"])("c.name") == "'abc'"
    client.breakpoints(text)
    client.request("continue", threadId=1)
    client.event("exited")
    client.end()
    rows = (folder / "unions.csv").read_text().splitlines()[1:]
    assert [row.split(",")[2] for row in rows[:3]] == ["3", "4", "4"], rows[:3]
    client = Client(lineshaft)
    client.launch(path, {text: [12]}, args=["--record", str(folder / "none.yaml")])
    client.event("stopped")
    try:
        raise AssertionError(change(["Locals"], "w", '"it"'))
    except Refused as why:
        assert "leave --record out" in str(why), why
    client.end()


def test_suites():
    """RUN of TcUnit calls suites, so that a breakpoint in a test stops there."""
    suite = folder / "suite.st"
    suite.write_text("FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nAdds();\nMETHOD Adds\nTEST('adds');\n"
                     "AssertEquals_INT(3, 1 + 2, 'adds');\nTEST_FINISHED();\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
                     "PROGRAM MAIN\nVAR suites : ARRAY[1..2] OF Suite; END_VAR\nTcUnit.RUN();\nEND_PROGRAM\n")
    whole = folder / "suite.yaml"
    whole.write_text("lineshaft: 1\nsources: [suite.st]\ntasks: {main: {every: 10 ms}}\nrun: {for: 30 ms}\nblocks:\n"
                     "  MAIN: {type: MAIN, task: main}\n")
    client = Client(lineshaft)
    client.launch(whole, {suite: [5]})
    for _ in range(2):
        client.event("stopped")
        assert client.line() == ("Suite.Adds", 5), client.stack()
        client.request("continue", threadId=1)
    assert client.event("exited") == {"exitCode": 0}  # both are finished in the first cycle
    client.end()


def test_calls_that_meet_themselves():
    """An outer call shows its own variables, which a later call on its instance has put aside; and so does a function's."""
    tests = folder / "meets_test.st"
    tests.write_text("FUNCTION Sum : INT\nVAR_INPUT n : INT; END_VAR\nVAR twice : INT; END_VAR\ntwice := 2 * n;\n"
                     "IF n > 0 THEN\nSum := n + Sum(n - 1);\nELSE\nSum := 0;\nEND_IF\nEND_FUNCTION\n"
                     "INTERFACE IStep\nMETHOD Down : INT\nVAR_INPUT n : INT; END_VAR\nEND_METHOD\nEND_INTERFACE\n"
                     "FUNCTION_BLOCK Walker IMPLEMENTS IStep\nVAR next : IStep; calls : INT; END_VAR\n"
                     "METHOD Down : INT\nVAR_INPUT n : INT; END_VAR\nVAR list : ARRAY[0..2] OF INT; name : STRING(9); END_VAR\n"
                     "calls := calls + 1;\nnext := THIS^;\nlist[1] := n * 10;\nname := INT_TO_STRING(n);\n"
                     "IF n > 2 THEN\nDown := next.Down(n - 1);\nELSIF n > 0 THEN\nDown := Other(n - 1, list[1]);\nELSE\nDown := Sum(1);\nEND_IF\n"
                     "END_METHOD\n"
                     "METHOD Other : INT\nVAR_INPUT n : INT; END_VAR\nVAR_IN_OUT from : INT; END_VAR\nVAR own : INT; END_VAR\n"
                     "own := n + 50;\nOther := THIS^.Down(n) + from;\nown := own + from;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
                     "TEST 'goes down'\nVAR walker : Walker; END_VAR\nASSERT_EQ(walker.Down(3), 31);\nEND_TEST\n", encoding="utf-8")
    client = Client(lineshaft)
    client.launch(tests, {tests: [{"line": 8}]}, test="goes down")
    client.event("stopped")
    frames = client.stack()
    assert [f["name"] for f in frames[:8]] == ["Sum", "Sum", *("Walker." + m for m in ("Down", "Other", "Down", "Other", "Down", "Down"))], frames

    def value(frame, text):
        return client.request("evaluate", expression=text, frameId=frames[frame]["id"])["result"]

    assert [client.value("Inputs", "n", frame=i) for i in range(8)] == ["0", "1", "0", "0", "1", "1", "2", "3"]
    assert [value(i, "twice + n") for i in (0, 1)] == ["0", "3"]
    assert [value(i, "own * 2") for i in (3, 5)] == ["100", "102"]
    assert [value(i, "from") for i in (3, 5)] == ["10", "20"]
    assert [value(i, "list[1]") for i in (2, 4, 6, 7)] == ["0", "10", "20", "30"]
    assert [value(i, "name") for i in (2, 4, 6, 7)] == ["'0'", "'1'", "'2'", "'3'"]
    assert {value(i, "calls") for i in range(2, 8)} == {"4"}
    client.step("stepOut")
    frames = client.stack()
    assert frames[0]["name"] == "Walker.Other" and [value(i, "n") for i in range(5)] == ["0", "1", "1", "2", "3"], frames
    client.breakpoints(tests)
    client.request("continue", threadId=1)
    assert client.event("exited") == {"exitCode": 0}
    client.end()


def test_data_breakpoints():
    """Behind the statement that changes a variable, forwards and back; behind the instant for what no statement changes."""
    client = Client(lineshaft)
    client.launch(program, {motor: [line("Clamp := x;")]}, stopOnEntry=True)
    assert client.capabilities["supportsDataBreakpoints"] is True
    client.event("stopped")
    locals_of = client.scopes(client.stack(2)[0]["id"])["Locals"]
    ramp = client.inside(client.inside(locals_of)["ramp"]["variablesReference"])["Locals"]["variablesReference"]
    infos = {"mode": client.request("dataBreakpointInfo", variablesReference=locals_of, name="mode"),
             "steps": client.request("dataBreakpointInfo", variablesReference=ramp, name="steps"),
             "count": client.request("dataBreakpointInfo", name="count", frameId=client.stack(2)[0]["id"]),
             **{name: client.request("dataBreakpointInfo", name=name) for name in ("delay.q", "inputs.start")}}
    assert all(info["dataId"] and info["accessTypes"] == ["write"] for info in infos.values()), infos
    assert infos["steps"]["description"] == "motor.ramp.steps", infos
    client.step("continue", 2)
    refused = client.request("dataBreakpointInfo", name="most", frameId=client.stack(2)[0]["id"])
    assert refused["dataId"] is None and "'most'" in refused["description"], refused
    client.breakpoints(motor)
    client.step("lineshaft/goTo", 2, time=0, scan=1, statement=1)

    def watch(*names, **more):
        wanted = [{"dataId": infos.get(name, {}).get("dataId", name), **more} for name in names]
        return client.request("setDataBreakpoints", breakpoints=wanted)["breakpoints"]

    assert not any(b["verified"] for b in watch("nothing") + watch("mode", accessType="read") + watch("mode", hitCondition="3"))
    placed = watch("mode", "delay.q", "inputs.start")
    assert all(b["verified"] for b in placed), placed
    number = {b["id"]: name for b, name in zip(placed, ("mode", "delay.q", "inputs.start"))}
    way = []
    for _ in range(3):
        stop = client.step("continue", 2)
        assert stop["reason"] == "data breakpoint", stop
        way.append(([number[i] for i in stop["hitBreakpointIds"]], *client.line(stop["threadId"]), client.request("lineshaft/state")))
    names = [(changed, name) if name.startswith("task") else (changed, name, at) for changed, name, at, _ in way]
    assert names == [(["inputs.start"], "task fast at 0.025 s"), (["mode"], "Motor (motor)", line("IF b < 5 THEN")),
                     (["delay.q"], "task fast at 0.052 s")], names
    for changed, *_, state in reversed(way[:2]):
        stop = client.step("reverseContinue", 2)
        found = client.request("lineshaft/state")
        assert ([number[i] for i in stop["hitBreakpointIds"]], stop["reason"]) == (changed, "data breakpoint"), stop
        assert all(found[key] == state[key] for key in ("time", "scan", "statement")), (found, state)
    assert client.step("reverseContinue", 2)["reason"] == "entry"
    watch("steps", "count")
    found = []
    for _ in range(4):
        found.append((client.step("continue", 2)["reason"], *client.line(2)))
    ramp = ("data breakpoint", "Ramp", line("steps := steps + 1;") + 1)
    assert found == [ramp, ("data breakpoint", "task main at 0 s", 1), ramp, ("data breakpoint", "task main at 0.01 s", 1)], found
    client.end()


def test_protocols_own_client():
    if not (source / "tools/report/node_modules/@vscode/debugadapter-testsupport").exists():
        print("SKIPPED: @vscode/debugadapter-testsupport; tools/setup --tests installs it")
        return
    answer = subprocess.run(["node", source / "tests/debug_client.mjs", lineshaft, source], capture_output=True, text=True, timeout=200)
    assert answer.returncode == 0, answer.stdout + answer.stderr


def test_refusals():
    client = Client(lineshaft)
    client.request("initialize")
    for arguments, wanted in (({}, "no program is named"), ({"program": "none.yaml"}, "none.yaml"),
                              ({"program": str(program), "args": ["--nothing"]}, "--nothing")):
        try:
            client.request("launch", **arguments)
            raise AssertionError(arguments)
        except Refused as why:
            assert wanted in str(why), why
    client.end()
    client = Client(lineshaft)
    client.launch(program)
    client.event("terminated")
    try:
        client.request("evaluate", expression="motor.speed")
        raise AssertionError("the run has ended")
    except Refused as why:
        assert str(why) == "the run has ended", why
    client.end()


for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("ok", name[5:])
