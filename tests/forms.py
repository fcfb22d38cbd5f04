#!/usr/bin/python3
"""Documents drawn at random from the JSON schema: the reader accepts each; with one key misspelt, a required one
removed, or a value of a wrong type, schema and reader both refuse it.

usage: forms.py LINESHAFT READ_FORMS COUNT [SEED]        COUNT documents of each form
"""

import copy
import json
import random
import subprocess
import sys

import jsonschema

lineshaft, read_forms, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
seed = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**9)
rng = random.Random(seed)
schema = json.loads(subprocess.run([lineshaft, "schema"], capture_output=True, check=True).stdout)
definitions = schema["definitions"]
forms = [form["form"] for form in json.loads(
    subprocess.run([lineshaft, "form", "--json"], capture_output=True, check=True).stdout)]
forms.remove("block")  # each type of block is a form of its own

NAMES = ["a", "b", "shaft", "slave_2", "Axis", "_x"]
NUMBERS = ["0", "7", "100", "65535"]
TIMES = ["2 ms", "1 s", "0.5 ms", "10us", "1e3 ns", "3 min"]
SIGNALS = [f"{block}.{port}" for block in ("a", "inputs", "shaft") for port in ("q", "cv", "position")]
LEAVES = {
    "name": lambda: rng.choice(NAMES),
    "signal": lambda: rng.choice(SIGNALS),
    "wire": lambda: rng.choice(SIGNALS),
    "task_name": lambda: rng.choice(NAMES),
    "quantity": lambda: rng.choice(["20 mm", "-5e4 mm/s^3", "20 %", "1.5", "60 kHz", "3 pulses"]),
    "interval": lambda: "every(a)",
    "time": lambda: rng.choice(TIMES),
    "share": lambda: rng.choice(["1 %", "25%"]),
    "integer": lambda: rng.choice(["16#10", "2#101", "1_000"]),
    "scalar": lambda: rng.choice([True, False, 3, -1.5, "20 mm", "fast", "a.q", 16]),
}


def draw(of, objects, definition=None):
    """A value of the schema `of`. Each map of a form in it is added to `objects`, with its schema and name."""
    if "$ref" in of:
        name = of["$ref"].rsplit("/", 1)[1]
        if name == "block":
            name = "block_" + rng.choice([d[6:] for d in definitions if d.startswith("block_")])
        return LEAVES[name]() if name in LEAVES else draw(definitions[name], objects, name)
    if "anyOf" in of:
        # No parameter: what it stands for is the program's business.
        shapes = [s for s in of["anyOf"] if s.get("$ref") != "#/definitions/parameter"]
        return draw(rng.choice(shapes), objects)
    if "const" in of:
        return of["const"]
    if "enum" in of:
        return rng.choice(of["enum"])
    return DRAW[of["type"]](of, objects, definition)


def draw_list(of, objects, _):
    items = of["items"]
    size = rng.randint(of.get("minItems", 0), min(of.get("maxItems", 3), max(3, of.get("minItems", 0))))
    if isinstance(items, list):
        return [draw(item, objects) for item in items]
    drawn = [draw(items, objects) for _ in range(size)]
    return list(dict.fromkeys(drawn)) if of.get("uniqueItems") else drawn


def draw_map(of, objects, definition):
    if "properties" not in of:
        ((pattern, value),) = of.get("patternProperties", {}).items()
        names = SIGNALS if "\\." in pattern else NAMES if "A-Z" in pattern else NUMBERS
        size = rng.randint(of.get("minProperties", 0), of.get("maxProperties", 3))
        return {name: draw(value, objects) for name in rng.sample(names, size)}
    rules = jsonschema.Draft7Validator({"allOf": of.get("allOf", [])})
    while True:
        mine = []
        drawn = {key: draw(value, mine) for key, value in of["properties"].items()
                 if key in of.get("required", []) or rng.random() < 0.4}
        if definition in RELATIONS:
            RELATIONS[definition](drawn)
        if rules.is_valid(drawn):
            objects += mine
            if not (definition or "").startswith("block_"):
                objects.append((drawn, of))
            return drawn


def within(number, of):
    return jsonschema.Draft7Validator(of).is_valid(number)


DRAW = {
    "object": draw_map,
    "array": draw_list,
    "null": lambda *_: None,
    "boolean": lambda *_: rng.choice([True, False]),
    "string": lambda *_: rng.choice(NAMES),
    "number": lambda of, *_: rng.choice([n for n in (0, 0.5, 1.5, -2e-3, 40) if within(n, of)]),
    "integer": lambda of, *_: rng.randint(of.get("minimum", -5), min(of.get("maximum", 20), 20)),
}


