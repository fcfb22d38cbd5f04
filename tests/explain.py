#!/usr/bin/python3
"""Runs every example that `lineshaft explain CODE` shows.

A command line runs as it stands, in a folder with the files that it names. A piece of a program, of a study or of a fit
is put into a small one, over what that has there. All must end with exit code 0.

usage: explain.py LINESHAFT
"""

import os
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

PROGRAM = """
lineshaft: 1
tasks: {servo: {every: 2 ms, priority: 26}, main: {every: 10 ms}}
blocks:
  shaft: {type: axis, task: servo, default_acceleration: 1e5 mm/s^2, default_jerk: 1e9 mm/s^3}
  slave:
    type: axis
    task: servo
    default_velocity: 50 mm/s
    default_acceleration: 1e5 mm/s^2
    default_jerk: 1e9 mm/s^3
  feed: {type: MC_MoveVelocity, task: servo, Axis: shaft, Velocity: 10 mm/s, Execute: true}
  gear:
    type: MC_GearIn
    task: servo
    Master: shaft
    Slave: slave
    RatioNumerator: 1.5
    Execute: true
  move: {type: MC_MoveAbsolute, task: servo, Axis: shaft, Execute: inputs.start}
  x: {type: pto, task: main, multi_segment: true, execute: inputs.go}
  counter: {type: ctu, task: main, cu: inputs.go, pv: 3}
inputs: {go: false, start: false, recipe: 1}
retain: [counter]
run: {for: 2 s}
trace: {task: servo, signals: [shaft.position, slave.position]}
"""
PROGRAM_KEYS = set(
    "lineshaft title parameters tasks templates blocks inputs retain run stimulus trace traces modbus expect".split())
# Topics whose examples run by themselves; those of the others are pieces of something larger.
TOPICS = {"programs", "traces"}
PARAMETERS = {"parameters": {"speed": "10 mm/s", "radius": "20 mm", "ratio": "1.5"}}

CASE = {"name": "early", "compare": ["slave.position"]}
STUDY = {
    "lineshaft_study": "1",
    "program": "program.yaml",
    "cases": [{"grid": {"ratio": [f"1.{i}" for i in range(8)]}, "compare": ["slave.position"]}],
}
CLAIMED = {
    "lineshaft_study": "1",
    "program": "program.yaml",
    "cases": [CASE, {**CASE, "name": "immediate", "set": {"ratio": "1.6"}}],
}
FIT = {
    "lineshaft_fit": "1",
    "program": "program.yaml",
    "parameters": {"ratio": {"from": "1", "to": "2"}},
    "cases": [{"compare": {"slave.position": {"paper": "30 mm"}}}],
}


def merged(under, over):
    if not isinstance(under, dict) or not isinstance(over, dict):
        return over
    return {**under, **{key: merged(under.get(key), value) for key, value in over.items()}}


class PlainDumper(
    yaml.emitter.Emitter, yaml.serializer.Serializer, yaml.representer.SafeRepresenter, yaml.resolver.BaseResolver
):
    """Writes every scalar as it was read: `on` is a key, `true` has no quotes."""

    def __init__(self, stream, **options):
        yaml.emitter.Emitter.__init__(self, stream, width=1000)
        yaml.serializer.Serializer.__init__(self)
        yaml.representer.SafeRepresenter.__init__(self, sort_keys=False)
        yaml.resolver.BaseResolver.__init__(self)

    def ignore_aliases(self, data):
        return True


def read(text):
    return yaml.load(text, Loader=yaml.BaseLoader)


def write(path, tree):
    path.write_text(yaml.dump(tree, Dumper=PlainDumper), encoding="utf-8")


def program_with_parameters():
    program = merged(read(PROGRAM), PARAMETERS)
    program["blocks"]["gear"]["RatioNumerator"] = "$ratio"
    return program


def examples(text):
    """The indented parts of a paragraph; a line that is indented less begins what follows."""
    parts, part = [], []
    for line in text.splitlines() + [""]:
        if line.startswith("    "):
            part.append(line[4:])
        elif part:
            parts.append("\n".join(part))
            part = []
    return parts


