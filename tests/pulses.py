#!/usr/bin/env python3
"""Recounts pulses from the pulse file alone: pulses.py LINESHAFT PROJECT [PROFILES].

The paper's lines, the same without their losses, and PROFILES (500) seeded random profiles: the number of
edges, times that rise, no two edges closer than 1/100 kHz, and in every segment the rate at each pulse, from
the manual's law for the rate and this file's own increments. At last, that memory does not grow with the pulses.
"""

import bisect
import csv
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

SECOND = 10**9  # ns
LEAST_PERIOD = 10_000  # ns, of 100 kHz
PERIOD, SCALE = 0.05, 60_000  # s, pulses/cm: of programs/paper/jerk_line.yaml
INTERRUPT = 330_000  # ns
PAPER_ROWS = [
    (1.5, 1, 89960, 59960),
    (3, 2.5, 179360, 149454),
    (7.5, 2.5, 449960, 149960),
    (6, 2.5, 359960, 149950),
    (-2.5, 6, 149950, 359960),
]


def run(lineshaft, program, path, *options):
    """Times [ns] of each channel's edges, and its directions."""
    subprocess.run([lineshaft, "run", program, "--quiet", "--pulses", path, *options], check=True,
                   stdout=subprocess.DEVNULL)
    channels = {}
    with open(path, newline="", encoding="ascii") as file:
        rows = csv.reader(file)
        assert next(rows) == ["channel", "time_ns", "direction"]
        for name, time, direction in rows:
            times, directions = channels.setdefault(name, ([], set()))
            times.append(int(time))
            directions.add(direction)
    return channels


def check_times(name, times, count):
    assert len(times) == count, f"{name}: {len(times)} edges, not {count}"
    least = min((b - a for a, b in zip(times, times[1:])), default=LEAST_PERIOD)
    assert least >= LEAST_PERIOD, f"{name}: two edges {least} ns apart"


def clamped(rate):
    return min(max(rate, 1), 100_000)


def law(segment):
    """Rate [Hz] at a time [s] after the segment's start, its slope [Hz/s], and its nominal time [s]."""
    start, end, count = clamped(segment[0]), clamped(segment[1]), segment[2]
    nominal = 2 * count / (start + end)
    slope = (end - start) / nominal
    return (lambda t: end if t >= nominal else start + slope * t), slope, nominal


def check_per_pulse(name, times, segment):
    """A pulse lasts 1 / the rate at its start. Edges are rounded to 1 ns, which also moves that rate."""
    rate, slope, _ = law(segment)
    for a, b in zip(times, times[1:]):
        f = rate((a - times[0]) / SECOND)
        period = SECOND / f
        slack = 1.01 + (abs(slope) / f * period / SECOND if a > times[0] else 0)
        assert abs(b - a - period) <= slack, f"{name}: a pulse of {b - a} ns at {f} Hz"


def check_continuous(name, times, segment):
    """Pulse k begins when the integral of the rate is k, and after `count` of them the segment ends."""
    _, slope, nominal = law(segment)
    start = clamped(segment[0])
    for k, time in enumerate(times):
        t = (time - times[0]) / SECOND
        passed = start * t + slope * t * t / 2
        assert abs(passed - k) <= 1.01e-9 * max(start, start + slope * t) + 1e-9, \
            f"{name}: {passed} pulses at edge {k}"
    if len(times) > segment[2]:
        assert abs(times[-1] - times[0] - nominal * SECOND) <= 1.01, f"{name}: wrong end"


def check_segments(name, times, segments, check, gapless):
    """Cuts the edges by the segments' counts; gapless: a segment ends where the next one begins."""
    check_times(name, times, sum(count for *_, count in segments))
    first = 0
    for i, segment in enumerate(segments):
        end = first + segment[2]
        check(f"{name}, segment {i + 1} {segment}", times[first:end + gapless], segment)
        first = end


def increments(way, amax=1, beta=1, vmax=1.5):
    """The paper's samples of the leading axis: velocity before and after [cm/s]."""
    t1, t2, t4 = amax / beta, vmax / amax - amax / beta, 0
    s1, s2 = 2 * amax * t1 * t1, vmax * (2 * t1 + t2)
    if way <= s1:
        amax, beta, t2 = amax * way / s1, beta * way / s1, 0
    elif way < s2:
        t2 = (math.sqrt(t1 * t1 + 4 * way / amax) - 3 * t1) / 2
    else:
        t4 = way / vmax - 2 * t1 - t2
    velocity, step = 0, 0.5 * beta * PERIOD * PERIOD
    for phase, duration in enumerate([t1, t2, t1, t4, t1, t2, t1], 1):
        for k in range(1, math.floor(duration / PERIOD) + 1):
            by_jerk = step * (2 * k - 1)
            full = 0 if phase in (1, 4, 5) else amax * PERIOD
            change = by_jerk if phase in (1, 5) else full - by_jerk if phase in (3, 7) else full
            before, velocity = velocity, velocity + (change if phase < 5 else -change)
            yield before, velocity


def paper_segments(way, share):
    segments = []
    for before, after in increments(way):
        count = int((before + after) * PERIOD / 2 * share * SCALE)
        if count > 0:
            segments.append((int(before * share * SCALE), int(after * share * SCALE), count))
    return segments


