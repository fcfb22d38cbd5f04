#!/usr/bin/python3
"""Random networks of LAD, written as a SIMATIC SD document (`.s7dcl`) and as SCL, in which each element is a statement: the same bytes.

usage: rungs.py LINESHAFT [NETWORKS [SEED]]
"""

import pathlib
import random
import subprocess
import sys
import tempfile

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
networks = int(sys.argv[2]) if len(sys.argv) > 2 else 200
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1

INPUTS = [f"i{n}" for n in range(4)]  # change from scan to scan
BITS = [f"b{n}" for n in range(4)]
NUMBERS = [f"n{n}" for n in range(3)]
DRIVE = f"""    #r := #r * 1664525 + 1013904223;
{''.join(f'    #{name} := (#r / {2 ** (9 + i)}) MOD 2 = 1;{chr(10)}' for i, name in enumerate(INPUTS))}"""
SIGNS = {"EQ": "=", "NE": "<>", "GT": ">", "LT": "<", "GE": ">=", "LE": "<="}


class Block:
    """A FUNCTION_BLOCK in both forms."""

    def __init__(self, draw):
        self.draw, self.rungs, self.statements, self.own, self.temporary, self.wires = draw, [], [], {}, 0, 0
        self.outside = []  # rungs that end at a wire

    def variable(self, kind):
        name = f"{kind[:2].lower()}{len(self.own)}"
        self.own[name] = kind
        return name

    def kept(self, value):
        """In the text all power is a variable, as it is there and then."""
        self.temporary += 1
        self.statements.append(f"#t{self.temporary} := {value};")
        return f"#t{self.temporary}"

    def wire(self):
        self.wires += 1
        return f"wire#w{self.wires}"

    def operand(self):
        return self.draw.choice(INPUTS + BITS)

    def number(self):
        return self.draw.choice([f"#{n}" for n in NUMBERS] + ["3", "-2"])

    def element(self, power):
        """The lines of one, and the power behind it."""
        draw, add = self.draw, self.statements.append
        kind = draw.choice(["Contact"] * 6 + ["I_Contact"] * 3 + ["compare", "P_Contact", "N_Contact", "P_Trig", "Not", "Coil", "S_Coil", "R_Coil",
                                                                 "Move", "Add", "Inc", "TON", "TOF", "CTU", "S_RS", "S_SR", "InRange", "P_Coil", "Calculate"])
        if kind in ("Contact", "I_Contact"):
            name = self.operand()
            return [f"{kind}( #{name} )"], self.kept(f"{power} AND {'NOT ' if kind[0] == 'I' else ''}#{name}")
        if kind == "compare":
            name, a, b = draw.choice(list(SIGNS)), self.number(), self.number()
            return ['{ S7_Templates := "SrcType := Int" }', f"{name}_Contact( in1 := {a}, in2 := {b} )"], self.kept(f"{power} AND ({a} {SIGNS[name]} {b})")
        if kind == "InRange":
            low, at, high = self.number(), self.number(), self.number()
            return [f"InRange( min := {low}, in := {at}, max := {high} )"], self.kept(f"{power} AND {low} <= {at} AND {at} <= {high}")
        if kind in ("P_Contact", "N_Contact"):
            name, bit = self.operand(), self.variable("Bool")
            edge = self.kept(f"#{name} AND NOT #{bit}" if kind[0] == "P" else f"NOT #{name} AND #{bit}")
            add(f"#{bit} := #{name};")
            return [f"{kind}(", f"  operand := #{name},", f"  bit := #{bit}", ")"], self.kept(f"{power} AND {edge}")
        if kind == "P_Trig":
            bit = self.variable("Bool")
            edge = self.kept(f"{power} AND NOT #{bit}")
            add(f"#{bit} := {power};")
            return [f"P_Trig( #{bit} )"], edge
        if kind == "Not":
            return ["Not()"], self.kept(f"NOT {power}")
        if kind == "Coil":
            name = draw.choice(BITS)
            add(f"#{name} := {power};")
            return [f"Coil( #{name} )"], power
        if kind == "P_Coil":
            name, bit = draw.choice(BITS), self.variable("Bool")
            add(f"#{name} := {power} AND NOT #{bit}; #{bit} := {power};")
            return [f"P_Coil( operand := #{name}, bit := #{bit} )"], power
        if kind in ("S_Coil", "R_Coil"):
            name = draw.choice(BITS)
            add(f"IF {power} THEN #{name} := {'TRUE' if kind[0] == 'S' else 'FALSE'}; END_IF;")
            return [f"{kind}( #{name} )"], power
        if kind in ("Move", "Add", "Inc", "Calculate"):
            a, b, target = self.number(), self.number(), f"#{draw.choice(NUMBERS)}"
            lines = {"Move": [f"Move( in := {a}, out1 => {target} )"],
                     "Add": [f"Add( in1 := {a}, in2 := {b}, out => {target} )"],
                     "Inc": [f"Inc( {target} )"],
                     "Calculate": ['{ S7_Templates := "SrcType := Int"; S7_Expression := "in1 - 2 * in2" }',
                                   f"Calculate( in1 := {a}, in2 := {b}, out => {target} )"]}[kind]
            value = {"Move": a, "Add": f"{a} + {b}", "Inc": f"{target} + 1", "Calculate": f"{a} - 2 * ({b})"}[kind]
            add(f"IF {power} THEN {target} := {value}; END_IF;")
            return lines, power
        if kind in ("TON", "TOF"):
            timer, time = self.variable(kind + "_TIME"), draw.choice([10, 25, 40])
            add(f"#{timer}(IN := {power}, PT := T#{time}ms);")
            return ['{ S7_Templates := "time_type := Time" }', f"#{timer}.{kind}(", f"  pt := T#{time}ms,", "  et =>", ")"], self.kept(f"#{timer}.Q")
        if kind == "CTU":
            counter, reset, target = self.variable("CTU_INT"), self.operand(), draw.choice(NUMBERS)
            self.temporary += 1
            add(f"#{counter}.CTU(CU := {power}, R := #{reset}, PV := 2, Q => #t{self.temporary}, CV => #{target});")
            return [f"#{counter}.CTU( r := #{reset}, pv := 2, cv => #{target} )"], f"#t{self.temporary}"
        # A flip-flop, whose second input is a rung of its own, which is executed before it.
        name, wire, pin = draw.choice(BITS), self.wire(), kind[2].lower() + "1"
        pin = "s1" if kind == "S_RS" else "r1"
        lines, other = self.series("TRUE", draw.randint(1, 2))
        self.outside.append(["RUNG wire#powerrail"] + lines + [f"END_RUNG {wire}"])
        add(f"#{name} := {other} OR #{name} AND NOT {power};" if kind == "S_RS" else f"#{name} := ({power} OR #{name}) AND NOT {other};")
        return [f"{kind}( operand := #{name}, {pin} := {wire} )"], self.kept(f"#{name}")

    def series(self, power, count, depth=1):
        lines = []
        for _ in range(count):
            if depth > 0 and self.draw.random() < 0.3:
                more, power = self.parallel(power, depth - 1)
            else:
                more, power = self.element(power)
            lines += more
        return lines, power

    def parallel(self, power, depth):
        """The first branch stands in the rung; the others are rungs between its wires."""
        begin, end = self.wire(), self.wire()
        first, behind = self.series(power, self.draw.randint(1, 2), depth)
        for _ in range(self.draw.randint(1, 2)):
            lines, other = self.series(power, self.draw.randint(0, 2), depth)
            self.outside.append([f"RUNG {begin}"] + lines + [f"END_RUNG {end}"])
            behind = self.kept(f"{behind} OR {other}")
        return [begin] + first + [end], behind

    def network(self):
        self.outside, forks = [], []
        lines, power = self.series("TRUE", self.draw.randint(1, 5))
        if self.draw.random() < 0.4:
            fork = self.wire()
            lines.append(fork)
            forks = [(fork, power) for _ in range(self.draw.randint(1, 2))]
        more, _ = self.series(power, self.draw.randint(1, 2))
        rungs = [["RUNG wire#powerrail"] + lines + more + ["END_RUNG"]]
        for fork, at in forks:
            lines, _ = self.series(at, self.draw.randint(1, 3))
            rungs.append([f"RUNG {fork}"] + lines + ["END_RUNG"])
        if self.draw.random() < 0.5:  # who ends at a wire is executed where that is needed, wherever it stands
            rungs += self.outside
        else:
            rungs = self.outside + rungs
        self.rungs.append("\n".join(line for rung in rungs for line in rung))

    def declarations(self, temporary):
        variables = "".join(f"    {name} : {kind};\n" for name, kind in self.own.items())
        outputs = "".join(f"    {name} : {kind};\n" for names, kind in ((INPUTS + BITS, "Bool"), (NUMBERS, "Int")) for name in names)
        return (f"VAR_OUTPUT\n{outputs}END_VAR\nVAR\n    r : UDInt := 4711;\n{variables}END_VAR\n"
                + (f"VAR_TEMP\n{''.join(f'    t{n + 1} : Bool;{chr(10)}' for n in range(self.temporary))}END_VAR\n" if temporary else ""))

    def document(self, name):
        drawn = "".join(f'{{ S7_Language := "LAD" }}\nNETWORK\n{each}\nEND_NETWORK\n' for each in self.rungs)
        return (f'{{ S7_PreferredLanguage := "LAD" }}\nFUNCTION_BLOCK "{name}"\n{self.declarations(False)}'
                f'{{ S7_Language := "SCL" }}\nNETWORK\n{DRIVE}END_NETWORK\n{drawn}END_FUNCTION_BLOCK\n')

    def text(self, name):
        return (f'FUNCTION_BLOCK "{name}"\n{self.declarations(True)}BEGIN\n{DRIVE}' + "\n".join(self.statements) + "\nEND_FUNCTION_BLOCK\n")


