#!/usr/bin/python3
"""Trace files as other tools read them, and `lineshaft verify` and `lineshaft diff`.

usage: traces.py LINESHAFT
"""

import csv
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import zlib

from built import has_pages

PROGRAM = """lineshaft: 1
title: A gear
tasks: {servo: {every: 2 ms}}
blocks:
  shaft: {type: axis, task: servo, default_acceleration: 100 mm/s^2}
  slave: {type: axis, task: servo, default_acceleration: 100 mm/s^2}
  feed: {type: MC_MoveVelocity, task: servo, Axis: shaft, Velocity: 10 mm/s, Execute: true}
  gear:
    type: MC_GearIn
    task: servo
    Master: shaft
    Slave: slave
    RatioNumerator: inputs.ratio
    ContinuousUpdate: true
    Execute: true
inputs: {ratio: 1.5}
stimulus: [{at: 1 s, set: {inputs.ratio: 2.0}}]
run: {for: 2 s}
trace: {task: servo, signals: [shaft.position, slave.velocity, gear.InGear, inputs.ratio]}
traces:
  change:
    task: servo
    signals: [slave.velocity]
    trigger: {signal: gear.InGear, edge: falling}
    pre_trigger: 3
    samples: 4
  late: {task: servo, signals: [slave.velocity], trigger: {signal: slave.velocity, above: 99 mm/s}}
  often:
    task: servo
    signals: [shaft.position]
    trigger: {signal: slave.velocity, inside: [16 mm/s, 0.0165 m/s]}
    for: 2 ms
    repeat: 5
"""
NUMBER = re.compile(r"-?(\d+(\.\d+)?)(e[-+]\d+)?")


def lineshaft(*arguments):
    answer = subprocess.run([COMMAND, *arguments], cwd=FOLDER, capture_output=True, text=True, timeout=60)
    return answer.returncode, answer.stdout, answer.stderr


def rows_of(name, **dialect):
    with open(FOLDER / name, newline="", encoding="utf-8") as file:
        return list(csv.reader(file, **dialect))


def check_rules(name, separator=",", point="."):
    """PlotJuggler: the names stand in line 1, no comments, as many cells in every row, numbers only."""
    text = (FOLDER / name).read_bytes().decode("ascii")
    if "\r" in text or "#" in text or not text.endswith("\n"):
        yield f"{name}: carriage returns, comments or a cut end"
    header, *rows = [line.split(separator) for line in text.splitlines()]
    if header[:2] not in (["time", "scan"], ["time [s]", "scan"]) or len(set(header)) != len(header):
        yield f"{name}: header {header}"
    for row in rows:
        if len(row) != len(header) or not all(NUMBER.fullmatch(cell.replace(point, ".")) for cell in row):
            yield f"{name}: row {row}"
            return


def check_tools(name):
    """The same cells in Python's csv, in column, and in gnuplot where it is installed."""
    rows = rows_of(name)
    if len({len(row) for row in rows}) != 1:
        yield f"{name}: Python's csv sees rows of different lengths"
    text = (FOLDER / name).read_text(encoding="utf-8")
    table = subprocess.run(["column", "-s,", "-t"], input=text, capture_output=True, text=True, check=True)
    if [line.split() for line in table.stdout.splitlines()] != rows:
        yield f"{name}: column sees other cells"
    if not shutil.which("gnuplot"):
        return
    script = (f"set datafile separator comma; set key autotitle columnhead; "
              f"stats '{FOLDER / name}' using 1:3 nooutput; print STATS_records, STATS_max_y")
    said = subprocess.run(["gnuplot", "-e", script], capture_output=True, text=True, check=True).stderr.splitlines()[-1].split()
    most = max(float(row[2]) for row in rows[1:])
    if int(said[0]) != len(rows) - 1 or abs(float(said[1]) - most) > 1e-9 * abs(most):
        yield f"{name}: gnuplot sees {said}"


def check_conditions():
    change = rows_of("run.change.csv")
    if [row[0] for row in change[1:]] != ["-0.006", "-0.004", "-0.002", "0", "0.002", "0.004", "0.006"]:
        yield f"times around the trigger: {change}"
    trigger = next(i for i, row in enumerate(rows_of("run.csv")) if i > 1 and row[4] == "0")
    if change[4][1] != rows_of("run.csv")[trigger][1]:
        yield f"the trigger came in scan {change[4][1]}"
    if rows_of("run.late.csv") != [["time", "scan", "slave.velocity"]]:
        yield "a trigger that never comes leaves rows"
    if len(rows_of("run.often.1.csv")) != 3 or (FOLDER / "run.often.2.csv").exists():
        yield "the repeated trace has the wrong measurements"
    whole = {row[1]: row[3] for row in rows_of("run.csv")}
    if any(whole[row[1]] != row[2] for row in change[1:]):
        yield "two traces of one run differ"


