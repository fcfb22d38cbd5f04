"""lineshaft from Python: run a program or a study, get its signals, its expectations, its trace as columns.

    import lineshaft                       # this folder on sys.path, or PYTHONPATH=tools/python

    run = lineshaft.run("programs/03_ratio_change.yaml", ratio=2)
    run["slave.position"]                  # final values; run.units["slave.position"] of what is traced
    run.ok, run.expectations               # True; [{"text", "ok", "deviation"}, ...]
    run.trace["slave.velocity"]            # a column: a numpy array where numpy is there, else a list
    run.trace.time, run.trace.units        # seconds; {"slave.velocity": "mm/s", ...}
    run.trace.frame()                      # a pandas DataFrame over time

    study = lineshaft.study("programs/paper/jerk_line_table1.yaml")
    study.ok, study.rows                   # [{"set", "signal", "unit", "paper", "ours", "ok"}, ...]

A file that is wrong raises ProgramError, a fault while running Fault, each with what lineshaft said; expectations that do
not hold only set `ok`, unless check=True. The command is $LINESHAFT, that of this checkout's build, or the one on the path.
Nothing but the standard library is needed; numpy and pandas are used when they are there.
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

try:
    import numpy
except ImportError:
    numpy = None

__all__ = ["run", "study", "read_trace", "Run", "Study", "Trace", "Error", "ProgramError", "ExpectationError", "Fault"]


# What JSON has no numbers for.
_NOT_FINITE = {text: float(text) for text in ("NaN", "INF", "-INF")}


class Error(Exception):
    """What lineshaft said; `diagnostics` has each with its code, file, line, column and help."""

    def __init__(self, message, diagnostics=()):
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class ProgramError(Error):
    """The program or the call is wrong (exit 2)."""


class ExpectationError(Error):
    """An expectation, a bound or a claim does not hold (exit 1), and check=True."""


class Fault(Error):
    """Something went wrong while running (exit 3)."""


class Trace:
    """The columns of one trace by name, `time` in seconds. Enumerations are the names of their values, or a number
    that has none."""

    def __init__(self, columns, units):
        self.columns, self.units = columns, units

    def __getitem__(self, name):
        return self.columns[name]

    def __contains__(self, name):
        return name in self.columns

    def __iter__(self):
        return iter(self.columns)

    def __len__(self):
        return len(self.time)

    @property
    def time(self):
        return self.columns["time"]

    def frame(self):
        """A pandas DataFrame with the time as its index; `frame.attrs["units"]` are the units."""
        import pandas

        frame = pandas.DataFrame({name: column for name, column in self.columns.items() if name != "time"},
                                 index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = dict(self.units)
        return frame


class Run:
    """What came of a run. `traces` has one by name for each of the program's `traces:`, `trace` is that of `trace:`."""

    def __init__(self, answer, traces):
        self.signals = {name: _NOT_FINITE.get(value, value) if isinstance(value, str) else value
                        for name, value in answer["signals"].items()}
        self.expectations = answer["expect"]
        self.warnings = answer["warnings"]
        self.scans = answer["scans"]
        self.machine_time = answer["machine_time_s"]
        self.traces = traces

    def __getitem__(self, signal):
        return self.signals[signal]

    @property
    def ok(self):
        return all(expectation["ok"] for expectation in self.expectations)

    @property
    def trace(self):
        """None when the program has no `trace:`, or its trigger did not come."""
        return self.traces.get("")

    @property
    def units(self):
        return {name: unit for trace in self.traces.values() for name, unit in trace.units.items()}


class Study:
    """What came of a study's cases: `rows` of compared signals, `claims`."""

    def __init__(self, answer, ok):
        self.title, self.rows, self.claims = answer["title"], answer["rows"], answer["claims"]
        self.ok, self.answer = ok, answer