class Folder:
    """What the examples' command lines expect to find."""

    def __init__(self, lineshaft, root):
        self.lineshaft, self.root = lineshaft, root
        (root / "shared").mkdir()
        self.here = root / "here"
        (self.here / "parts").mkdir(parents=True)
        write(self.here / "program.yaml", program_with_parameters())
        write(self.here / "PLAN.yaml", STUDY)
        for name in ("a.csv", "b.csv"):
            self.run(f"lineshaft run program.yaml --trace {name}")
        (self.here / "measured.csv").write_text("time,slave.position\n0,0\n0.5,7.5\n1,15\n", encoding="utf-8")

    def run(self, line):
        env = {**os.environ, "PATH": f"{self.lineshaft.parent}:{os.environ['PATH']}"}
        return subprocess.run(line, shell=True, cwd=self.here, env=env, capture_output=True, text=True, timeout=60)

    def all_other_chunks(self, line):
        number, count = map(int, re.search(r"--chunk (\d+)/(\d+)", line).groups())
        for i in set(range(1, count + 1)) - {number}:
            self.run(line.replace(f"{number}/{count}", f"{i}/{count}").replace(f"part_{number}", f"part_{i}"))

    def answer(self, example):
        """What comes of it; whatever is wrong is an exit code other than 0."""
        if example.startswith("lineshaft "):
            for line in example.splitlines():
                answer = self.run(line)
                if answer.returncode != 0:
                    return answer
                if "--chunk" in line:
                    self.all_other_chunks(line)
            return answer
        return self.piece(read(example))

    def piece(self, tree):
        program = read(PROGRAM)
        keys = set(tree)
        if "formula" in keys:
            write(self.here / "piece.yaml", {**CLAIMED, "claims": [{"claim": "a claim", **tree}]})
            return self.run("lineshaft study piece.yaml")
        if "compare" in keys or "file" in (tree.get("trace") or {}):
            case = merged({"compare": {"slave.position": {}}} if "trace" in tree else {}, tree)
            write(self.here / "piece.yaml", {**FIT, "cases": [case]})
            return self.run("lineshaft fit piece.yaml")
        if "lineshaft" in keys:
            program = tree
        elif "profile" in keys:
            program["blocks"]["x"].update(tree)
        elif keys <= PROGRAM_KEYS:
            program = merged(program, tree)
        else:
            program["blocks"].update(tree)
        write(self.here / "piece.yaml", program)
        return self.run("lineshaft run piece.yaml")


def explain(lineshaft, *code):
    return subprocess.run([lineshaft, "explain", *code], capture_output=True, text=True, check=True).stdout


def blocks_examples_hold(lineshaft):
    """The example of each kind of block, all in one program, beside what they name."""
    kinds = json.loads(subprocess.run([lineshaft, "blocks", "--json"], capture_output=True, text=True, check=True).stdout)
    with tempfile.TemporaryDirectory() as root:
        program = pathlib.Path(root) / "blocks.yaml"
        program.write_text("lineshaft: 1\ntasks: {main: {every: 10 ms}}\ninputs: {go: false}\nrun: {for: 10 ms}\nblocks:\n"
                           "  x: {type: axis, task: main}\n  line: {type: axis, task: main}\n"
                           + "".join(f"  {kind['example']}\n" for kind in kinds), encoding="utf-8")
        answer = subprocess.run([lineshaft, "run", "--strict", program], capture_output=True, text=True, check=False)
    shown = subprocess.run([lineshaft, "blocks", "MC_GearIn"], capture_output=True, text=True, check=True).stdout
    holds = answer.returncode == 0 and all(kind["example"] for kind in kinds) and "my_gear_in: {type: MC_GearIn" in shown
    print(f"{len(kinds)} blocks' examples: {'they run' if holds else answer.stderr}")
    return holds


def faults():
    """The names that messages have of them, but of none."""
    source = pathlib.Path(__file__).parent.parent / "runtime/st/code/fault.hpp"
    names = source.read_text(encoding="utf-8").partition("fault_names[]")[2]
    return re.findall(r'"(\w+)"', names)[1:]


def main():
    lineshaft = pathlib.Path(sys.argv[1]).resolve()
    count = failed = 0
    for code in (line.split()[0] for line in explain(lineshaft).splitlines() if line):
        if not code.startswith("L") and code not in TOPICS:
            continue
        for example in examples(explain(lineshaft, code.lower())):
            with tempfile.TemporaryDirectory() as root:
                answer = Folder(lineshaft, pathlib.Path(root)).answer(example)
            count += 1
            if answer.returncode != 0:
                failed += 1
                print(f"{code}: exit code {answer.returncode}", example, answer.stdout, answer.stderr, sep="\n")
    print(f"{count} examples, {failed} failed")
    if any(not explain(lineshaft, fault).startswith(fault + "\n  ") for fault in faults()):
        return 1
    if not blocks_examples_hold(lineshaft):
        return 1
    return 1 if failed or count < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
