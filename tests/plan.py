#!/usr/bin/python3
"""`lineshaft plan`: CSV in, CSV out, and what it says about lines that it cannot read.

usage: plan.py LINESHAFT
"""

import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

HEADER = "Vs,Ve,Vm,A,J,L\n"
OUTPUT_HEADER = "ok,case,equation,T1,T2,T3,T4,T5,T6,T7,end_velocity"
NOT_PLANNED = "0,,,,,,,,,,"
GOOD = "0,0,100,500,5000,30"
PLANNED = "1,cruise_rising_both,5,0.1,0.1,0.1,0,0.1,0.1,0.1,0"
NAMES = "Vs, Ve, Vm, A, J, L"
MOTION_NAMES = "p0, v0, a0, pf, vf, V, A, D, J[, Vmin][, T]"
ALL_NAMES = f"{NAMES} or {MOTION_NAMES}"
MOTION = "p0,v0,a0,pf,vf,V,A,D,J\n"
MOTION_OUTPUT_HEADER = "row,ok,error,T," + ",".join(f"j{i},t{i}" for i in range(1, 25))
SIGNS = (1, 0, -1, 0, -1, 0, 1)

# What it is, the input, the rows of output after the header, what stands on stderr after `stdin:`.
ANSWERS = [
    ("one line", HEADER + GOOD + "\n", [PLANNED], []),
    ("no newline at the end", HEADER + GOOD, [PLANNED], []),
    ("header only", HEADER, [], []),
    ("header without a newline", HEADER.strip(), [], []),
    ("CRLF", (HEADER + GOOD + "\n" + GOOD + "\n").replace("\n", "\r\n"), [PLANNED] * 2, []),
    ("CRLF, no newline at the end", HEADER.replace("\n", "\r\n") + GOOD + "\r", [PLANNED], []),
    ("blank lines", "\n" + HEADER + "\n" + GOOD + "\n  \t\n\r\n" + GOOD + "\n\n", [PLANNED] * 2, []),
    ("blanks", " Vs , Ve,Vm,\tA,J,L \n 0,0 , 100,\t500,5000  ,  30 \n", [PLANNED], []),
    ("a byte order mark", "\ufeff" + HEADER + GOOD, [PLANNED], []),
    ("quotes", '"Vs","Ve","Vm","A","J","L"\n"0","0",100,500,5000,"30"\n', [PLANNED], []),
    ("columns in another order", "L,J,A,Vm,Ve,Vs\n30,5000,500,100,0,0\n", [PLANNED], []),
    ("signs and exponents", HEADER + "-0,+0,1e2,+5e+2,5.0E3,.3e2\n", [PLANNED], []),
    ("a negative zero", HEADER + "-0,40,50,100,100,-0\n-0,0,100,500,5000,30\n",
     ["1,accelerate_triangular,2,0,0,0,0,0,0,0,0", PLANNED], []),
    ("end velocity out of reach", HEADER + "10,200,200,500,5000,0\n",
     ["1,accelerate_triangular,2,0,0,0,0,0,0,0,10"], []),
    ("negative length", HEADER + "0,0,100,500,5000,-1\n" + GOOD, [NOT_PLANNED, PLANNED], []),
    ("limits not positive", HEADER + "0,0,0,500,5000,1\n0,0,1,-1,1,1\n0,0,1,1,0,1\n",
     [NOT_PLANNED] * 3, []),
    ("velocities beyond the limit", HEADER + "101,0,100,500,5000,1\n0,101,100,500,5000,1\n-1,0,1,1,1,1",
     [NOT_PLANNED] * 3, []),
    ("NaN and infinite", HEADER + "NaN,0,1,1,1,1\n0,0,1,nan,1,1\n0,0,1,1,1,inf\n0,-Inf,1,1,1,1\n",
     [NOT_PLANNED] * 4, []),
    ("a missing cell", HEADER + "0,0,100,500,5000\n" + GOOD, [NOT_PLANNED, PLANNED],
     ["2: error: the line has 5 cells instead of 6"]),
    ("a cell too many", HEADER + GOOD + "\n" + GOOD + ",\n", [PLANNED, NOT_PLANNED],
     ["3: error: the line has 7 cells instead of 6"]),
    ("an empty cell", HEADER + "0,0,,500,5000,1\n", [NOT_PLANNED], ["2: error: column Vm is empty"]),
    ("no number", HEADER + "0,0,1,fast,1,1\n0,0,1,1 2,1,1\n0,0,0x10,1,1,1\n0,+-1,1,1,1,1\n",
     [NOT_PLANNED] * 4,
     ["2: error: 'fast' in column A is not a number", "3: error: '1 2' in column A is not a number",
      "4: error: '0x10' in column Vm is not a number", "5: error: '+-1' in column Ve is not a number"]),
    ("beyond a double", HEADER + "0,0,1,1,1,1e999\n", [NOT_PLANNED],
     ["2: error: '1e999' in column L is beyond the range of numbers"]),
    ("blank lines count", HEADER + "\n\nx,0,1,1,1,1\n", [NOT_PLANNED],
     ["4: error: 'x' in column Vs is not a number"]),
    ("the column's own name", "L,J,A,Vm,Ve,Vs\n30,5000,500,100,0,no\n", [NOT_PLANNED],
     ["2: error: 'no' in column Vs is not a number"]),
    ("a line too long", HEADER + "1" * 200000 + "\n" + GOOD, [NOT_PLANNED, PLANNED],
     ["2: error: the line has 65536 characters or more"]),
    ("a last line too long", HEADER + GOOD + "\n" + " " * 65536, [PLANNED, NOT_PLANNED],
     ["3: error: the line has 65536 characters or more"]),
    ("empty", "", None, ["1: error: the header is missing; the first line names " + ALL_NAMES]),
    ("no header", GOOD + "\n", None, ["1: error: the column '0' is not known; the header names " + ALL_NAMES]),
    ("a column missing", "Vs,Ve,Vm,A,L\n", None, ["1: error: there is no column 'J'; the header names " + NAMES]),
    ("a column twice", "Vs,Ve,Vm,A,J,L,L\n", None, ["1: error: two columns are called 'L'"]),
    ("a header in capitals", "\nVS,Ve,Vm,A,J,L\n", None,
     ["2: error: the column 'VS' is not known; the header names " + ALL_NAMES]),
]


