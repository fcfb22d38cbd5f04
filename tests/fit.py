#!/usr/bin/python3
"""lineshaft fit finds the parameters that a trace was simulated with, noise added, and says how sure it is.

usage: fit.py LINESHAFT SOURCE_DIR [SEEDS]
"""

import csv
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

TRUE = {"ratio": 1.7, "acceleration": 80.0, "jerk": 900.0}
NOISE = 0.05  # mm

PROGRAM = """
lineshaft: 1
parameters: {ratio: 1.5, acceleration: 60 mm/s^2, jerk: 2000 mm/s^3}
tasks: {servo: {every: 2 ms}}
blocks:
  shaft: {type: axis, task: servo}
  slave: {type: axis, task: servo, default_acceleration: $acceleration, default_jerk: $jerk}
  feed: {type: MC_MoveVelocity, task: servo, Axis: shaft, Velocity: 20 mm/s, Execute: true}
  gear: {type: MC_GearIn, task: servo, Master: shaft, Slave: slave, RatioNumerator: $ratio}
stimulus: [{at: 0.1 s, set: {gear.Execute: true}}]
run: {for: 0.8 s}
trace: {task: servo, signals: [slave.position]}
"""

PLAN = """
lineshaft_fit: 1
title: A ramp from its noisy trace
program: program.yaml
parameters:
  ratio: {from: 1, to: 3}
  acceleration: {from: 30 mm/s^2, to: 300 mm/s^2}
  jerk: {from: 300 mm/s^3, to: 5000 mm/s^3}
starts: 2
cases:
  - trace: {file: measured.csv, time: t}
    compare: {slave.position: {column: measured, uncertainty: 0.05 mm}}
"""


def call(lineshaft, folder, *arguments):
    answer = subprocess.run([lineshaft, *arguments], cwd=folder, capture_output=True, text=True, timeout=300)
    if answer.returncode != 0:
        sys.exit(f"{' '.join(arguments)}: exit code {answer.returncode}\n{answer.stdout}{answer.stderr}")
    return answer.stdout


def measure(folder, seed):
    """The exact trace with noise on every sample."""
    noise = random.Random(seed)
    with open(folder / "exact.csv", newline="") as exact, open(folder / "measured.csv", "w") as measured:
        measured.write("t [s],measured [mm]\n")
        for row in csv.DictReader(exact):
            measured.write(f"{row['time']},{float(row['slave.position']) + noise.gauss(0, NOISE)}\n")


def recover(lineshaft, folder, seeds):
    """Deviations from the true parameters in standard errors, over all seeds."""
    (folder / "program.yaml").write_text(PROGRAM)
    (folder / "plan.yaml").write_text(PLAN)
    true = [f"{name}={value}{unit}" for (name, value), unit in zip(TRUE.items(), ["", "mm/s^2", "mm/s^3"])]
    call(lineshaft, folder, "run", "program.yaml", "--set", *true, "--trace", "exact.csv")
    deviations = []
    for seed in range(1, seeds + 1):
        measure(folder, seed)
        answer = call(lineshaft, folder, "fit", "plan.yaml", "--json", "-j", "1")
        if seed == 1 and answer != call(lineshaft, folder, "fit", "plan.yaml", "--json", "-j", "3"):
            sys.exit("the result depends on the number of jobs")
        for found in json.loads(answer)["parameters"]:
            deviations.append((found["value"] - TRUE[found["name"]]) / found["standard_error"])
    return deviations


def check_recovery(lineshaft, folder, seeds):
    deviations = recover(lineshaft, folder, seeds)
    greatest = max(map(abs, deviations))
    rms = (sum(d * d for d in deviations) / len(deviations)) ** 0.5
    print(f"{len(deviations)} parameters of {seeds} seeds: greatest deviation {greatest:.2f} standard errors, rms {rms:.2f}")
    assert greatest < 3, "a parameter was not found within 3 standard errors"
    assert 0.5 < rms < 1.5, "the standard errors are not those of the deviations"


def check_interrupt_cost(lineshaft, source, folder):
    """What config/s7_200_smart.yaml has is what the committed plan finds."""
    plan = str(source / "programs/paper/jerk_line_fit.yaml")
    call(lineshaft, source, "fit", plan, "-o", str(folder / "found.yaml"))
    text = (folder / "found.yaml").read_text()
    found = float(re.search(r"interrupt_cost: (\S+) ms", text)[1])
    config = (source / "config/s7_200_smart.yaml").read_text()
    written = float(re.search(r"pto_done:.*cost: (\S+) ms", config)[1])
    print(f"interrupt cost: found {found} ms, written {written} ms")
    assert abs(found - written) < 0.005, "the controller's value is not the one that the plan finds"


def main():
    lineshaft, source = (str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve())
    seeds = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    with tempfile.TemporaryDirectory() as folder:
        check_recovery(lineshaft, pathlib.Path(folder), seeds)
        check_interrupt_cost(lineshaft, source, pathlib.Path(folder))


if __name__ == "__main__":
    main()