# What no schema of this form can say: how values stand to each other.

def relate_task(task):
    if not {"every", "on", "on_overrun"} & task.keys():
        task["every"] = "2 ms"
    if "jitter" in task:
        task["jitter"] = "10 %"
    if "cost_jitter" in task:
        task["cost_jitter"] = "50 %"
    if "cost" in task and "every" in task:
        task["cost"] = "100 ns"


def relate_force(force):
    if "until" in force:
        force["until"] = "10 min"


def relate_expectation(expectation):
    """One signal, and a value or bounds, or a count; or a signal that answers, and no more."""
    given = {key: expectation.pop(key) for key in ("count", "equals", "within", "at_least", "at_most")
             if key in expectation}
    bounds = {key: given[key] for key in ("at_least", "at_most") if key in given}
    if "between" in expectation:
        expectation["between"] = ["1 s", "2 s"]
    if not {"at", "always", "never", "between", "rising"} & expectation.keys():
        expectation[f"within {rng.choice(TIMES)} of {rng.choice(SIGNALS)}"] = rng.choice(SIGNALS)
    elif "rising" in expectation:
        expectation.update(bounds or {"count": 3})
    elif {"always", "never"} & expectation.keys():
        expectation.update(bounds or rng.choice([{}, {"equals": 3}, {"equals": 3, "within": 1}]))
    elif bounds:
        expectation[rng.choice(SIGNALS)] = bounds
    else:
        expectation[rng.choice(SIGNALS)] = LEAVES["scalar"]()


def relate_distribution(distribution):
    unit = rng.choice(["", " mm", " ms"])
    for kind, values in distribution.items():
        if kind != "choice":
            values[:] = [f"{value}{unit}" for value in sorted(rng.sample(range(1, 100), 2))]


def relate_case(case):
    for name in case.get("random", {}):
        case.get("grid", {}).pop(name, None)


RELATIONS = {"task": relate_task, "force": relate_force, "expectation": relate_expectation,
             "distribution": relate_distribution, "case": relate_case}


def yaml(value):
    """As a person would write it: without quotes, on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {yaml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(yaml, value)) + "]"
    if value is None:
        return "~"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if value == "%" else str(value)


def misspell(drawn, of):
    keys = [key for key in drawn if key in of["properties"]]
    if not keys:
        return None
    key = rng.choice(keys)
    at = rng.randrange(len(key))
    drawn[key[:at] + rng.choice("qxz") + key[at:]] = drawn.pop(key)
    return f"'{key}' is misspelt"


def remove(drawn, of):
    # A replay without its file is a stimulus.
    keys = [key for key in of.get("required", []) if of != definitions["replay"] or key != "file"]
    if not keys:
        return None
    key = rng.choice(keys)
    del drawn[key]
    return f"'{key}' is removed"


def change_type(drawn, of):
    if not drawn:
        return None
    key = rng.choice(list(drawn))
    drawn[key] = rng.choice([{"a": {"b": 1}}, [[["x"]]]])
    return f"'{key}' is of a wrong type"


def documents(name):
    """`count` of the form and the broken ones made of them: (what is broken, document)."""
    for _ in range(count):
        objects = []
        document = draw(definitions[name], objects, name)
        yield None, document
        for spoil in (misspell, remove, change_type):
            broken, copies = copy.deepcopy((document, objects))
            what = spoil(*rng.choice(copies))
            if what:
                yield what, broken


failures, total = [], 0
for form in forms:
    validator = jsonschema.Draft7Validator({"$ref": f"#/definitions/{form}", "definitions": definitions})
    drawn = list(documents(form))
    total += len(drawn)
    lines = [f"{form} {yaml(document)}" for _, document in drawn]
    answers = subprocess.run([read_forms], input="\n".join(lines) + "\n", capture_output=True, check=True,
                             text=True).stdout.split("\n")
    for (what, document), line, answer in zip(drawn, lines, answers):
        valid = validator.is_valid(document)
        if what and valid:
            failures.append(f"the schema accepts, although {what}: {line}")
        if what and not answer:
            failures.append(f"the reader accepts, although {what}: {line}")
        if not what and not valid:
            failures.append(f"the schema refuses what is drawn from it: {line}")
        if not what and answer:
            failures.append(f"the reader refuses, {answer}: {line}")

for failure in sorted(failures, key=len)[:10]:
    print(failure)
print(f"{total} documents of {len(forms)} forms, seed {seed}, {len(failures)} failures")
sys.exit(1 if failures else 0)