# The same for motions from any state: what follows the row's number, without the empty cells at the end.
MOTIONS = [
    ("from rest to rest", MOTION, ["0,0,0,1,0,10,10,10,1"], ["1,,3.1748021039363987,1,0.7937005259840997,-1,1.5874010519681994,1,0.7937005259840997"], []),
    ("nothing to do", MOTION, ["3,0,0,3,0,1,1,1,1"], ["1,,0"], []),
    ("a duration", MOTION.replace("J", "J,T"), ["0,0,0,0,0,1,1,1,1,2.5", "0,1,0,1,1,1,1,1,1,"], ["1,,2.5,0,0.625,0,1.25,0,0.625", "1,,1,0,1"], []),
    ("limits", MOTION.replace("J", "J,Vmin"),
     ["0,0,0,1,0,0,1,1,1,-1", "0,0,0,1,0,1,1,1,1,1", "0,0,0,1,0,1,1,-1,1,", "0,0,0,1,2,1,1,1,1,", "0,0,0,1,-1,2,1,1,1,-0.5"],
     ["0,limit_not_positive"] * 3 + ["0,velocity_above_limit"] * 2, []),
    ("no numbers", MOTION, ["nan,0,0,1,0,1,1,1,1", "0,inf,0,1,0,1,1,1,1", "0,0,0,1e308,0,1e-308,1,1,1"], ["0,not_finite"] * 3, []),
    ("bad lines", MOTION, ["0,0,0,1", "0,0,0,x,0,1,1,1,1"], ["0,bad_line"] * 2,
     ["2: error: the line has 4 cells instead of 9", "3: error: 'x' in column pf is not a number"]),
    ("an unknown column", MOTION.replace("D", "d"), [], None,
     ["1: error: the column 'd' is not known; the header names " + MOTION_NAMES]),
    ("a column missing", MOTION.replace("D,", ""), [], None,
     ["1: error: there is no column 'D'; the header names " + MOTION_NAMES]),
]


