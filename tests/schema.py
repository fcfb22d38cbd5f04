#!/usr/bin/python3
"""The committed JSON schema is fresh and valid; programs validate against it, broken ones do not.

usage: schema.py LINESHAFT SOURCE_DIR
"""

import json
import pathlib
import re
import subprocess
import sys

import jsonschema
import yaml

REFRESH = "build/release/lineshaft schema > config/program.schema.json"

PROGRAM = """
lineshaft: 1
tasks: {servo: {every: 2 ms}}
blocks:
  shaft: {type: axis, task: servo, default_velocity: 10 mm/s}
  drive:
    type: servo_drive
    task: servo
    set_position: shaft.position
    set_velocity: shaft.velocity
    kv: 20 1/s
  cam: {type: cam_table, task: servo, points: [[0 mm, 0 mm, 1], [10 mm, 20 mm, 3]]}
run: {for: 1 s}
"""

# What is replaced in PROGRAM, by what, and what is broken then.
BROKEN = [
    ("run:", "runs:", "an unknown key of the program"),
    ("every:", "evry:", "an unknown key of a task"),
    ("kv:", "kw:", "an unknown key of a block"),
    ("servo_drive", "servo_drives", "an unknown type of block"),
    ("velocity: 10 mm/s", "velocity: 10", "a number without its unit"),
    ("default_velocity: 10 mm/s", "position: 10 mm", "an output that is set"),
    ("default_velocity: 10 mm/s", "modulo: shaft.error", "a wire into a parameter"),
    ("default_velocity: 10 mm/s", "unit: sideways", "an unknown name of an enumeration"),
    ("    set_position: shaft.position\n", "", "a required input that is not set"),
    ("    task: servo\n", "", "a block in no task"),
    ("{for: 1 s}", "{until: shaft.error}", "a run without an end"),
    ("{for: 1 s}", "[1 s]", "a list instead of a map"),
    ("lineshaft: 1", "lineshaft: 2", "an unknown version"),
    ("lineshaft: 1", "", "no version"),
    ("  drive:", "  2nd drive:", "a name with a blank"),
    ("run:", "expect: [{at: end, always: shaft.velocity}]\nrun:", "an expectation of two kinds"),
    ("run:", "trace: {task: servo}\nrun:", "a trace without signals"),
]


class CoreLoader(yaml.SafeLoader):
    """YAML 1.2's core schema, as editors have it: `yes` and dates are texts."""


CoreLoader.yaml_implicit_resolvers = {}
for tag, pattern, first in (
    ("bool", r"true|false", "tf"),
    ("int", r"[-+]?(0|[1-9][0-9]*)", "-+0123456789"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789"),
    ("null", r"~|null|", ["~", "n", ""]),
):
    CoreLoader.add_implicit_resolver(
        "tag:yaml.org,2002:" + tag, re.compile("^(?:" + pattern + ")$"), list(first)
    )
CoreLoader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def with_names(document):
    """As editors see it: a key is text, an address of Modbus, too."""
    if isinstance(document, dict):
        return {str(key): with_names(value) for key, value in document.items()}
    return [with_names(item) for item in document] if isinstance(document, list) else document


def read(text):
    return with_names(yaml.load(text, Loader=CoreLoader))


def reason(validator, document):
    """The deepest complaint about `document`, or None."""
    error = jsonschema.exceptions.best_match(validator.iter_errors(document))
    if error is None:
        return None
    return "/".join(map(str, error.absolute_path)) + ": " + error.message[:200]


def main():
    lineshaft, source = sys.argv[1], pathlib.Path(sys.argv[2])
    failures = []
    committed_path = source / "config/program.schema.json"
    committed = committed_path.read_bytes() if committed_path.exists() else b""
    fresh = subprocess.run([lineshaft, "schema"], capture_output=True, check=True).stdout
    if fresh != committed:
        failures.append("config/program.schema.json is not fresh; refresh it: " + REFRESH)
    schema = json.loads(fresh)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)

    files = sorted(source.glob("programs/**/*.yaml")) + sorted(source.glob("config/*.yaml"))
    for path in files:
        why = reason(validator, read(path.read_text(encoding="utf-8")))
        if why:
            failures.append(f"{path.relative_to(source)}: {why}")

    if why := reason(validator, read(PROGRAM)):
        failures.append(f"the example does not validate: {why}")
    for old, new, what in BROKEN:
        broken = PROGRAM.replace(old, new, 1)
        if broken == PROGRAM or reason(validator, read(broken)) is None:
            failures.append(f"accepted: {what}")

    for failure in failures:
        print(failure)
    print(f"{len(files)} files, {len(BROKEN)} broken programs, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
