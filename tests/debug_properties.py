#!/usr/bin/python3
"""`lineshaft debug` at random places of 20 programs: forwards, back and forwards again the state is that of a run in a
piece; who wrote a variable last, and where it changes next, is what a walk by single steps finds; a run that nobody stops has the bytes of `run`.

usage: debug_properties.py LINESHAFT SOURCE_DIR [POINTS] [WRITERS] [SEED]
"""

import pathlib
import random
import subprocess
import sys
import tempfile

from dap_client import Client, Refused

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
source = pathlib.Path(sys.argv[2]).resolve()
points, writers, seed = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((3, 60), (4, 40), (5, 1)))
folder = pathlib.Path(tempfile.mkdtemp())
PROGRAMS = ["tests/debug/motor.yaml", *(f"programs/{name}.yaml" for name in (
    "01_axis", "02_gear", "03_ratio_change", "04_circle", "05_pulses", "06_machine_logic", "08_state_machine", "09_own_block",
    "10_flying_shear", "11_rotary_knife", "13_served_line", "14_contour")), *(f"tests/cases/{name}/program.yaml" for name in (
        "structured_text_in_a_program", "axes_named_in_scl", "recipe_of_moves_in_scl", "process_image_is_wired",
        "digital_signals_in_structured_text", "error_holds_the_axis_and_run_goes_on", "replay_plays_a_recorded_trace"))]
# Who writes is asked of these, and of what beside their block's scalars.
WALKED = {"tests/debug/motor.yaml": ["table[1]", "table[3]", "ramp.steps", "ramp.speed"], "programs/04_circle.yaml": [],
          "programs/08_state_machine.yaml": [], "programs/09_own_block.yaml": [], "programs/10_flying_shear.yaml": [],
          "tests/cases/structured_text_in_a_program/program.yaml": []}


def place_of(state):
    return {key: state[key] for key in ("time", "scan", "statement")}


def state(client):
    found = client.request("lineshaft/state")
    return {key: found[key] for key in ("time", "scan", "statement", "fingerprint")}


def stopped(program):
    client = Client(lineshaft)
    client.launch(source / program, stopOnEntry=True, stopAtEnd=True)
    client.event("stopped")
    return client


def length_of(client):
    """When the run ends [ns]."""
    client.step("continue")
    return client.request("lineshaft/state")["time"]