def check_paper(lineshaft, project, path):
    for x, y, count_x, count_y in PAPER_ROWS:
        channels = run(lineshaft, project / "programs/paper/jerk_line.yaml", path,
                       "--set", f"x={x} cm", "--set", f"y={y} cm")
        way = max(abs(x), abs(y))
        for axis, distance, count in (("x", x, count_x), ("y", y, count_y)):
            times, directions = channels[axis]
            name = f"{axis} of {x}, {y}"
            assert directions == {"-1" if distance < 0 else "1"}, f"{name}: wrong direction"
            check_times(name, times, count)
            check_segments(name, times, paper_segments(way, abs(distance) / way), check_per_pulse,
                           gapless=False)
            if abs(distance) == way:
                first = times[1] - times[0]
                assert SECOND <= first < SECOND + 10**6, f"{name}: the first pulse lasts {first} ns"
    print(f"{len(PAPER_ROWS)} lines of the paper; the leading axis' first pulse, at 1 Hz, lasts a second")


def check_lossless(lineshaft, project, path):
    worst = 0
    for x, y, *_ in PAPER_ROWS:
        channels = run(lineshaft, project / "programs/paper/jerk_line_timed.yaml", path,
                       "--set", f"x={x} cm", "--set", f"y={y} cm")
        for axis, distance in (("x", x), ("y", y)):
            check_times(f"{axis} of {x}, {y}", channels[axis][0], round(abs(distance) * SCALE))
        xs, ys = channels["x"][0], channels["y"][0]
        sample = round(PERIOD * SECOND)
        for end in range(INTERRUPT + sample, max(xs[-1], ys[-1]) + sample, sample):
            done_x, done_y = bisect.bisect_left(xs, end), bisect.bisect_left(ys, end)
            apart = abs(done_x * abs(y) - done_y * abs(x)) / max(abs(x), abs(y))
            assert apart < 1, f"{x}, {y}: {apart} pulses apart at {end} ns"
            worst = max(worst, apart)
    print(f"without losses: no pulse missing, the axes at most {worst:.3f} pulses apart at any sample")


def random_profile(numbers):
    def rate():
        return round(10 ** numbers.uniform(0, 5))

    return [(rate(), rate(), numbers.choice([1, 2, numbers.randint(1, 200)]))
            for _ in range(numbers.randint(1, 6))]


def check_profiles(lineshaft, folder, path, count):
    numbers, at_once, edges = random.Random(20), 500, 0
    for first in range(0, count, at_once):
        profiles = [random_profile(numbers) for _ in range(min(at_once, count - first))]
        checks = [numbers.choice([check_per_pulse, check_continuous]) for _ in profiles]
        program = pathlib.Path(folder, "profiles.yaml")
        with program.open("w", encoding="ascii") as file:
            file.write("lineshaft: 1\ntasks: {main: {every: 1000 s}}\ninputs: {go: true}\n"
                       "run: {for: 999 s}\nblocks:\n")
            for i, (profile, check) in enumerate(zip(profiles, checks)):
                rows = ", ".join(f"[{a} Hz, {b} Hz, {n}]" for a, b, n in profile)
                update = check.__name__.removeprefix("check_")
                file.write(f"  p{i}: {{type: pto, task: main, multi_segment: true, execute: inputs.go, "
                           f"rate_update: {update}, profile: [{rows}]}}\n")
        channels = run(lineshaft, program, path)
        for i, (profile, check) in enumerate(zip(profiles, checks)):
            times = channels[f"p{i}"][0]
            check_segments(f"profile {first + i}", times, profile, check, gapless=True)
            edges += len(times)
    print(f"{count} random profiles: {edges} edges, each where its rate puts it")


def peak_memory(lineshaft, folder, path, count):
    """[kB]; or that of this script, if it is larger: the child begins as a copy of it."""
    program = pathlib.Path(folder, "long.yaml")
    program.write_text("lineshaft: 1\ntasks: {main: {every: 1 s}}\ninputs: {go: true}\n"
                       "blocks: {x: {type: pto, task: main, start_rate: 65535 Hz, "
                       f"count: {count}, execute: inputs.go}}}}\n"
                       "run: {for: 1 h}\n",
                       encoding="ascii")
    child = subprocess.Popen([lineshaft, "run", program, "--quiet", "--pulses", path],
                             stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    return usage.ru_maxrss


def check_memory(lineshaft, folder, path, few=100_000, many=3_000_000):
    small, large = (peak_memory(lineshaft, folder, path, count) for count in (few, many))
    assert large <= small + 2000, f"{many} pulses take {large - small} kB more than {few}"
    print(f"memory: {small} kB with {few} pulses, {large} kB with {many}")


def main():
    lineshaft, project = sys.argv[1], pathlib.Path(sys.argv[2])
    profiles = int(sys.argv[3]) if len(sys.argv) > 3 else 500
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/pulses.csv"
        check_memory(lineshaft, folder, path)
        check_paper(lineshaft, project, path)
        check_lossless(lineshaft, project, path)
        check_profiles(lineshaft, folder, path, profiles)


main()