def run(lineshaft, *arguments, text=b""):
    text = text if isinstance(text, bytes) else text.encode("utf-8")
    answer = subprocess.run([lineshaft, "plan", *arguments], input=text, capture_output=True, timeout=60)
    return answer.returncode, answer.stdout.decode("utf-8"), answer.stderr.decode("utf-8")


def check_answers(lineshaft):
    for what, text, rows, mistakes in ANSWERS:
        code, out, err = run(lineshaft, text=text)
        wanted = "" if rows is None else "\n".join([OUTPUT_HEADER, *rows]) + "\n"
        if out != wanted:
            yield f"{what}: {out!r} instead of {wanted!r}"
        said = "".join(f"stdin:{mistake}\n" for mistake in mistakes)
        if err != said:
            yield f"{what}: said {err!r} instead of {said!r}"
        if code != (2 if mistakes else 0):
            yield f"{what}: exit code {code}"


def check_motions(lineshaft):
    for what, header, lines, rows, mistakes in MOTIONS:
        code, out, err = run(lineshaft, text=header + "\n".join(lines))
        got = out.splitlines()
        wanted = [] if rows is None else [MOTION_OUTPUT_HEADER] + [f"{i + 1},{row}" for i, row in enumerate(rows)]
        if got[:1] != wanted[:1] or [row.rstrip(",") for row in got[1:]] != wanted[1:]:
            yield f"{what}: {got[1:]} instead of {wanted[1:]}"
        if any(row.count(",") != MOTION_OUTPUT_HEADER.count(",") for row in got):
            yield f"{what}: rows of unequal numbers of cells"
        if err != "".join(f"stdin:{mistake}\n" for mistake in mistakes) or code != (2 if mistakes else 0):
            yield f"{what}: exit code {code}, said {err!r}"
    lowered = MOTION + "0,3,0,20,0,1,2,2,2\n"
    gentle, soonest = (float(run(lineshaft, *arguments, text=lowered)[1].splitlines()[1].split(",")[3])
                       for arguments in ([], ["--soonest"]))
    if abs(gentle - 18.71) > 0.01 or abs(soonest - 20.16) > 0.01:
        yield f"a velocity lowered takes {gentle} s and {soonest} s"
    if run(lineshaft, "--tolerance", "-1", text=lowered)[0] != 2:
        yield "a negative tolerance is accepted"


def length(problem, times):
    """The way that the times take from Vs, and the velocity at its end."""
    x, v, a = 0.0, problem[0], 0.0
    for sign, t in zip(SIGNS, times):
        j = sign * problem[4]
        x += t * (v + t * (a / 2 + t * j / 6))
        v += t * (a + t * j / 2)
        a += t * j
    return x, v


def many_problems(count):
    for i in range(count):
        yield [i % 7 * 10.0, i % 11 * 8.0, 90.0, 100.0 + i % 13 * 50, 5000.0, 0.001 * (i % 1009) * (1 + i % 97)]


