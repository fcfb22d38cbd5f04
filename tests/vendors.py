#!/usr/bin/python3
"""Commands of vendors' motion libraries at random: vendors.py LINESHAFT [COUNT [FIRST_SEED]]

COUNT programs of each vendor command two axes, x and y, of which y can follow x: each pin of each block is set at random
times, the power goes and comes, overrides are 0. In each scan the outputs of each block keep the rules of PLCopen (Part 1,
2.4.1), no two blocks control one axis, and no axis jumps. At the end all is reset and stopped, and nothing is busy any
more. What goes wrong is shrunk to the settings that it takes, and printed with its seed.
"""
import csv
import os
import random
import subprocess
import sys
import tempfile

POSITIONS = [0, 1, 5, 20, 40, -30]
DISTANCES = [0, 0.001, 3, 10, -10, 40, -60]
VELOCITIES = [100, 50, 20, 5]
ACCELERATIONS = [0, 1000, 300, 100]  # 0: the axis' own, of SoftMotion and Siemens an error
JERKS = [0, 50000, 5000]
MODES = [0, 0, 0, 1, 2, 3, 4, 5]
DYNAMICS = {"Acceleration": ACCELERATIONS, "Deceleration": ACCELERATIONS, "Jerk": JERKS}

LENGTH = 600  # of what is drawn [ms]
GREATEST = {"velocity": 250, "acceleration": 2600}  # what is superimposed, or follows, has twice the axis' own
CYCLE = 0.004  # of the program [s]

ALL = "Done Busy Active CommandAborted Error"
FEW = "Done Busy CommandAborted Error"
SHORT = "Done Busy Error"


class Command:
    """A block, its pins with the values that are drawn, and what its outputs promise."""

    def __init__(self, name, type_, axes, pins, outputs, edges="Execute", is_level=False, error_id="ErrorID"):
        self.name, self.type, self.axes, self.pins = name, type_, axes, pins
        self.outputs, self.edges = outputs.split(), edges.split()
        self.is_level = is_level  # of MC_Jog and its like: an input that is held
        self.error_id = error_id

    @property
    def is_stop(self):
        return self.type == "MC_Stop"

    @property
    def is_power(self):
        return self.type == "MC_Power"

    @property
    def axis(self):
        return "y" if "Slave" in self.axes else self.axes[-1]

    @property
    def controls(self):
        return "Active" in self.outputs and "uper" not in self.type and "Phasing" not in self.type and self.type != "MC_Home"


def reached(name, of):
    return of.replace("Done", name)


def of_each_axis(make):
    return make("x", "Axis := x") + make("y", "Axis := y")


FOLLOWS = "Master := x, Slave := y"


def of_twincat(a, axis):
    return [
        Command(f"absolute_{a}", "MC_MoveAbsolute", axis,
                {"Position": POSITIONS, "Velocity": VELOCITIES + [0], **DYNAMICS, "BufferMode": MODES}, ALL),
        Command(f"relative_{a}", "MC_MoveRelative", axis,
                {"Distance": DISTANCES, "Velocity": VELOCITIES, **DYNAMICS, "BufferMode": MODES}, ALL),
        Command(f"additive_{a}", "MC_MoveAdditive", axis,
                {"Distance": DISTANCES, "Velocity": VELOCITIES, "BufferMode": MODES}, ALL),
        Command(f"modulo_{a}", "MC_MoveModulo", axis,
                {"Position": [0, 10, 350, 370, -5], "Velocity": VELOCITIES, "Direction": [1, 2, 3, 4, 0], "BufferMode": MODES}, ALL),
        Command(f"velocity_{a}", "MC_MoveVelocity", axis,
                {"Velocity": VELOCITIES + [0, -3], "Direction": [1, 3, 4, 2, 9], "BufferMode": MODES}, reached("InVelocity", ALL)),
        Command(f"continuous_{a}", "MC_MoveContinuousAbsolute", axis,
                {"Position": POSITIONS, "Velocity": VELOCITIES, "EndVelocity": [0, 10, 50], "BufferMode": MODES},
                reached("InEndVelocity", ALL)),
        Command(f"halt_{a}", "MC_Halt", axis, {"Deceleration": ACCELERATIONS, "BufferMode": MODES}, ALL),
        Command(f"stop_{a}", "MC_Stop", axis, {"Deceleration": ACCELERATIONS}, ALL),
        Command(f"add_{a}", "MC_MoveSuperImposed", axis,
                {"Mode": [1, 2, 3, 4, 5, 6, 0], "Distance": DISTANCES, "VelocityDiff": VELOCITIES,
                 "VelocityProcess": [100, 200], "Length": [10, 50, 100]}, ALL),
        Command(f"drop_{a}", "MC_AbortSuperposition", axis, {}, SHORT),
        Command(f"place_{a}", "MC_SetPosition", axis, {"Position": POSITIONS, "Mode": [False, True]}, SHORT),
        Command(f"home_{a}", "MC_Home", axis,
                {"Position": POSITIONS, "HomingMode": [4, 0, 7, 8, 99], "bCalibrationCam": [False, True]}, ALL),
        Command(f"jog_{a}", "MC_Jog", axis, {"Mode": [0, 1, 2, 3, 4, 7], "Position": [1, 5], "Velocity": VELOCITIES + [0]},
                ALL, "JogForward JogBackwards", True),
        Command(f"reset_{a}", "MC_Reset", axis, {}, SHORT),
        Command(f"power_{a}", "MC_Power", axis,
                {"Enable": [True, False], "Enable_Positive": [True, False], "Enable_Negative": [True, False],
                 "Override": [100, 50, 0]}, "", ""),
    ]