def program(name, source):
    signals = ", ".join(f"it.{signal}" for signal in INPUTS + BITS + NUMBERS)
    return (f"lineshaft: 1\ntasks: {{main: {{every: 10 ms}}}}\nsources: [{source}]\nblocks:\n  it: {{type: {name}, task: main}}\n"
            f"trace: {{task: main, signals: [{signals}]}}\nrun: {{for: 400 ms}}\n")


def run(folder, form, text):
    (folder / f"block{form}").write_text(text)
    (folder / f"program{form}.yaml").write_text(program("Block", f"block{form}"))
    done = subprocess.run([lineshaft, "run", "--quiet", f"program{form}.yaml", "--trace", f"trace{form}.csv"], cwd=folder, capture_output=True, text=True)
    return done, (folder / f"trace{form}.csv").read_bytes() if done.returncode == 0 else b""


def differs(folder, number, count):
    block = Block(random.Random(number))
    for _ in range(count):
        block.network()
    drawn, trace = run(folder, ".s7dcl", block.document("Block"))
    written, other = run(folder, ".scl", block.text("Block"))
    if drawn.returncode == 0 and written.returncode == 0 and trace == other:
        changing.append(len({line.partition(b",")[2] for line in trace.splitlines()}))
        return None
    return f"{drawn.stderr}{written.stderr}" if drawn.returncode or written.returncode else "the traces differ"


changing = []  # different lines of each trace
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    each = 10
    for number in range(seed, seed + max(1, networks // each)):
        if why := differs(folder, number, each):
            count = next(n for n in range(1, each + 1) if n == each or differs(folder, number, n))
            why = differs(folder, number, count)
            sys.exit(f"seed {number}, {count} networks: {why}\n{(folder / 'block.s7dcl').read_text()}\n{(folder / 'block.scl').read_text()}")
assert sum(changing) > 10 * len(changing), f"the traces show only {sum(changing)} different lines"
print(f"{networks} networks: the same bytes, {sum(changing) / len(changing):.0f} different lines a trace")
