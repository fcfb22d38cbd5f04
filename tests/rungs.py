#!/usr/bin/python3
"""Random networks of LAD, written as a SIMATIC SD document (`.s7dcl`), as SimaticML (`.xml`), and as SCL, in which each element is a
statement: the same bytes.

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


class Power(str):
    """What leads to an element, as text, and the end of a wire that it comes from in SimaticML."""
    end = "<Powerrail/>"

    def at(self, part, pin):
        made = Power(self)
        made.end = f'<NameCon UId="{part}" Name="{pin}"/>'
        return made


RAIL = Power("TRUE")


class Block:
    """A FUNCTION_BLOCK in all forms."""

    def __init__(self, draw):
        self.draw, self.rungs, self.statements, self.own, self.temporary, self.wires = draw, [], [], {}, 0, 0
        self.outside = []  # rungs that end at a wire
        self.nets, self.parts, self.lines, self.ids = [], [], {}, 0

    def part(self, name, power, pin="in", inside="", **operands):
        """A part of SimaticML; operands by their pins, of those that it writes as `_pin`."""
        self.ids += 1
        number = self.ids
        self.parts.append(f'<Part Name="{name}" UId="{number}" DisabledENO="true">{inside}</Part>')
        self.lines.setdefault(power.end, []).append(f'<NameCon UId="{number}" Name="{pin}"/>')
        for other, value in operands.items():
            if isinstance(value, Power):
                self.lines.setdefault(value.end, []).append(f'<NameCon UId="{number}" Name="{other}"/>')
                continue
            self.ids += 1
            scope, inner = (("LocalVariable", f'<Symbol><Component Name="{value[1:]}"/></Symbol>') if value[0] == "#" else
                            ("LiteralConstant", f"<Constant><ConstantType>Int</ConstantType><ConstantValue>{value}</ConstantValue></Constant>"))
            self.parts.insert(0, f'<Access Scope="{scope}" UId="{self.ids}">{inner}</Access>')
            ends = (f'<IdentCon UId="{self.ids}"/>', f'<NameCon UId="{number}" Name="{other.lstrip("_")}"/>')
            begin, end = ends[::-1] if other[0] == "_" else ends
            self.lines.setdefault(begin, []).append(end)
        return number

    def finish_net(self):
        lines = list(self.lines.items())
        self.draw.shuffle(lines)  # wires stand in any order
        wires = "".join(f'<Wire UId="{1000 + i}">{begin}{"".join(ends)}</Wire>' for i, (begin, ends) in enumerate(lines))
        self.nets.append(f"<FlgNet><Parts>{''.join(self.parts)}</Parts><Wires>{wires}</Wires></FlgNet>")
        self.parts, self.lines, self.ids = [], {}, 0

    def variable(self, kind):
        name = f"{kind[:2].lower()}{len(self.own)}"
        self.own[name] = kind
        return name

    def kept(self, value):
        """In the text all power is a variable, as it is there and then."""
        self.temporary += 1
        self.statements.append(f"#t{self.temporary} := {value};")
        return Power(f"#t{self.temporary}")

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
            part = self.part("Contact", power, inside='<Negated Name="operand"/>' if kind[0] == "I" else "", operand=f"#{name}")
            return [f"{kind}( #{name} )"], self.kept(f"{power} AND {'NOT ' if kind[0] == 'I' else ''}#{name}").at(part, "out")
        if kind == "compare":
            name, a, b = draw.choice(list(SIGNS)), self.number(), self.number()
            part = self.part(name.capitalize(), power, "pre", '<TemplateValue Name="SrcType" Type="Type">Int</TemplateValue>', in1=a, in2=b)
            return (['{ S7_Templates := "SrcType := Int" }', f"{name}_Contact( in1 := {a}, in2 := {b} )"],
                    self.kept(f"{power} AND ({a} {SIGNS[name]} {b})").at(part, "out"))
        if kind == "InRange":
            low, at, high = self.number(), self.number(), self.number()
            part = self.part("InRange", power, "pre", **{"min": low, "in": at, "max": high})
            return [f"InRange( min := {low}, in := {at}, max := {high} )"], self.kept(f"{power} AND {low} <= {at} AND {at} <= {high}").at(part, "out")
        if kind in ("P_Contact", "N_Contact"):
            name, bit = self.operand(), self.variable("Bool")
            edge = self.kept(f"#{name} AND NOT #{bit}" if kind[0] == "P" else f"NOT #{name} AND #{bit}")
            add(f"#{bit} := #{name};")
            part = self.part(kind.replace("_", ""), power, "pre", operand=f"#{name}", bit=f"#{bit}")
            return [f"{kind}(", f"  operand := #{name},", f"  bit := #{bit}", ")"], self.kept(f"{power} AND {edge}").at(part, "out")
        if kind == "P_Trig":
            bit = self.variable("Bool")
            edge = self.kept(f"{power} AND NOT #{bit}")
            add(f"#{bit} := {power};")
            return [f"P_Trig( #{bit} )"], edge.at(self.part("PBox", power, bit=f"#{bit}"), "out")
        if kind == "Not":
            return ["Not()"], self.kept(f"NOT {power}").at(self.part("Not", power), "out")
        if kind == "Coil":
            name = draw.choice(BITS)
            add(f"#{name} := {power};")
            return [f"Coil( #{name} )"], power.at(self.part("Coil", power, operand=f"#{name}"), "out")
        if kind == "P_Coil":
            name, bit = draw.choice(BITS), self.variable("Bool")
            add(f"#{name} := {power} AND NOT #{bit}; #{bit} := {power};")
            part = self.part("PCoil", power, operand=f"#{name}", bit=f"#{bit}")
            return [f"P_Coil( operand := #{name}, bit := #{bit} )"], power.at(part, "out")
        if kind in ("S_Coil", "R_Coil"):
            name = draw.choice(BITS)
            add(f"IF {power} THEN #{name} := {'TRUE' if kind[0] == 'S' else 'FALSE'}; END_IF;")
            return [f"{kind}( #{name} )"], power.at(self.part(kind.replace("_", ""), power, operand=f"#{name}"), "out")
        if kind in ("Move", "Add", "Inc", "Calculate"):
            a, b, target = self.number(), self.number(), f"#{draw.choice(NUMBERS)}"
            lines = {"Move": [f"Move( in := {a}, out1 => {target} )"],
                     "Add": [f"Add( in1 := {a}, in2 := {b}, out => {target} )"],
                     "Inc": [f"Inc( {target} )"],
                     "Calculate": ['{ S7_Templates := "SrcType := Int"; S7_Expression := "in1 - 2 * in2" }',
                                   f"Calculate( in1 := {a}, in2 := {b}, out => {target} )"]}[kind]
            value = {"Move": a, "Add": f"{a} + {b}", "Inc": f"{target} + 1", "Calculate": f"{a} - 2 * ({b})"}[kind]
            add(f"IF {power} THEN {target} := {value}; END_IF;")
            pins = {"Move": {"in": a, "_out1": target}, "Inc": {"operand": target}}.get(kind, {"in1": a, "in2": b, "_out": target})
            inside = '<TemplateValue Name="SrcType" Type="Type">Int</TemplateValue>' + ("<Equation>in1 - 2 * in2</Equation>" if kind == "Calculate" else "")
            return lines, power.at(self.part(kind.replace("Calculate", "Calc"), power, "en", inside, **pins), "eno")
        if kind in ("TON", "TOF"):
            timer, time = self.variable(kind + "_TIME"), draw.choice([10, 25, 40])
            add(f"#{timer}(IN := {power}, PT := T#{time}ms);")
            return ['{ S7_Templates := "time_type := Time" }', f"#{timer}.{kind}(", f"  pt := T#{time}ms,", "  et =>", ")"], self.kept(
                f"#{timer}.Q").at(self.part(kind, power, "IN", f'<Instance Scope="LocalVariable" UId="9999"><Component Name="{timer}"/></Instance>',
                                            PT=f"T#{time}ms"), "Q")
        if kind == "CTU":
            counter, reset, target = self.variable("CTU_INT"), self.operand(), draw.choice(NUMBERS)
            self.temporary += 1
            counted = self.temporary
            add(f"#{counter}.CTU(CU := {power}, R := #{reset}, PV := 2, Q => #t{self.temporary}, CV => #{target});")
            part = self.part("CTU", power, "CU", f'<Instance Scope="LocalVariable" UId="9999"><Component Name="{counter}"/></Instance>',
                             R=f"#{reset}", PV="2", _CV=f"#{target}")
            return [f"#{counter}.CTU( r := #{reset}, pv := 2, cv => #{target} )"], Power(f"#t{counted}").at(part, "Q")
        # A flip-flop, whose second input is a rung of its own, which is executed before it.
        name, wire, pin = draw.choice(BITS), self.wire(), kind[2].lower() + "1"
        pin = "s1" if kind == "S_RS" else "r1"
        lines, other = self.series(RAIL, draw.randint(1, 2))
        self.outside.append(["RUNG wire#powerrail"] + lines + [f"END_RUNG {wire}"])
        add(f"#{name} := {other} OR #{name} AND NOT {power};" if kind == "S_RS" else f"#{name} := ({power} OR #{name}) AND NOT {other};")
        part = self.part("Rs" if kind == "S_RS" else "Sr", power, "r" if kind == "S_RS" else "s", **{"operand": f"#{name}", pin: other})
        return [f"{kind}( operand := #{name}, {pin} := {wire} )"], self.kept(f"#{name}").at(part, "q")

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
        ends = [behind]
        for _ in range(self.draw.randint(1, 2)):
            lines, other = self.series(power, self.draw.randint(0, 2), depth)
            self.outside.append([f"RUNG {begin}"] + lines + [f"END_RUNG {end}"])
            behind = self.kept(f"{behind} OR {other}")
            ends.append(other)
        part = self.part("O", ends[0], "in1", f'<TemplateValue Name="Card" Type="Cardinality">{len(ends)}</TemplateValue>',
                         **{f"in{i + 1}": each for i, each in enumerate(ends) if i})
        return [begin] + first + [end], behind.at(part, "out")

    def network(self):
        self.outside, forks = [], []
        lines, power = self.series(RAIL, self.draw.randint(1, 5))
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
        self.finish_net()

    def declarations(self, temporary):
        variables = "".join(f"    {name} : {kind};\n" for name, kind in self.own.items())
        outputs = "".join(f"    {name} : {kind};\n" for names, kind in ((INPUTS + BITS, "Bool"), (NUMBERS, "Int")) for name in names)
        return (f"VAR_OUTPUT\n{outputs}END_VAR\nVAR\n    r : UDInt := 4711;\n{variables}END_VAR\n"
                + (f"VAR_TEMP\n{''.join(f'    t{n + 1} : Bool;{chr(10)}' for n in range(self.temporary))}END_VAR\n" if temporary else ""))

    def document(self, name):
        drawn = "".join(f'{{ S7_Language := "LAD" }}\nNETWORK\n{each}\nEND_NETWORK\n' for each in self.rungs)
        return (f'{{ S7_PreferredLanguage := "LAD" }}\nFUNCTION_BLOCK "{name}"\n{self.declarations(False)}'
                f'{{ S7_Language := "SCL" }}\nNETWORK\n{DRIVE}END_NETWORK\n{drawn}END_FUNCTION_BLOCK\n')

    def markup(self, name):
        """SimaticML. What drives it is SCL, by tokens of which some are whole lines."""
        def section(kind, members):
            return f'<Section Name="{kind}">' + "".join(f'<Member Name="{n}" Datatype="{k}">{v}</Member>' for n, k, v in members) + "</Section>"
        outputs = [(n, k, "") for names, k in ((INPUTS + BITS, "Bool"), (NUMBERS, "Int")) for n in names]
        kept = [("r", "UDInt", "<StartValue>4711</StartValue>")] + [(n, k, "") for n, k in self.own.items()]
        scl = "<StructuredText>" + "".join(f'<Token Text="{line.strip()}"/><NewLine/>' for line in DRIVE.splitlines()) + "</StructuredText>"
        units = "".join(f'<SW.Blocks.CompileUnit ID="{i}"><AttributeList><NetworkSource>{net}</NetworkSource></AttributeList></SW.Blocks.CompileUnit>'
                        for i, net in enumerate([scl] + self.nets))
        return (f'<?xml version="1.0" encoding="utf-8"?>\n<Document><Engineering version="V21"/><SW.Blocks.FB ID="0"><AttributeList><Interface><Sections>'
                f'{section("Output", outputs)}{section("Static", kept)}</Sections></Interface><Name>{name}</Name>'
                f'<ProgrammingLanguage>LAD</ProgrammingLanguage></AttributeList><ObjectList>{units}</ObjectList></SW.Blocks.FB></Document>\n')

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
    written, trace = run(folder, ".scl", block.text("Block"))
    changing.append(len({line.partition(b",")[2] for line in trace.splitlines()}))
    for form, text in ((".s7dcl", block.document("Block")), (".xml", block.markup("Block"))):
        drawn, other = run(folder, form, text)
        if drawn.returncode or written.returncode:
            return f"{drawn.stderr}{written.stderr}"
        if trace != other:
            return f"the trace of block{form} differs"
    return None


changing = []  # different lines of each trace
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    each = 10
    for number in range(seed, seed + max(1, networks // each)):
        if why := differs(folder, number, each):
            count = next(n for n in range(1, each + 1) if n == each or differs(folder, number, n))
            why = differs(folder, number, count)
            sys.exit(f"seed {number}, {count} networks: {why}\n{(folder / 'block.s7dcl').read_text()}\n{(folder / 'block.xml').read_text()}\n{(folder / 'block.scl').read_text()}")
assert sum(changing) > 10 * len(changing), f"the traces show only {sum(changing)} different lines"
print(f"{networks} networks: the same bytes, {sum(changing) / len(changing):.0f} different lines a trace")