def of_softmotion(a, axis):
    dynamics = {"Acceleration": [-1] + ACCELERATIONS, "Deceleration": [-1] + ACCELERATIONS, "Jerk": [-1] + JERKS[1:]}
    ways = {"Direction": [0, 1, 2, 3, -1], "BufferMode": MODES}
    return [
        Command(f"absolute_{a}", "MC_MoveAbsolute", axis, {"Position": POSITIONS, "Velocity": VELOCITIES + [0], **dynamics, **ways}, ALL),
        Command(f"relative_{a}", "MC_MoveRelative", axis,
                {"Distance": DISTANCES, "Velocity": VELOCITIES, **dynamics, "BufferMode": MODES}, ALL),
        Command(f"additive_{a}", "MC_MoveAdditive", axis, {"Distance": DISTANCES, "Velocity": VELOCITIES, "BufferMode": MODES}, ALL),
        Command(f"velocity_{a}", "MC_MoveVelocity", axis, {"Velocity": VELOCITIES + [0, -3], **ways}, reached("InVelocity", ALL)),
        Command(f"through_{a}", "SMC_MoveContinuousAbsolute", axis,
                {"Position": POSITIONS, "Velocity": VELOCITIES, "EndVelocity": [0, 10, 50], "BufferMode": MODES},
                reached("InEndVelocity", ALL)),
        Command(f"further_{a}", "SMC_MoveContinuousRelative", axis,
                {"Distance": DISTANCES, "Velocity": VELOCITIES, "EndVelocity": [0, 10, 50], "BufferMode": MODES},
                reached("InEndVelocity", ALL)),
        Command(f"halt_{a}", "MC_Halt", axis, {"Deceleration": [-1] + ACCELERATIONS, "BufferMode": MODES}, ALL),
        Command(f"stop_{a}", "MC_Stop", axis, {"Deceleration": [-1] + ACCELERATIONS}, ALL),
        Command(f"add_{a}", "MC_MoveSuperImposed", axis, {"Distance": DISTANCES, "VelocityDiff": VELOCITIES}, FEW),
        Command(f"drop_{a}", "MC_HaltSuperImposed", axis, {}, ALL),
        Command(f"place_{a}", "MC_SetPosition", axis, {"Position": POSITIONS, "Mode": [False, True]}, SHORT),
        Command(f"home_{a}", "MC_Home", axis, {"Position": POSITIONS}, FEW),
        Command(f"jog_{a}", "MC_Jog", axis, {"Velocity": VELOCITIES + [0]}, "Busy CommandAborted Error", "JogForward JogBackward", True,
                "ErrorId"),
        Command(f"inch_{a}", "SMC_Inch", axis, {"Velocity": VELOCITIES + [0], "Distance": [1, 10, 50]},
                "Busy CommandAborted Error", "InchForward InchBackward", True, "ErrorId"),
        Command(f"reset_{a}", "MC_Reset", axis, {}, SHORT),
        Command(f"power_{a}", "MC_Power", axis,
                {"Enable": [True, False], "bRegulatorOn": [True, False], "bDriveStart": [True, False]}, "", ""),
    ]