def check_styles():
    headers = {
        ("--names", "slash"): "time,scan,shaft/position,slave/velocity,gear/InGear,inputs/ratio",
        ("--names", "snake"): "time,scan,shaft_position,slave_velocity,gear_InGear,inputs_ratio",
        ("--units",): "time [s],scan,shaft.position [mm],slave.velocity [mm/s],gear.InGear,inputs.ratio",
    }
    plain = rows_of("run.csv")[1:]
    for options, header in headers.items():
        lineshaft("run", "p.yaml", "--quiet", "--trace", "style.csv", *options)
        if (FOLDER / "style.csv").read_text().split("\n")[0] != header or rows_of("style.csv")[1:] != plain:
            yield f"{options}: {rows_of('style.csv')[0]}"
        code, out, err = lineshaft("diff", "run.csv", "style.csv")
        if code != 0:
            yield f"{options}: read back as another trace: {out}{err}"
    lineshaft("run", "p.yaml", "--quiet", "--trace", "excel.csv", "--dialect", "excel-de", "--units")
    yield from check_rules("excel.csv", ";", ",")
    if [[c.replace(",", ".") for c in row] for row in rows_of("excel.csv", delimiter=";")[1:]] != plain:
        yield "excel-de has other numbers"
    code, out, err = lineshaft("diff", "run.csv", "excel.csv")
    if code != 0:
        yield f"excel-de: read back as another trace: {out}{err}"


def check_verify():
    good = (FOLDER / "run.csv").read_bytes()
    told = json.loads((FOLDER / "run.csv-metadata.json").read_text())["lineshaft:crc32"]
    if told != f"{zlib.crc32(good):08x}":
        yield "the sidecar's CRC-32 is not zlib's"
    code, out, err = lineshaft("verify", "run.csv", "run.change.csv", "run.late.csv", "excel.csv")
    if code != 0 or out.count("ok  ") != 4:
        yield f"verify: {code} {out}{err}"
    shutil.copy(FOLDER / "run.csv-metadata.json", FOLDER / "bad.csv-metadata.json")
    lines = good.splitlines(keepends=True)
    changed = bytearray(good)
    changed[changed.rindex(b"2") if b"2" in changed else 0] ^= 1
    damages = {
        "a row lost": b"".join(lines[:50] + lines[51:]),
        "a cut row": good[:-4],
        "a lost newline": good[:-1],
        "a digit changed": bytes(changed),
        "rows exchanged": b"".join(lines[:50] + [lines[51], lines[50]] + lines[52:]),
        "a row twice": b"".join(lines[:50] + lines[49:]),
        "nothing left": b"",
    }
    for what, data in damages.items():
        (FOLDER / "bad.csv").write_bytes(data)
        code, out, err = lineshaft("verify", "bad.csv")
        if code != 1 or out or "bad.csv" not in err:
            yield f"verify after {what}: {code} {out}{err}"
    if lineshaft("verify", "none.csv")[0] != 2:
        yield "verify of no file"


def verified(names):
    return {line.split()[1].rstrip(":") for line in lineshaft("verify", *names)[1].splitlines() if line.startswith("ok ")}


def check_verify_bytes():
    """Every byte of a trace and of its sidecar counts: changed to another, lost, or there twice."""
    generator = random.Random(1)
    whole = {end: (FOLDER / f"run.change.csv{end}").read_bytes() for end in ("", "-metadata.json")}
    names, kinds = [], []
    for end, other in (("", "-metadata.json"), ("-metadata.json", "")):
        data = whole[end]
        for i, byte in enumerate(data):
            changes = [data[:i] + bytes([byte ^ generator.randrange(1, 256)]) + data[i + 1:]]
            if i % 10 == 0:
                changes += [data[:i] + data[i + 1:], data[:i] + data[i:i + 1] + data[i:]]
            for changed in changes:
                if changed in (data, b""):
                    continue
                name = f"byte{len(names)}.csv"
                (FOLDER / f"{name}{end}").write_bytes(changed)
                (FOLDER / f"{name}{other}").write_bytes(whole[other])
                names.append(name)
                kinds.append(f"byte {i} of *.csv{end}")
    missed = []
    for first in range(0, len(names), 500):
        good = verified(names[first:first + 500])
        missed += [kind for kind, name in zip(kinds[first:], names[first:first + 500]) if name in good]
    for name in names:
        for end in whole:
            (FOLDER / f"{name}{end}").unlink()
    print(f"{len(names)} changes of one byte, {len(missed)} not found")
    yield from missed[:10]


