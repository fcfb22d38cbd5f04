#!/usr/bin/python3
"""tools/python/lineshaft.py with numpy and pandas, where they are, and without.

usage: python.py LINESHAFT SOURCE_DIR
"""

import os
import pathlib
import subprocess
import sys

source = pathlib.Path(sys.argv[2])
if len(sys.argv) < 4:
    for without in (["numpy", "pandas"], []):
        subprocess.run([sys.executable, __file__, *sys.argv[1:3], ",".join(without)], check=True)
    print("ok")
    sys.exit()

for name in sys.argv[3].split(","):
    sys.modules[name] = None  # an import of it fails
os.environ["LINESHAFT"] = sys.argv[1]
sys.path.insert(0, str(source / "tools/python"))
import lineshaft

run = lineshaft.run(source / "programs/03_ratio_change.yaml")
assert run.ok and len(run.expectations) == 6 and run["shaft.error_id"] == "none", run.expectations
trace = run.trace
assert len(trace) == len(trace.time) == 1501 and trace.time[1] == 0.002
assert trace["slave.position"][-1] == run["slave.position"] and trace.units["slave.velocity"] == "mm/s"
assert run.units["slave.velocity"] == "mm/s" and list(trace)[:2] == ["time", "scan"] and "scan" in trace
assert all(isinstance(bool(v), bool) for v in trace["change.InGear"]) and not all(trace["change.InGear"])

machine = lineshaft.run(source / "programs/08_state_machine.yaml")
assert set(machine.trace["cutter.state"]) >= {"idle", "sync", "cut", "back"}, set(machine.trace["cutter.state"])
numbers = lineshaft.run(source / "tests/cases/enumerations_are_their_numbers/program.yaml")
assert numbers["main.state"] == 11 and numbers["main.of_number"] == -3, numbers.signals
assert set(numbers.trace["main.of_number"]) == {"Idle", "15", "Fault", "-3"}, set(numbers.trace["main.of_number"])
forced = lineshaft.run(source / "programs/03_ratio_change.yaml", force=["change.RatioNumerator=3@1s..3s"])
assert not forced.ok and forced.trace["slave.velocity"][-1] != run.trace["slave.velocity"][-1]
try:
    lineshaft.run(source / "programs/03_ratio_change.yaml", force=["change.RatioNumerator=3@1s..3s"], check=True)
    assert False
except lineshaft.ExpectationError as error:
    assert "expected 9.47 mm" in str(error), error

reals = lineshaft.run(source / "tests/cases/reals_that_are_not_finite/program.yaml")
assert (reals["ratios.above"], reals["ratios.below"]) == (float("inf"), float("-inf")) and reals["ratios.neither"] != reals["ratios.neither"]
assert list(reals.trace["ratios.narrow"][:2]) == [float("inf"), float("-inf")] and reals.trace["ratios.neither"][0] != reals.trace["ratios.neither"][0]

fast = lineshaft.run(source / "programs/04_circle.yaml", speed="20 mm/s", settings={"radius": "10 mm"})
assert fast.machine_time < 5, fast.machine_time
try:
    lineshaft.run(source / "programs/04_circle.yaml", speed=20)
    assert False
except lineshaft.ProgramError as error:
    assert error.diagnostics[0]["code"] and "speed" in str(error), error
try:
    lineshaft.run(source / "nowhere.yaml")
    assert False
except lineshaft.ProgramError as error:
    assert "nowhere.yaml" in str(error), error

study = lineshaft.study(source / "programs/paper/jerk_line_table1.yaml", jobs=2)
assert study.ok and study.rows[0]["unit"] == "" and {"set", "signal", "paper", "ours"} <= study.rows[0].keys()

unsigned = lineshaft.run(source / "tests/cases/unsigned_numbers_of_64_bits/program.yaml")
assert unsigned["first.most"] == int(unsigned.trace["first.most"][-1]) == 2**64 - 1, unsigned["first.most"]

without = lineshaft.run(source / "tests/cases/expectations_of_all_kinds/program.yaml")
assert without.ok and without.trace is None

if lineshaft.numpy is None:
    assert isinstance(trace["slave.position"], list) and sys.argv[3], "numpy is not there"
else:
    assert trace["slave.position"].dtype == float and trace["change.InGear"].dtype == bool
    frame = trace.frame()
    assert frame["slave.velocity"].loc[0.002] == trace["slave.velocity"][1] and frame.attrs["units"]["slave.velocity"] == "mm/s"