def run(program, settings=None, *, force=(), check=False, **parameters):
    """Runs a program. `settings` and keywords set its parameters: numbers, booleans, or text with a unit, "20 mm";
    `force` has texts such as "gear.RatioNumerator=3@1s..2s"."""
    program = pathlib.Path(program).resolve()
    with tempfile.TemporaryDirectory(prefix="lineshaft-") as folder:
        trace = pathlib.Path(folder, "trace.csv")
        arguments = _settings({**(settings or {}), **parameters}) + [f"--force={each}" for each in force]
        answer, code = _call("run", program, *arguments, trace=trace)
        traces = {path.stem[len("trace."):]: read_trace(path) for path in sorted(pathlib.Path(folder).glob("*.csv"))
                  if path.name != "trace.events.csv"}
    result = Run(answer, traces)
    if check and code:
        raise ExpectationError("\n".join(e["deviation"] for e in result.expectations if not e["ok"]))
    return result


def study(study_file, settings=None, *, jobs=None, check=False, **parameters):
    """Runs a study, `jobs` cases side by side (all cores unless said)."""
    arguments = _settings({**(settings or {}), **parameters}) + ([f"--jobs={jobs}"] if jobs else [])
    answer, code = _call("study", pathlib.Path(study_file).resolve(), *arguments)
    result = Study(answer, code == 0)
    if check and code:
        raise ExpectationError("not within bounds: " + ", ".join(
            f"{row['signal']} {row['ours']} {row['unit']}" for row in result.rows if not row["ok"]))
    return result


def read_trace(path):
    """A trace that `lineshaft run --trace` wrote, with units and types from its sidecar."""
    path = pathlib.Path(path)
    described = json.loads(pathlib.Path(f"{path}-metadata.json").read_text(encoding="utf-8"))["tableSchema"]["columns"]
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    columns = {}
    for column, cells in zip(described, zip(*rows) if rows else [()] * len(described)):
        columns[column["titles"]] = _column(column, cells)
    return Trace(columns, {column["titles"]: column["unit"] for column in described if column.get("unit")})


def _column(described, cells):
    kind = described.get("datatype")
    if isinstance(kind, dict):
        return _array([cell == "1" for cell in cells], bool)
    if "values" in described:
        numbers = described.get("lineshaft:numbers", range(len(described["values"])))
        names = dict(reversed(list(zip(numbers, described["values"]))))
        return _array([names.get(int(cell), cell) for cell in cells], str)
    if kind == "integer":
        whole = [int(cell) for cell in cells]
        return _array(whole, "uint64" if max(whole, default=0) >= 2**63 else "int64")
    return _array([float(cell) for cell in cells], float)


def _array(values, kind):
    return values if numpy is None else numpy.array(values, dtype=kind)


def _settings(settings):
    return [f"--set={name}={_text(value)}" for name, value in settings.items()]


def _text(value):
    if isinstance(value, bool) or (numpy is not None and isinstance(value, numpy.bool_)):
        return str(bool(value)).lower()
    if isinstance(value, (str, int)):
        return str(value)
    return repr(float(value))


def _command():
    build = pathlib.Path(__file__).resolve().parents[2] / "build/release/lineshaft"
    found = os.environ.get("LINESHAFT") or (str(build) if build.exists() else shutil.which("lineshaft"))
    if not found:
        raise Error("lineshaft is not there: build it by tools/quickstart, or say where it is in LINESHAFT")
    return found


def _call(subcommand, file, *arguments, trace=None):
    """lineshaft's answer and its exit code, 0 or 1."""
    command = [_command(), subcommand, str(file), "--json", *arguments]
    asked = subprocess.run(command + ([f"--trace={trace}"] if trace else []), capture_output=True, text=True)
    if trace and asked.returncode == 2 and "L0503" in asked.stdout:  # the program has no trace
        asked = subprocess.run(command, capture_output=True, text=True)
    if asked.returncode == 130:
        raise KeyboardInterrupt
    try:
        answer = json.loads(asked.stdout)
    except ValueError:
        answer = {}
    if asked.returncode in (0, 1):
        return answer, asked.returncode
    diagnostics = answer.get("diagnostics", [])
    said = "\n".join(_rendered(each) for each in diagnostics) or answer.get("fault") or asked.stderr.strip()
    raise (ProgramError if asked.returncode == 2 else Fault)(said, diagnostics)


def _rendered(diagnostic):
    place = "{file}:{line}:{column}: ".format(**diagnostic) if diagnostic.get("file") else ""
    advice = f" ({diagnostic['help']})" if diagnostic.get("help") else ""
    return f"{place}{diagnostic['message']} [{diagnostic['code']}]{advice}"
