#!/usr/bin/python3
"""`lineshaft contour` on paths whose contour error is known, and beside the block in a run.

usage: contour.py LINESHAFT PROJECT
"""

import csv
import json
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

NM = 1e-6  # mm
INTERVAL = 0.25e-3
COLUMNS = ["x.c", "y.c", "x.a", "y.a"]
ARGUMENTS = ["--command", "x.c,y.c", "--actual", "x.a,y.a"]


def write(rows, title="{}"):
    lines = [",".join(["time", *map(title.format, COLUMNS)])]
    lines += [",".join(["" if v is None else repr(v) for v in (i * INTERVAL, *row)]) for i, row in enumerate(rows)]
    (FOLDER / "trace.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def contour(*arguments):
    answer = subprocess.run([COMMAND, "contour", "trace.csv", *ARGUMENTS, *arguments], cwd=FOLDER,
                            capture_output=True, text=True, timeout=60)
    if answer.returncode != 0:
        raise SystemExit(f"contour: exit code {answer.returncode}: {answer.stderr}")
    return answer.stdout


def compare(rows, title="{}"):
    write(rows, title)
    return json.loads(contour("--json"))


def figure(answer, row, kind):
    return answer["contour_error_mm"][row][kind]


def line(count, step=0.025, angle=0.7, beside=-0.003, lag=12.3):
    """Along a straight line; the actual point follows `lag` steps behind, to the left by `beside`."""
    c, s = math.cos(angle), math.sin(angle)
    for i in range(count):
        u, v = i * step, max(0.0, (i - lag) * step)
        yield [u * c, u * s, v * c - beside * s, v * s + beside * c]


def circle(count, step=0.025, radius=20.0, outside=0.004, lag=12.3, slip=0.999):
    """Round a circle, a bit outside; `slip` lets the foot wander over the steps."""
    for i in range(count):
        a, b = i * step / radius, max(0.0, slip * i - lag) * step / radius
        r = radius + outside
        yield [radius * math.cos(a), radius * math.sin(a), r * math.cos(b), r * math.sin(b)]


def check_line():
    answer = compare(list(line(2000)))
    for row in ("real-time - linear", "real-time - spline", "linear - spline"):
        if not figure(answer, row, "greatest") < 1e-6 * NM:
            yield f"straight: {row} is {figure(answer, row, 'greatest') / NM} nm"
    if abs(figure(answer, "real-time", "greatest") - 0.003) > 1e-6 * NM:
        yield f"straight: contour error {figure(answer, 'real-time', 'greatest')} mm instead of 0.003"
    if abs(answer["interval_s"] - INTERVAL) > 1e-12 or abs(answer["speed_mm_s"] - 100) > 1e-6:
        yield f"straight: {answer['interval_s']} s, {answer['speed_mm_s']} mm/s"


def check_circle():
    """(foot to command point)^2 / 2R: h^2 / 8R at most, h^2 / 24R on average, four times at twice the step."""
    means = {}
    for step in (0.025, 0.05):
        answer = compare(list(circle(8000, step)))
        means[step] = figure(answer, "real-time - spline", "mean")
        for kind, wanted in (("mean", step**2 / 24 / 20), ("greatest", step**2 / 8 / 20)):
            ours = figure(answer, "real-time - spline", kind)
            if abs(ours - wanted) > 0.02 * wanted:
                yield f"circle, step {step} mm: {kind} {ours / NM} nm instead of {wanted / NM}"
        if abs(figure(answer, "spline", "mean") - 0.004) > 0.02 * NM:
            yield f"circle, step {step} mm: spline at {figure(answer, 'spline', 'mean')} mm"
    if abs(means[0.05] / means[0.025] - 4) > 0.05:
        yield f"circle: {means[0.05] / means[0.025]} times the difference at twice the step"


def check_ahead():
    """An actual point in front of the command is compared with the commands that come later."""
    for lead in (2.4, 10.0):
        rows = list(circle(4000, outside=0, lag=-lead, slip=1))
        last = rows[3900][2:]
        answer = compare([row if i < 3900 else row[:2] + last for i, row in enumerate(rows)])
        for row, most in (("linear", 5 * NM), ("spline", 1 * NM)):
            if figure(answer, row, "greatest") > most:
                yield f"ahead by {lead} points: {row} is {figure(answer, row, 'greatest') / NM} nm"


def check_units():
    rows = list(circle(500))
    mm = compare(rows, "{} [mm]")
    um = compare([[1000 * v for v in row] for row in rows], "{} [um]")
    for row in ("real-time", "spline"):
        if abs(figure(mm, row, "rms") - figure(um, row, "rms")) > 1e-6 * NM:
            yield f"units: {row} {figure(mm, row, 'rms')} mm, from um {figure(um, row, 'rms')} mm"


def check_gaps():
    """Commands that stand add no point; rows without a value, or out of reach, are counted."""
    rows = list(circle(1000))
    once, twice = compare(rows), compare([row for row in rows for _ in range(2)])
    if twice["samples"] != 2000 or twice["command_points"] != once["command_points"]:
        yield f"standstill: {twice['samples']} samples of {twice['command_points']} command points"
    if abs(figure(twice, "real-time", "mean") - figure(once, "real-time", "mean")) > 1e-3 * 0.004:
        yield "standstill: another contour error"
    rows[200][2] = None
    rows[201][3] = 1e12
    rows[900][2:] = rows[300][:2]
    gaps = compare(rows)
    if (gaps["left_out"], gaps["out_of_reach"], gaps["samples"]) != (2, 1, 997):
        yield f"gaps: {gaps['left_out']} rows and {gaps['out_of_reach']} out of reach left out of {gaps['samples']}"
    if "left out: 2 rows without four positions, 1 out of reach" not in contour():
        yield "gaps: not told"
    for row in ([[1.0, 2.0, 1.0, 2.5]], [[1.0, 2.0, 1.0, 2.5]] * 3):
        if figure(compare(row), "spline", "mean") != 0.5:
            yield "a single command point: no distance"


def check_run(project):
    """The block contour_comparison in a run, and the command over the trace of that run."""
    subprocess.run([COMMAND, "run", project / "programs/paper/li_curve.yaml", "--quiet", "--trace", "curve.csv"],
                   cwd=FOLDER, check=True, capture_output=True, timeout=120)
    answer = json.loads(subprocess.run(
        [COMMAND, "contour", "curve.csv", "--command", "path.x,path.y", "--actual", "x.position,y.position",
         "--json"], cwd=FOLDER, check=True, capture_output=True, timeout=120).stdout)
    with open(FOLDER / "curve.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row, of in (("real-time", lambda r: float(r["checked.real_time"])),
                    ("spline", lambda r: float(r["checked.spline"])),
                    ("real-time - spline", lambda r: abs(float(r["checked.real_time"]) - float(r["checked.spline"])))):
        block, ours = sum(map(of, rows)) / len(rows), figure(answer, row, "mean")
        if abs(block - ours) > 0.002 * block:
            yield f"run: {row}: {block} mm by the block, {ours} mm over the record"


def check_interrupt():
    write(list(circle(100000)) * 4)
    with subprocess.Popen([COMMAND, "contour", "trace.csv", *ARGUMENTS], cwd=FOLDER, stdout=subprocess.PIPE) as process:
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out = process.communicate(timeout=60)[0]
    if process.returncode != 130 or out:
        yield f"interrupted: exit code {process.returncode}, said {out!r}"


def main():
    project = pathlib.Path(sys.argv[2]).resolve()
    checks = [check_line(), check_circle(), check_ahead(), check_units(), check_gaps(), check_run(project), check_interrupt()]
    failures = [failure for check in checks for failure in check]
    for failure in failures:
        print(failure)
    print(f"{len(checks)} checks, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    COMMAND = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(folder)
        sys.exit(main())