METHOD = """lineshaft: 1
title: Two ways
parameters: {speed: 0.1 mm/s, seed: 1}
tasks: {main: {every: 1 ms}}
blocks:
  axis: {type: axis, task: main}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: $speed, Execute: true}
run: {for: 10 ms, seed: $seed}
trace: {task: main, signals: [axis.position]}
"""


def check_origins():
    """A trace says what made it; `diff` and `report` show what differs; comments and spelling are nothing."""
    others = {"m": METHOD, "comment": METHOD.replace("tasks:", "# one more line\ntasks:"),
              "spelt": METHOD.replace("0.1 mm/s", "0.01 cm/s").replace("10 ms", "0.01 s"),
              "longer": METHOD.replace("10 ms", "20 ms")}
    for name, text in others.items():
        (FOLDER / f"{name}.yaml").write_text(text)
        lineshaft("run", f"{name}.yaml", "--quiet", "--trace", f"{name}.csv")
    lineshaft("run", "m.yaml", "--quiet", "--trace", "fast.csv", "--set", "speed=0.2 mm/s")
    lineshaft("run", "m.yaml", "--quiet", "--trace", "forced.csv", "--force", "axis.velocity=1 mm/s@2ms..3ms")
    hashes = {name: json.loads((FOLDER / f"{name}.csv-metadata.json").read_text())["lineshaft:program"]
              for name in (*others, "fast", "forced")}
    if not hashes["m"] == hashes["comment"] == hashes["spelt"] or len(set(hashes.values())) != 4:
        yield f"hashes: {hashes}"
    for name in ("comment", "spelt"):
        code, out, err = lineshaft("diff", "m.csv", f"{name}.csv")
        if code != 0 or "same: 11 rows" not in out or f"program: m.yaml, {name}.yaml" not in out:
            yield f"diff of {name}: {code} {out}{err}"
    code, out, err = lineshaft("diff", "m.csv", "fast.csv")
    if code != 1 or not out.startswith("parameter speed: 0.1 mm/s, 0.2 mm/s\nfirst deviation"):
        yield f"diff of two settings: {code} {out}{err}"
    code, out, err = lineshaft("diff", "m.csv", "forced.csv", "--json")
    wanted = [{"what": "forces", "a": "", "b": "axis.velocity = 1 mm/s from 0.002 s until 0.003 s"}]
    if json.loads(out).get("runs") != wanted:
        yield f"diff of a forced run: {code} {out}{err}"
    if lineshaft("diff", "m.csv", "longer.csv")[0] != 2:
        yield "diff of another program"
    if not has_pages(COMMAND, "what the report of two settings says"):
        return
    lineshaft("report", "m.csv", "fast.csv", "-o", "both.html")
    if any(speed not in (FOLDER / "both.html").read_text() for speed in ("0.1 mm/s", "0.2 mm/s")):
        yield "the report does not say what differs"