def check_many(lineshaft):
    """Every row fits its line; what is read from a pipe in pieces is cut at newlines only."""
    problems = list(many_problems(20000))
    lines = [",".join(map(repr, p)) for p in problems]
    code, out, err = run(lineshaft, text=HEADER + "\n".join(lines))
    rows = out.splitlines()[1:]
    if code != 0 or err or len(rows) != len(problems):
        yield f"many problems: exit code {code}, {len(rows)} rows, said {err[:200]!r}"
        return
    kinds = set()
    for problem, row in zip(problems, rows):
        ok, kind, equation, *numbers = row.split(",")
        *times, end = map(float, numbers)
        kinds.add(kind)
        x, v = length(problem, times)
        L = problem[5]
        if ok != "1" or not 1 <= int(equation) <= 11 or abs(x - L) > 1e-13 * max(L, 1) or abs(v - end) > 1e-11:
            yield f"{problem} gives {row}: length {x}, end velocity {v}"
            return
        if any(repr(float(n)).removesuffix(".0") != n and float(repr(float(n))) != float(n) for n in numbers):
            yield f"digits lost in {row}"
    if len(kinds) < 14:
        yield f"many problems are of {len(kinds)} kinds only"


def check_files(lineshaft, folder):
    """-o gives the bytes of the standard output, and nothing when there is nothing to plan."""
    good, bad, out = folder / "good.csv", folder / "bad.csv", folder / "out.csv"
    good.write_text(HEADER + GOOD + "\nx\n" + GOOD + "\n", encoding="utf-8")
    bad.write_text("a,b\n", encoding="utf-8")
    wanted = "\n".join([OUTPUT_HEADER, PLANNED, NOT_PLANNED, PLANNED]) + "\n"
    code, text, err = run(lineshaft, str(good), "-o", str(out))
    if code != 2 or text or out.read_text(encoding="utf-8") != wanted:
        yield f"-o: exit code {code}, {text!r} on the standard output"
    if err != f"{good}:3: error: the line has 1 cells instead of 6\n":
        yield f"-o: said {err!r}"
    out.unlink()
    code, text, err = run(lineshaft, str(bad), "-o", str(out))
    if code != 2 or out.exists() or not err.startswith(f"{bad}:1: error: the column 'a' is not known"):
        yield f"a wrong header with -o: exit code {code}, said {err!r}"
    if run(lineshaft, "-", text=HEADER + GOOD)[1] != "\n".join([OUTPUT_HEADER, PLANNED]) + "\n":
        yield "- is not the standard input"
    for name, message in ((folder / "none.csv", "cannot open"), (folder, "it is a directory")):
        code, text, err = run(lineshaft, str(name))
        if code != 2 or text or message not in err:
            yield f"{name}: exit code {code}, said {err!r}"
    made = folder / "none" / "deep" / "out.csv"
    code, text, err = run(lineshaft, str(good), "-o", str(made))
    if code != 2 or made.read_text(encoding="utf-8") != wanted:
        yield f"an output in a folder that is not there: exit code {code}, said {err!r}"
    code, text, err = run(lineshaft, str(good), "-o", str(made / "deep" / "out.csv"))
    if code != 2 or not re.search("cannot make the folder .*Not a directory", err):
        yield f"an output in what is no folder: exit code {code}, said {err!r}"