def of_siemens(a, axis):
    dynamics = {"Acceleration": [-1] + ACCELERATIONS, "Deceleration": [-1] + ACCELERATIONS, "Jerk": [-1] + JERKS}
    modes = {"BufferMode": [0, 0, 1, 2]}
    return [
        Command(f"absolute_{a}", "MC_MoveAbsolute", axis,
                {"Position": POSITIONS, "Velocity": VELOCITIES + [0], **dynamics, **modes, "Direction": [1, 2, 3]}, FEW),
        Command(f"relative_{a}", "MC_MoveRelative", axis, {"Distance": DISTANCES, "Velocity": VELOCITIES, **dynamics, **modes}, FEW),
        Command(f"velocity_{a}", "MC_MoveVelocity", axis,
                {"Velocity": VELOCITIES + [0, -3], "Direction": [0, 1, 2, 3], "Current": [False, False, True], **modes},
                reached("InVelocity", FEW)),
        Command(f"halt_{a}", "MC_Halt", axis, {"Deceleration": [-1] + ACCELERATIONS, "Mode": [0, 1, 2]}, FEW),
        Command(f"stop_{a}", "MC_Stop", axis, {"Mode": [0, 2, 3, 1], "Deceleration": [-1] + ACCELERATIONS}, FEW),
        Command(f"add_{a}", "MC_MoveSuperimposed", axis, {"Distance": DISTANCES, "VelocityDiff": VELOCITIES}, FEW),
        Command(f"drop_{a}", "MC_HaltSuperimposed", axis, {}, FEW),
        Command(f"home_{a}", "MC_Home", axis, {"Position": POSITIONS, "Mode": [0, 1, 2, 3, 5, 6, 7, 11]}, FEW),
        Command(f"jog_{a}", "MC_MoveJog", axis, {"Velocity": VELOCITIES + [0]}, "CommandAborted Error", "JogForward JogBackward", True),
        Command(f"reset_{a}", "MC_Reset", axis, {"Restart": [False, False, True]}, FEW),
        Command(f"power_{a}", "MC_Power", axis, {"Enable": [True, False], "StopMode": [0, 1, 2]}, "", ""),
    ]


def of_mapp(a, axis):
    jog = {"Enable": [True, True, False], "Velocity": VELOCITIES + [0]}
    return [
        Command(f"absolute_{a}", "MC_MoveAbsolute", axis,
                {"Position": POSITIONS, "Velocity": VELOCITIES + [0], **DYNAMICS, "BufferMode": MODES, "Direction": [0, 1, 2, 3]}, ALL),
        Command(f"additive_{a}", "MC_MoveAdditive", axis, {"Distance": DISTANCES, "Velocity": VELOCITIES, "BufferMode": MODES}, ALL),
        Command(f"velocity_{a}", "MC_MoveVelocity", axis,
                {"Velocity": VELOCITIES + [0, -3], "Direction": [0, 1, 2, 3], "BufferMode": MODES}, reached("InVelocity", ALL)),
        Command(f"halt_{a}", "MC_Halt", axis, {"Deceleration": ACCELERATIONS, "BufferMode": MODES}, ALL),
        Command(f"stop_{a}", "MC_Stop", axis, {"Deceleration": ACCELERATIONS}, FEW),
        Command(f"home_{a}", "MC_Home", axis, {"Position": POSITIONS}, ALL),
        Command(f"jog_{a}", "MC_BR_JogVelocity", axis, jog, "CommandAborted Error", "JogPositive JogNegative", True),
        Command(f"limited_{a}", "MC_BR_JogLimitPosition", axis, {**jog, "FirstPosition": [0, -10], "LastPosition": [0, 30]},
                "CommandAborted Error", "JogPositive JogNegative", True),
        Command(f"cyclic_{a}", "MC_BR_MoveCyclicVelocity", axis, {"CyclicVelocity": [10, -20, 50, 0]}, "Busy CommandAborted Error",
                "Enable", True),
        Command(f"reset_{a}", "MC_Reset", axis, {}, SHORT),
        Command(f"power_{a}", "MC_Power", axis, {"Enable": [True, False]}, "", ""),
    ]