def check_diff():
    code, out, err = lineshaft("diff", "run.csv", "run.csv")
    if (code, out, err) != (0, "same: 1001 rows of 6 columns\n", ""):
        yield f"diff of the same: {code} {out}{err}"
    lines = (FOLDER / "run.csv").read_text().splitlines(keepends=True)
    cells = lines[101].split(",")
    cells[3] = "15.000000000000002"
    (FOLDER / "other.csv").write_text("".join(lines[:101] + [",".join(cells)] + lines[102:]))
    (FOLDER / "other.csv-metadata.json").unlink(missing_ok=True)
    (FOLDER / "a.csv").write_text("".join(lines))
    code, out, err = lineshaft("diff", "a.csv", "other.csv")
    if code != 1 or "row 101, scan 100, at 0.2 s, slave.velocity" not in out or "1 ulp" not in out:
        yield f"diff by an ulp: {code} {out}{err}"
    if len(re.findall(r"^( >|  ) +\d", out, re.M)) != 7:
        yield f"diff has no window of 3 rows around: {out}"
    for tolerance, wanted in (("1e-14", 0), ("1e-16", 1), ("slave.velocity=1e-14", 0), ("shaft.position=1", 1)):
        if lineshaft("diff", "a.csv", "other.csv", "--tolerance", tolerance)[0] != wanted:
            yield f"diff --tolerance {tolerance} is not {wanted}"
    found = json.loads(lineshaft("diff", "a.csv", "other.csv", "--json")[1])
    if found["same"] or found["first"]["ulp"] != 1 or found["first"]["column"] != "slave.velocity":
        yield f"diff --json: {found}"
    said = lineshaft("diff", "a.csv", "other.csv", "--tolerance", "1e-14")[1]
    if not said.startswith("within tolerance: 1001 rows of 6 columns") or "1.77636e-15    5.61453e-17  row 101" not in said:
        yield f"diff within tolerance: {said}"
    (FOLDER / "more.csv").write_text("".join(f"{line.rstrip()},{'b.x' if not i else i}\n" for i, line in enumerate(lines)))
    if lineshaft("diff", "a.csv", "more.csv")[0] != 2:
        yield "diff of other columns is not refused"
    pages = has_pages(COMMAND, "the report of a diff")
    code, out, err = lineshaft("diff", "a.csv", "more.csv", "--common", *(["--report", "diff.html"] if pages else []))
    drawn = not pages or "slave.velocity" in (FOLDER / "diff.html").read_text()
    if code != 0 or "same: 1001 rows of 6 columns" not in out or not drawn:
        yield f"diff --common: {code} {out}{err}"
    (FOLDER / "alien.csv").write_text("time,scan,z\n0,0,1\n")
    code, out, err = lineshaft("diff", "a.csv", "alien.csv", "--common")
    if code != 2 or "no column in common" not in err:
        yield f"diff --common of nothing: {code} {out}{err}"
    (FOLDER / "other.csv").write_text("".join(lines[:500]))
    code, out, err = lineshaft("diff", "a.csv", "other.csv")
    if code != 1 or "1001 and 499 rows" not in out:
        yield f"diff of a shorter one: {code} {out}{err}"


RATIOS = """FUNCTION_BLOCK Ratios
VAR_INPUT one, two : LREAL; END_VAR
VAR_OUTPUT above, below, neither : LREAL; END_VAR
above := one / two;
below := -above;
neither := above - above;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Kept
VAR_INPUT above, below, neither : LREAL; END_VAR
;
END_FUNCTION_BLOCK
"""
NOT_FINITE = """lineshaft: 1
tasks: {main: {every: 1 ms}}
sources: [ratios.st]
blocks:
  a: {type: Ratios, task: main, one: 1, two: 1}
  b: {type: Kept, task: main}
stimulus: [{at: 2 ms, set: {a.two: 0}}, {at: 4 ms, set: {a.two: 2}}]
run: {for: 5 ms}
trace: {task: main, signals: [a.above, a.below, a.neither]}
"""