def random_places(rng, end, count):
    """Statements of scans, and times between two instants; in their order."""
    places = []
    for _ in range(count):
        time = rng.choice((rng.randrange(1, end), rng.randrange(1, end), rng.randrange(1, max(2, end // 50)), end - rng.randrange(1, max(2, end // 50))))
        inside = rng.random() < 0.8
        places.append({"time": time, "scan": rng.randrange(1, 3) if inside else -1, "statement": rng.randrange(1, 12) if inside else 0})
    return sorted(places, key=lambda p: (p["time"], p["scan"] if p["scan"] > 0 else 1 << 60, p["statement"]))


def test_points():
    rng, count, threads = random.Random(seed), 0, 0
    for program in PROGRAMS:
        client = stopped(program)
        end = length_of(client)
        client.end()
        # In a piece: forwards only.
        client, known = stopped(program), []
        for place in random_places(rng, end, max(1, points // len(PROGRAMS))):
            client.step("lineshaft/goTo", **place)
            known.append(state(client))
        client.end()
        client = stopped(program)
        tasks = len(client.request("threads")["threads"])
        for at in rng.sample(range(len(known)), len(known)):
            # forwards or back to it, one step back or on by whatever task, and there again
            client.step("lineshaft/goTo", **place_of(known[at]))
            where = (program, seed, known[at])
            assert state(client) == known[at], (where, state(client))
            client.step(rng.choice(("stepBack", "stepIn", "next", "stepOut", "lineshaft/nextScan", "stepBack")), rng.randrange(1, tasks + 1))
            client.step("lineshaft/goTo", **place_of(known[at]))
            assert state(client) == known[at], (where, state(client), "again")
            count += 1
        threads += tasks
        client.end()
    return f"{count} points of {len(PROGRAMS)} programs with {threads} tasks"


def bottom(client, thread):
    """The frame of the block's body, if a routine of the task runs."""
    frames = client.stack(thread)
    return frames[-2] if len(frames) > 1 else None


def thread_with_code(client):
    for thread in client.request("threads")["threads"]:
        if bottom(client, thread["id"]):
            return thread["id"]
    raise AssertionError("no task runs Structured Text")


def references(client, frame):
    """Where the scalars of a block's outputs and locals stand: {name: (reference, name)}."""
    found = {}
    for scope, reference in client.scopes(frame["id"]).items():
        if scope in ("Outputs", "Locals"):
            found |= {name: reference for name, v in client.inside(reference).items() if not v["variablesReference"]}
    return found


def writer_by_walk(walk, at, name):
    """The last statement before that place behind which the variable had another value; None: it never had."""
    for before in range(at - 1, -1, -1):
        if walk[before][1][name] != walk[before + 1][1][name]:
            return place_of(walk[before][0])
    return None


def reference_to(client, frame, path):
    """The variablesReference and the name for `table[3]`, `ramp.steps`, `count`."""
    owner, _, part = path.replace("[", ".[").partition(".")
    inside = {}
    for scope, reference in client.scopes(frame["id"]).items():
        inside |= {name: (reference, v) for name, v in client.inside(reference).items()}
    if not part:
        return inside[owner][0], owner
    reference = inside[owner][1]["variablesReference"]
    if part in client.inside(reference):
        return reference, part
    for group in client.inside(reference).values():
        if part in client.inside(group["variablesReference"]):
            return group["variablesReference"], part
    raise AssertionError(path)


def walk_of(client, thread, parts, steps):
    """Statement by statement of the block that runs: where it is, and the values then, by name."""
    walk, block = [], bottom(client, thread)["name"]
    names = list(references(client, bottom(client, thread))) + parts
    while len(walk) < steps:
        frame = bottom(client, thread)
        if frame and frame["name"] == block:
            shown = {}
            for scope, reference in client.scopes(frame["id"]).items():
                if scope in ("Outputs", "Locals"):
                    shown |= {name: v["value"] for name, v in client.inside(reference).items()}
            values = {name: client.request("evaluate", expression=name, frameId=frame["id"])["result"] if name in parts else shown[name]
                      for name in names}
            walk.append((state(client), values))
        if client.step("stepIn", thread)["reason"] == "exit":
            break
    return walk


def test_writers():
    rng, count, none = random.Random(seed + 1), 0, 0
    for program, parts in WALKED.items():
        each = max(1, writers // len(WALKED))
        client = stopped(program)
        end = length_of(client)
        client.end()
        client = stopped(program)
        thread = thread_with_code(client)
        start = rng.choice((0, rng.randrange(1, end)))
        client.step("lineshaft/goTo", thread, time=start, scan=1, statement=1)
        walk = walk_of(client, thread, parts, max(300, min(1500, 4 * each)))
        changing = [name for name in walk[0][1] if len({values[name] for _, values in walk}) > 1]
        client.end()
        client = stopped(program)
        for _ in range(each):
            at = rng.randrange(1, len(walk))
            name = rng.choice(changing if changing and rng.random() < 0.8 else list(walk[0][1]))
            client.step("lineshaft/goTo", thread, **place_of(walk[at][0]))
            frame = bottom(client, thread)
            reference, short = reference_to(client, frame, name)
            try:
                stop = client.step("lineshaft/lastWriter", thread, variablesReference=reference, name=short)
            except Refused as why:
                assert name not in changing and "is not in the memory" in str(why), why
                continue
            wanted, found = writer_by_walk(walk, at, name), place_of(state(client))
            if wanted is None:
                assert stop["reason"] == "entry" or (start > 0 and found["time"] <= walk[0][0]["time"]), (program, seed, at, name, walk[at][0], found)
                none += 1
            else:
                assert found == wanted, (program, seed, at, name, walk[at][0], found, wanted)
            count += 1
        client.end()
    return f"{count} variables, {none} of which nobody had written on the way"


def key_of(place):
    return place["time"], place["scan"] if place["scan"] > 0 else 1 << 60, place["statement"]


def changed_between(walk, name, places, found):
    """Whether the first of those steps that changes the variable is where it was found; None: none changes it. The way
    back leaves out a change that it begins right behind."""
    for i in places:
        if walk[i - 1][1][name] == walk[i][1][name]:
            continue
        if key_of(walk[i - 1][0]) < key_of(found) <= key_of(walk[i][0]):
            return True
        if places.step > 0 or i != places[0]:
            return False
    return None


def test_data_breakpoints():
    """From a place of the walk on and back: to the next change, which lies between the two steps that show it."""
    rng, count, none = random.Random(seed + 2), 0, 0
    for program, parts in WALKED.items():
        each = max(1, writers // len(WALKED))
        client = stopped(program)
        end = length_of(client)
        client.end()
        client = stopped(program)
        thread = thread_with_code(client)
        start = rng.choice((0, rng.randrange(1, end)))
        client.step("lineshaft/goTo", thread, time=start, scan=1, statement=1)
        walk = walk_of(client, thread, parts, max(300, min(1500, 4 * each)))
        names = list(walk[0][1])
        changing = [name for name in names if len({values[name] for _, values in walk}) > 1] or names
        client.end()
        client = stopped(program)
        for _ in range(each):
            at = rng.randrange(1, len(walk) - 1)
            name = rng.choice(changing if rng.random() < 0.8 else names)
            client.request("setDataBreakpoints", breakpoints=[])
            client.step("lineshaft/goTo", thread, **place_of(walk[at][0]))
            reference, short = reference_to(client, bottom(client, thread), name)
            info = client.request("dataBreakpointInfo", variablesReference=reference, name=short)
            client.request("setDataBreakpoints", breakpoints=[{"dataId": info["dataId"]}])
            way = rng.choice(("continue", "reverseContinue"))
            stop, found = client.step(way, thread), state(client)
            places = range(at + 1, len(walk)) if way == "continue" else range(at, 0, -1)
            where = (program, seed, way, at, name, walk[at][0], found)
            known = changed_between(walk, name, places, found)
            assert known is not False and (known is None or stop["reason"] == "data breakpoint"), (where, stop)
            if known is None:
                is_beyond = key_of(found) > key_of(walk[-1][0]) if way == "continue" else key_of(found) <= key_of(walk[0][0])
                assert is_beyond or stop["reason"] in ("exit", "entry"), (where, stop)
                none += 1
            count += 1
        client.end()
    return f"{count} variables, {none} of which do not change on the way"


def test_traces():
    """Without a stop, and of the task that is stepped into the past and on: the bytes of `lineshaft run`."""
    count = 0
    for program in PROGRAMS:
        found = {}
        for how in ("run", "debug", "back"):
            place = folder / how
            place.mkdir(exist_ok=True)
            options = ["--trace", str(place / "trace.csv")]
            if how == "run":
                answer = subprocess.run([lineshaft, "run", str(source / program), "--quiet", *options], capture_output=True, check=False)
                if b"no 'trace:'" in answer.stderr:
                    break
            else:
                client = Client(lineshaft)
                client.launch(source / program, args=options, stopAtEnd=how == "back")
                if how == "back":
                    client.event("stopped")
                    client.step("stepBack")
                    client.step("continue")
                    client.request("continue", threadId=1)
                client.event("exited")
                client.end()
            found[how] = {path.name: path.read_bytes() for path in place.iterdir()}
            for path in place.iterdir():
                path.unlink()
        else:
            assert found["run"] == found["debug"] == found["back"], (program, [name for name in found["run"] if len({found[how].get(name) for how in found}) > 1])
            count += len(found["run"])
    return f"{count} files"


for title, test in list(globals().items()):
    if title.startswith("test_"):
        print("ok", title[5:], test() or "", flush=True)