GEAR_IN_POSITION = {"RatioNumerator": [1, 2, -1], "MasterSyncPosition": POSITIONS, "SlaveSyncPosition": POSITIONS}
SHIFT = {"PhaseShift": DISTANCES, "Velocity": VELOCITIES}

VENDORS = {
    "twincat": of_each_axis(of_twincat) + [
        Command("gear", "MC_GearIn", FOLLOWS, {"RatioNumerator": [1, 2, -1]}, reached("InGear", ALL)),
        Command("ratio", "MC_GearInDyn", FOLLOWS, {"GearRatio": [1, 0.5, -1]}, reached("InGear", ALL), "Enable", True),
        Command("leave", "MC_GearOut", "Slave := y", {}, ALL),
        Command("phase", "MC_PhasingAbsolute", FOLLOWS, SHIFT, ALL),
        Command("shift", "MC_PhasingRelative", FOLLOWS, SHIFT, ALL),
        Command("stay", "MC_HaltPhasing", FOLLOWS, {}, ALL),
    ],
    "codesys": of_each_axis(of_softmotion) + [
        Command("gear", "MC_GearIn", FOLLOWS, {"RatioNumerator": [1, 2, -1], "BufferMode": [0, 1], "Acceleration": [-1] + ACCELERATIONS},
                reached("InGear", ALL)),
        Command("meet", "MC_GearInPos", FOLLOWS, {**GEAR_IN_POSITION, "MasterStartDistance": [0, 0, 10]}, reached("InSync", ALL)),
        Command("leave", "MC_GearOut", "Slave := y", {}, SHORT),
        Command("phase", "MC_Phasing", FOLLOWS, SHIFT, FEW),
    ],
    "scl": of_each_axis(of_siemens) + [
        Command("gear", "MC_GearIn", FOLLOWS, {"RatioNumerator": [1, 2, -1, 0], "Acceleration": [-1] + ACCELERATIONS},
                reached("InGear", FEW)),
        Command("meet", "MC_GearInPos", FOLLOWS, {**GEAR_IN_POSITION, "SyncProfileReference": [0, 1], "MasterStartDistance": [10, 20]},
                reached("InSync", FEW)),
        Command("leave", "MC_GearOut", "Slave := y", {"SyncOutDirection": [1, 2, 3, 0]}, FEW),
        Command("phase", "MC_PhasingAbsolute", FOLLOWS, SHIFT, FEW),
    ],
    "automation_studio": of_each_axis(of_mapp) + [
        Command("gear", "MC_GearIn", FOLLOWS,
                {"RatioNumerator": [1, 2, -1], "RatioDenominator": [1], "BufferMode": [0, 1], "Acceleration": ACCELERATIONS},
                reached("InGear", ALL)),
        Command("leave", "MC_GearOut", "Slave := y", {}, SHORT),
        Command("phase", "MC_PhasingAbsolute", FOLLOWS, SHIFT, ALL),
    ],
}
NUMBERS = {"BufferMode", "Direction", "HomingMode", "StopMode", "SyncProfileReference", "SyncOutDirection", "Mode"}


def type_of(vendor, pin, values):
    if isinstance(values[0], bool):
        return "BOOL"
    if pin in NUMBERS:
        return "INT"
    if pin in ("RatioNumerator", "RatioDenominator") and vendor != "twincat":
        return "DINT"
    return "REAL" if vendor == "automation_studio" and not pin.endswith(("Position", "Distance", "PhaseShift")) else "LREAL"


def source(vendor):
    """A program that calls all, and makes a number of the outputs of each: a bit for each of its names, and one for ErrorID."""
    pins, numbers, blocks, body = [], [], [], []
    for c in VENDORS[vendor]:
        pins += [f"{c.name}__{edge} : BOOL;" for edge in c.edges]
        pins += [f"{c.name}__{pin} : {type_of(vendor, pin, values)};" for pin, values in c.pins.items()]
        blocks.append(f"{c.name} : {c.type};")
        given = ", ".join(f"{pin} := {c.name}__{pin}" for pin in c.edges + list(c.pins))
        body.append(f"{c.name}({c.axes}, {given});")
        if not c.outputs:
            continue
        numbers.append(f"{c.name}_told : INT;")
        told = [f"SEL({c.name}.{output}, 0, {1 << bit})" for bit, output in enumerate(c.outputs)]
        told.append(f"SEL(TO_DINT({c.name}.{c.error_id}) <> 0, 0, {1 << len(c.outputs)})")
        body.append(f"{c.name}_told := {' + '.join(told)};")
    unit, handle = ("FUNCTION_BLOCK", "TO_PositioningAxis") if vendor == "scl" else ("PROGRAM", "AXIS_REF")
    sections = [("VAR_INPUT", pins), ("VAR_IN_OUT", [f"x, y : {handle};"]), ("VAR_OUTPUT", numbers), ("VAR", blocks)]
    lines = [f"{unit} Main"]
    for name, declared in sections:
        lines += [name, *declared, "END_VAR"]
    return "\n".join(lines + body + [f"END_{unit}", ""])


