#!/usr/bin/env python3
"""Recounts the edges of the paper's lines from the pulse file: pulses.py LINESHAFT PROJECT.

Checks for each channel: the number of edges, times that rise, no two edges closer than 1/100 kHz, and
that the first pulse, at the lowest rate of 1 Hz, lasts a second.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

ROWS = [
    ("1.5 cm", "1 cm", 89960, 59960),
    ("3 cm", "2.5 cm", 179360, 149454),
    ("7.5 cm", "2.5 cm", 449960, 149960),
    ("6 cm", "2.5 cm", 359960, 149950),
    ("-2.5 cm", "6 cm", 149950, 359960),
]
LEAST_NS = 10_000


def decode(path):
    channels = {}
    with open(path, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            channels.setdefault(row["channel"], []).append((int(row["time_ns"]), row["direction"]))
    return channels


def check(name, edges, count, direction):
    times = [time for time, _ in edges]
    assert len(times) == count, f"{name}: {len(times)} edges, not {count}"
    assert all(b - a >= LEAST_NS for a, b in zip(times, times[1:])), f"{name}: edges too close"
    assert {d for _, d in edges} == {direction}, f"{name}: wrong direction"


def main():
    lineshaft, project = sys.argv[1], pathlib.Path(sys.argv[2])
    program = project / "programs/paper/jerk_line.yaml"
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/pulses.csv"
        for x, y, count_x, count_y in ROWS:
            subprocess.run(
                [lineshaft, "run", program, "--quiet", "--set", f"x={x}", "--set", f"y={y}",
                 "--pulses", path], check=True, stdout=subprocess.DEVNULL)
            channels = decode(path)
            check(f"x of {x}, {y}", channels["x"], count_x, "-1" if x.startswith("-") else "1")
            check(f"y of {x}, {y}", channels["y"], count_y, "1")
            leading = channels["x" if count_x > count_y else "y"]
            first = leading[1][0] - leading[0][0]
            assert 10**9 <= first < 10**9 + 10**6, f"{x}, {y}: the first pulse takes {first} ns"


main()