def check_dialogue(lineshaft):
    """Lines are answered as they come: a script may wait for each answer."""
    with subprocess.Popen([lineshaft, "plan"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        process.stdin.write((HEADER + GOOD[:9]).encode())
        process.stdin.flush()
        header = process.stdout.readline().decode().strip()
        process.stdin.write((GOOD[9:] + "\n").encode())
        process.stdin.flush()
        row = process.stdout.readline().decode().strip()
        process.stdin.close()
    if (header, row) != (OUTPUT_HEADER, PLANNED) or process.returncode != 0:
        yield f"dialogue: {header!r}, {row!r}, exit code {process.returncode}"


def check_times_of_curves(lineshaft):
    """The last row of samples is the end, at the path's duration, however far they are from each other, and MC_MovePath
    takes as long; the file may stand behind the limits."""
    limits = ["--limits", "100,1000,20000", "80,1500,50000"]
    points = ((0, 0), (10, 5), (20, -5), (30, 8), (50, 0), (40, -20), (5, -12))
    for curve in ("line", "arc", "spline", "cubic"):
        rows = [(x, y, curve, x + 3, y - 4) for x, y in points]
        yield from check_times_of_path(lineshaft, curve, limits, rows)
    for seed in range(7):
        draw = random.Random(seed)
        limits = ["--deviation", "0.5", "--limits", *(
            ",".join(str(10 ** draw.uniform(*decades)) for decades in ((1, 2), (2, 4), (3, 5))) for _ in range(3))]
        kinds = draw.choice((["cubic"], ["spline"], ["line", "arc", "spline", "cubic"]))
        rows = [(0, 0, "line", 0, 0)] + [
            (*(draw.uniform(-20, 20) for _ in range(2)), draw.choice(kinds), *(draw.uniform(-20, 20) for _ in range(2)))
            for _ in range(draw.choice((5, 12)))]
        yield from check_times_of_path(lineshaft, f"seed {seed}", limits, rows)


def check_times_of_path(lineshaft, name, limits, points):
    text = "position1,position2,curve,border1,border2\n" + "".join(",".join(map(str, point)) + "\n" for point in points)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "points.csv"
        file.write_text(text)
        said = [run(lineshaft, "--path", *more, *limits, str(file))[1].splitlines()[-1].split(",")
                for more in ([], ["--every", "0.004"], ["--every", "0.07"])]
        duration = float(said[0][-1])
        for row in said[1:]:
            if abs(float(row[1]) - duration) > 1e-9 * duration or list(map(float, row[6:8])) != list(points[-1][:2]):
                yield f"--path, {name}: {duration} s, and samples until {row}"
        for scan in (2, 5):
            took = time_of_group(lineshaft, pathlib.Path(folder), limits, points, scan)
            if not -1e-9 < took - duration < 1e-3 * scan + 1e-9:
                yield f"--path, {name}: {duration} s, and MC_MovePath takes {took} s in scans of {scan} ms"


def time_of_group(lineshaft, folder, limits, points, scan):
    """From the scan in which MC_MovePath is taken up to that in which it is done [s]."""
    values = [list(map(float, limit.split(","))) for limit in limits[limits.index("--limits") + 1:]]
    path, first, second = values[0], values[1], values[-1]
    defaults = "default_velocity: {0} mm/s, default_acceleration: {1} mm/s^2, default_jerk: {2} mm/s^3"
    axis = "{{type: axis, task: servo, " + defaults + ", default_deceleration: {1} mm/s^2}}\n"
    deviation = limits[1] if limits[0] == "--deviation" else "0"
    rows = ", ".join(f"[{x!r} mm, {y!r} mm, 0 mm, {kind}, {a!r} mm, {b!r} mm, 0 mm]" for x, y, kind, a, b in points[1:])
    (folder / "group.yaml").write_text(
        f"lineshaft: 1\ntasks: {{servo: {{every: {scan} ms}}}}\nblocks:\n"
        "  g: {type: axes_group, task: servo, " + defaults.format(*path) + "}\n"
        "  x: " + axis.format(*first) + "  y: " + axis.format(*second) +
        "  one: {type: MC_AddAxisToGroup, task: servo, AxesGroup: g, Axis: x, IdentInGroup: 1, Execute: true}\n"
        "  two: {type: MC_AddAxisToGroup, task: servo, AxesGroup: g, Axis: y, IdentInGroup: 2, Execute: one.Done}\n"
        "  on: {type: MC_GroupEnable, task: servo, AxesGroup: g, Execute: two.Done}\n"
        f"  way: {{type: path_table, task: servo, points: [{rows}]}}\n"
        "  move: {type: MC_MovePath, task: servo, AxesGroup: g, PathData: way, TransitionMode: mcTMMaxCornerDeviation, "
        f"TransitionParameter: {deviation} mm, Execute: on.Done}}\n"
        "run: {for: 1000 s, until: move.Done}\ntrace: {task: servo, signals: [move.Active, move.Done]}\n")
    trace = folder / "group.csv"
    subprocess.run([lineshaft, "run", str(folder / "group.yaml"), "--trace", str(trace)], capture_output=True, check=False)
    active = [line.split(",") for line in trace.read_text().splitlines()[1:]]
    return 1e-3 * scan * sum(1 for row in active if row[-2] in ("1", "true"))


def check_short_paths(lineshaft):
    """Numbers too many decades apart to be planned are an error, and what takes long ends by a signal."""
    limits = ["--path", "--limits", "1,1,1"]
    for length in ("1e-30", "1e-100", "1e-160", "1e-300"):
        code, out, err = run(lineshaft, *limits, text=f"position1,position2\n0,0\n{length},0\n")
        ok = out.splitlines()[1].split(",")[1:3]
        if code != 0 or ok not in (["1", ""], ["0", "not_finite"]) or (length == "1e-30" and ok[0] == "0"):
            yield f"--path, a line of {length}: exit code {code}, {out!r}, {err!r}"
    rows = {}
    for unit in ("", " mm", "mm"):
        code, rows[unit], err = run(lineshaft, *limits, text=f"position1,position2\n0{unit},0\n3{unit},4\n")
        if code != 0:
            yield f"--path, with '{unit}': exit code {code}, said {err!r}"
    if not rows[""] == rows[" mm"] == rows["mm"]:
        yield f"--path: a unit changes {rows['']!r} to {rows[' mm']!r} and {rows['mm']!r}"
    code, out, err = run(lineshaft, *limits, "--every", "1", text="position1\n0\n1e300\n")
    if code != 2 or "the path 1 cannot be planned: it takes more than 1e12 rows" not in err or out.count("\n") > 2:
        yield f"--path --every, a line of 1e300: exit code {code}, {out[:99]!r}, said {err!r}"
    if run(lineshaft, *limits, text="position1\n0 mm\n3 m\n")[0] != 2:
        yield "--path: two units in a column are accepted"
    for by in (signal.SIGTERM, signal.SIGINT):
        with subprocess.Popen([lineshaft, "plan", *limits, "--every", "1e-9"], stdin=subprocess.PIPE,
                              stdout=subprocess.DEVNULL) as process:
            process.stdin.write(b"position1\n0\n1\n")
            process.stdin.close()
            time.sleep(0.3)
            process.send_signal(by)
            if process.wait(10) != 130:
                yield f"--path, {by.name}: exit code {process.returncode}"


def check_paths(lineshaft):
    """A line in many points takes the time of the line; corners within a deviation, splines, bulk, what is wrong."""
    limits = ["--limits", "100,1000,10000"]
    line = "position1,position2\n" + "".join(f"{0.06 * i!r},{0.08 * i!r}\n" for i in range(3001))
    code, out, err = run(lineshaft, "--path", *limits, text=line)
    *_, ok, _, points, pieces, way, duration = out.splitlines()[1].split(",")
    if (code, err, ok, points, pieces) != (0, "", "1", "3001", "3000") or abs(float(way) - 300) > 1e-9:
        yield f"--path, a line: exit code {code}, {out!r}, {err!r}"
    elif abs(float(duration) - (300 / 100 + 0.1 + 0.1)) > 1e-6:
        yield f"--path, a line takes {duration} s"
    corner = "path,position1,position2,curve\n" + "".join(
        f"{n},0,0,line\n{n},50,0,line\n{n},{last}\n" for n, last in ((1, "50,50,line"), (2, "100,20,spline")))
    axes = [*limits, "100,1000,20000", "50,1000,20000"]
    times = [run(lineshaft, "--path", *axes, *more, text=corner)[1].splitlines()[1:]
             for more in ([], ["--deviation", "2"])]
    seconds = [[float(row.split(",")[-1]) for row in rows] for rows in times]
    if [len(rows) for rows in seconds] != [2, 2] or not seconds[1][0] < seconds[0][0] - 0.05:
        yield f"--path, a corner: {times}"
    rows = run(lineshaft, "--path", *axes, "--deviation", "2", "--every", "0.001", text=corner)[1].splitlines()[1:]
    samples = [list(map(float, row.split(","))) for row in rows]
    last = [sample for sample in samples if sample[0] == 1][-1]
    if abs(last[1] - seconds[1][0]) > 2e-3 or last[6:8] != [50, 50] or last[3] != 0:
        yield f"--path --every ends with {last}, and takes {seconds[1][0]} s"
    off = max(min(abs(x[7]), abs(x[6] - 50)) for x in samples if x[0] == 1)
    if not 1 < off <= 2:
        yield f"--path --deviation 2 is {off} away"
    if max(abs(x[4]) for x in samples) > 1000 * (1 + 1e-9) or max(abs(x[3]) for x in samples) > 100 * (1 + 1e-9):
        yield "--path --every leaves the limits"
    yield from check_times_of_curves(lineshaft)
    for text, message in (("a\n1\n", "1: error: the column 'a' is not known"),
                          ("position1\n1\nx\n", "3: error: 'x' in column position1 is not a number"),
                          ("position1,curve\n0,\n1,round\n", "3: error: the curve 'round' is not line, arc, spline or cubic")):
        code, out, err = run(lineshaft, "--path", *limits, text=text)
        if code != 2 or not err.startswith("stdin:" + message):
            yield f"--path: exit code {code}, said {err!r} instead of {message!r}"
    bad = "position1,position2,path\n0,0,1\n10,0,1\nx,5,1\n20,0,1\n5,5,2\n6,5,2\nx,0,3\n1,0,3\n"
    rows = [row.split(",")[:4] for row in run(lineshaft, "--path", *limits, text=bad)[1].splitlines()[1:]]
    if rows != [["1", "0", "bad_line", "3"], ["2", "1", "", "2"], ["3", "0", "bad_line", "1"]]:
        yield f"--path, paths with bad lines: {rows}"
    alone = "position1,position4\n0,0\n0,90\n"
    for more, answer in ((["--limits", "1,1,1"], ["0", "no_limits_of_axes"]), (["--limits", "1,1,1", "1,1,1"], ["1", ""])):
        rows = run(lineshaft, "--path", *more, text=alone)[1].splitlines()
        if rows[1].split(",")[1:3] != answer:
            yield f"--path {more}, a rotary axis alone: {rows[1]}"
    code, out, err = run(lineshaft, "--path", *limits, "--every", "1", text="position1,position2\n1,2\n1,2\n")
    if code != 0 or out.splitlines()[1:] != ["1,0,0,0,0,0,1,2,0,0,0,0"]:
        yield f"--path --every, no length: exit code {code}, {out!r}, {err!r}"
    for option, value, why in (("--every", "0", "above 0"), ("--every", "nan", "above 0"), ("--deviation", "nan", "that is 0 or above"),
                               ("--deviation", "-1", "that is 0 or above")):
        code, out, err = run(lineshaft, "--path", *limits, option, value, text=line)
        if code != 2 or f"{option}: '{value}' is not a number {why}" not in err:
            yield f"{option} {value}: exit code {code}, said {err!r}"
    for arguments in (["--path"], limits, ["--path", "--limits", "1,2"], ["--path", "--limits", "1,0,1"]):
        if run(lineshaft, *arguments, text=line)[0] != 2:
            yield f"{arguments} is accepted"


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    failures = [*check_answers(lineshaft), *check_motions(lineshaft), *check_many(lineshaft), *check_dialogue(lineshaft),
                *check_paths(lineshaft), *check_short_paths(lineshaft)]
    with tempfile.TemporaryDirectory() as folder:
        failures += check_files(lineshaft, pathlib.Path(folder))
    for failure in failures:
        print(failure)
    print(f"{len(ANSWERS) + len(MOTIONS)} inputs, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