def draw(vendor, seed):
    """(when [ms], pin, value)"""
    choose = random.Random(seed)
    pins = []
    for c in VENDORS[vendor]:
        pins += [(c, edge, [True, False]) for edge in c.edges] * (1 if c.is_stop else 3)
        pins += [(c, pin, values) for pin, values in c.pins.items()]
    settings, at = [], 40
    while at < LENGTH:
        for _ in range(choose.randrange(1, 6)):
            c, pin, values = choose.choice(pins)
            is_seldom = c.is_power and choose.randrange(20) or c.is_stop and pin == "Execute" and choose.randrange(3)
            if not is_seldom:
                settings.append((at, f"{c.name}__{pin}", choose.choice(values)))
        at += 4 * choose.randrange(1, 7)
    return settings


def at_rest(vendor):
    """All is let go and has power, errors are reset, and both axes are stopped."""
    end = LENGTH + 40
    commands = VENDORS[vendor]
    settings = [(end, f"{c.name}__{edge}", False) for c in commands for edge in c.edges]
    settings += [(end, f"{c.name}__{pin}", values[0]) for c in commands if c.is_power or c.is_stop for pin, values in c.pins.items()]
    for again in range(end + 2000, end + 2600, 200):
        for value, at in ((True, again), (False, again + 100)):
            settings += [(at, f"{c.name}__Execute", value) for c in commands if c.type == "MC_Reset"]
    return settings + [(end + 2800, f"{c.name}__Execute", True) for c in commands if c.is_stop]


def program(vendor, settings):
    commands = VENDORS[vendor]
    first = [(0, f"{c.name}__{pin}", values[0]) for c in commands for pin, values in c.pins.items()]
    at = {}
    for when, pin, value in first + settings + at_rest(vendor):
        at.setdefault(when, {})[pin] = str(value).lower()
    axis = "{type: axis, task: servo, default_jerk: 20000 mm/s^3}"
    lines = ["lineshaft: 1", "title: drawn", "" if vendor == "scl" else f"dialect: {vendor}",
             f"sources: [{file_of(vendor)}]", "tasks: {servo: {every: 2 ms, priority: 26}, plc: {every: 4 ms, priority: 1}}",
             "blocks:", f"  x: {axis}", f"  y: {axis}", "  m: {type: Main, task: plc, x: x, y: y}", "stimulus:"]
    for when in sorted(at):
        lines.append(f"  - {{at: {when} ms, set: {{{', '.join(f'm.{pin}: {value}' for pin, value in at[when].items())}}}}}")
    signals = [f"m.{c.name}_told" for c in commands if c.outputs] + [f"m.{c.name}__{edge}" for c in commands for edge in c.edges]
    signals += [f"{name}.{signal}" for name in "xy" for signal in ("velocity", "acceleration")]
    return "\n".join(lines + [f"run: {{for: {LENGTH + 4000} ms, on_error: continue}}",
                              f"trace: {{task: plc, signals: [{', '.join(signals)}]}}", ""])


def file_of(vendor):
    return "main.scl" if vendor == "scl" else "main.st"