def check_not_finite():
    """INF, -INF and NaN are read back as what they are, and an empty cell is none of them."""
    (FOLDER / "ratios.st").write_text(RATIOS)
    (FOLDER / "f.yaml").write_text(NOT_FINITE)
    code, out, err = lineshaft("run", "f.yaml", "--trace", "f.csv")
    rows = rows_of("f.csv")
    if code != 0 or rows[3][2:] != ["INF", "-INF", "NaN"] or rows[5][2:] != ["0.5", "-0.5", "0"]:
        yield f"what is not finite in a trace: {code} {err}{rows}"
    played = NOT_FINITE[:NOT_FINITE.index("stimulus")] + (
        "stimulus: [{file: f.csv, set: {b.above: a.above, b.below: a.below, b.neither: a.neither}}]\nrun: {for: 5 ms}\n"
        "trace: {task: main, signals: [b.above, b.below, b.neither]}\n")
    (FOLDER / "played.yaml").write_text(played)
    code, out, err = lineshaft("run", "played.yaml", "--trace", "played.csv")
    if code != 0 or [row[2:] for row in rows_of("played.csv")[1:]] != [row[2:] for row in rows[1:]]:
        yield f"what is not finite is replayed as {code} {err}{rows_of('played.csv')}"
    text = (FOLDER / "f.csv").read_text()
    for name in ("plain.csv", "same.csv"):  # without what tells types
        (FOLDER / name).write_text(text)
    if lineshaft("diff", "plain.csv", "same.csv")[0] != 0:
        yield "NaN and INF deviate from themselves"
    for of, by in (("INF", "-INF"), ("NaN", ""), ("NaN", "INF"), ("INF", "1e308"), ("NaN", "0")):
        (FOLDER / "same.csv").write_text(text.replace(f",{of}", f",{by}", 1))
        code, out, err = lineshaft("diff", "plain.csv", "same.csv", "--tolerance", "1e300")
        if code != 1 or of not in out or (by and by.replace("e", "e+") not in out):
            yield f"diff of {of} and '{by}': {code} {out}{err}"
    (FOLDER / "same.csv").write_text(text.replace(",INF", ",", 1))
    found = json.loads(lineshaft("diff", "plain.csv", "same.csv", "--json")[1])["first"]
    if (found["a"], found["b"]) != ("INF", None) or "ulp" in found:
        yield f"diff --json of INF and an empty cell: {found}"
    (FOLDER / "e.yaml").write_text(NOT_FINITE + "expect: [{at: 3 ms, a.neither: 0}, {at: 3 ms, a.above: INF}, {never: a.neither, equals: 7}]\n")
    code, out, err = lineshaft("run", "e.yaml", "--json")
    answer = json.loads(out)
    told = "a.neither is NaN at 0.003 s, and no comparison with NaN is fulfilled; expected 0"
    if code != 1 or [e["ok"] for e in answer["expect"]] != [False, True, True] or answer["expect"][0]["deviation"] != told:
        yield f"expectations of what is not finite: {code} {answer['expect']}"
    (FOLDER / "e.yaml").write_text(NOT_FINITE.replace("{at: 4 ms, set: {a.two: 2}}", "{at: 4 ms, set: {a.one: 2}}"))
    signals = json.loads(lineshaft("run", "e.yaml", "--json")[1], parse_constant=lambda word: 1 / 0)["signals"]
    if [signals[f"a.{name}"] for name in ("above", "below", "neither")] != ["INF", "-INF", "NaN"]:
        yield f"what is not finite in JSON: {signals}"
    (FOLDER / "times.csv").write_text("time,x\n0,1\nINF,2\n")
    code, out, err = lineshaft("diff", "times.csv", "times.csv")
    if code != 2 or "'INF' in column 'time' is not a time" not in err:
        yield f"a time that is not finite: {code} {err}"
    if has_pages(COMMAND, "a page of what is not finite"):
        code, out, err = lineshaft("report", "f.csv", "-o", "f.html")
        if code != 0 or '"not_finite":[[2,2,"INF"]]' not in (FOLDER / "f.html").read_text():
            yield f"a page of what is not finite: {code} {err}"


def check_commas():
    """The name of an element of two dimensions has a comma."""
    (FOLDER / "two.st").write_text("PROGRAM Main VAR m : ARRAY[0..1, 1..2] OF INT; END_VAR m[1, 2] := m[1, 2] + 1; END_PROGRAM\n")
    (FOLDER / "two.yaml").write_text("lineshaft: 1\ntasks: {main: {every: 10 ms}}\nsources: two.st\n"
                                     "blocks: {p: {type: Main, task: main}}\nrun: {for: 50 ms}\n"
                                     'trace: {task: main, signals: ["p.m[1,1]", "p.m[1,2]"]}\n')
    for dialect, separator in (("rfc4180", ","), ("excel-de", ";")):
        for names, title in (("dot", "p.m[1,2]"), ("slash", "p/m[1,2]")):
            lineshaft("run", "two.yaml", "--trace", "two.csv", "--dialect", dialect, "--names", names)
            rows = rows_of("two.csv", delimiter=separator)
            if any(len(row) != 4 for row in rows) or rows[0][3] != title:
                yield f"a title with a comma in {dialect}: {rows[0]}"
            for command in (("verify", "two.csv"), ("diff", "two.csv", "two.csv")):
                if lineshaft(*command)[0] != 0:
                    yield f"{command} of a title with a comma in {dialect}: {lineshaft(*command)}"
    code, out, err = lineshaft("run", "two.yaml", "--show", "p.m[1,1],p.m[1,2]")
    if code != 0 or "p.m[1,2]" not in out:
        yield f"--show of an element of two dimensions: {code} {out}{err}"


def main():
    (FOLDER / "p.yaml").write_text(PROGRAM)
    code, out, err = lineshaft("run", "p.yaml", "--trace", "run.csv")
    failures = [] if code == 0 else [f"run: {code} {out}{err}"]
    if "the trigger of trace 'late' did not come" not in err:
        failures.append(f"a trigger that did not come is not told: {err}")
    for name in ("run.csv", "run.change.csv", "run.often.1.csv"):
        failures += [*check_rules(name), *check_tools(name)]
    failures += [*check_conditions(), *check_styles(), *check_verify(), *check_verify_bytes(), *check_origins(),
                 *check_diff(), *check_not_finite(), *check_commas()]
    for failure in failures:
        print(failure)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    COMMAND = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(folder)
        sys.exit(main())