class Watched:
    """What the outputs of a block have told so far."""

    def __init__(self, command):
        self.command = command
        self.execute, self.told, self.end = False, set(), None

    def look(self, row):
        """What is wrong with it in this scan, or nothing."""
        c = self.command
        number = int(row[f"m.{c.name}_told"])
        told = {output for bit, output in enumerate(c.outputs) if number >> bit & 1}
        execute = any(row[f"m.{c.name}__{edge}"] in ("1", "true") for edge in c.edges)
        wrong = self.rules(told, number >> len(c.outputs) & 1 == 1, execute)
        self.execute, self.told = execute, told
        return wrong and f"{c.name} ({c.type}) tells {sorted(told)}: {wrong}"

    def rules(self, told, has_id, execute):
        ends = told & {"Done", "CommandAborted", "Error"}
        holds = self.command.is_stop and told >= {"Done", "Busy"}  # TwinCAT's goes on until Execute falls
        if len(ends) > 1 or ends and "Busy" in told and not holds:
            return "that exclude each other"
        if told & {"Active", "InVelocity", "InEndVelocity", "InGear", "InSync"} and not told & {"Busy", "Done"}:
            return "but not Busy"
        if has_id != ("Error" in told):
            return "ErrorID does not go with Error"
        if self.command.is_level:
            return None
        return self.ends_once(min(ends, default=None), "Busy" in told, execute)

    def ends_once(self, end, busy, execute):
        rises = execute and not self.execute
        last, self.end = self.end, end or (None if busy or rises or not execute else self.end)
        if execute and not end and not busy:
            return "nothing, with Execute"
        if last and not rises and end and end != last:
            return f"another end, behind {last}"
        if last and not rises and busy and "Busy" not in self.told:
            return f"Busy again, behind {last}"
        if last and end and not execute and not self.execute:
            return f"{end} longer than Execute"
        return None


def look_at_axes(row, last):
    for name in "xy":
        for signal, most in GREATEST.items():
            if abs(float(row[f"{name}.{signal}"])) > most:
                return f"{name}.{signal} is {row[f'{name}.{signal}']}"
        change = float(row[f"{name}.velocity"]) - float((last or row)[f"{name}.velocity"])
        if abs(change) > GREATEST["acceleration"] * CYCLE + 1e-6:
            return f"{name}.velocity changes by {change}"
    return None


def judge(vendor, rows):
    watched = [Watched(c) for c in VENDORS[vendor] if c.outputs]
    last = None
    for row in rows:
        time = next(iter(row.values()))
        wrong = next(filter(None, (w.look(row) for w in watched)), None) or look_at_axes(row, last)
        for name in "xy":
            active = [w.command.name for w in watched if "Active" in w.told and w.command.controls and w.command.axis == name]
            if len(active) > 1:
                wrong = f"{' and '.join(active)} control {name}"
        if wrong:
            return f"at {time} s {wrong}"
        last = row
    for w in watched:
        if w.told and not w.command.is_stop:
            return f"in the end {w.command.name} ({w.command.type}) tells {sorted(w.told)}"
    return None if all(float(last[f"{name}.velocity"]) == 0 for name in "xy") else "in the end an axis moves"


def run(lineshaft, folder, vendor, settings):
    path = os.path.join(folder, "drawn.yaml")
    with open(path, "w") as file:
        file.write(program(vendor, settings))
    trace = os.path.join(folder, "trace.csv")
    made = subprocess.run([lineshaft, "run", "--quiet", "--trace", trace, path], capture_output=True, text=True)
    if made.returncode != 0:
        return made.stdout + made.stderr
    with open(trace) as file:
        return judge(vendor, csv.DictReader(line for line in file if not line.startswith("#")))


def shrink(settings, goes_wrong):
    size = len(settings) // 2
    while size:
        at = 0
        while at + size <= len(settings):
            less = settings[:at] + settings[at + size:]
            if goes_wrong(less):
                settings = less
            else:
                at += size
        size //= 2
    return settings


def main():
    lineshaft = os.path.abspath(sys.argv[1])
    count, first = int((sys.argv[2:] or [10])[0]), int((sys.argv[3:] or [1])[0])
    for vendor in VENDORS:
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, file_of(vendor)), "w") as file:
                file.write(source(vendor))
            for seed in range(first, first + count):
                settings = draw(vendor, seed)
                if not run(lineshaft, folder, vendor, settings):
                    continue
                less = shrink(settings, lambda some: run(lineshaft, folder, vendor, some))
                print(f"{vendor}, seed {seed}: {run(lineshaft, folder, vendor, less)}")
                sys.exit("\n".join(f"  {at} ms  {pin} = {value}" for at, pin, value in less))
    print(f"{count} programs of each of {len(VENDORS)} vendors keep the rules")


main()
