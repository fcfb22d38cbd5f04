#!/usr/bin/python3
"""Random networks of LD and FBD, and instruction lists, written as PLCopen XML and as Structured Text by rules of their own, and networks as
TwinCAT and Automation Studio keep them: both runs write the same bytes.

usage: drawings.py LINESHAFT [NETWORKS [SEED]]
"""

import pathlib
import random
import subprocess
import sys
import tempfile

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
networks = int(sys.argv[2]) if len(sys.argv) > 2 else 200
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1

BOOLS = [f"g{i}" for i in range(5)]  # globals that change from scan to scan
NUMBERS = [f"n{i}" for i in range(3)]
DRIVER = f"""VAR_GLOBAL {', '.join(BOOLS)} : BOOL; {', '.join(NUMBERS)} : INT; END_VAR
PROGRAM Driver
VAR r : UDINT := 12345; END_VAR
r := r * 1664525 + 1013904223;
{' '.join(f"{name} := ((r / {2 ** (8 + i)}) MOD 2) = 1;" for i, name in enumerate(BOOLS))}
{' '.join(f"{name} := UDINT_TO_INT((r / {2 ** (10 + 3 * i)}) MOD 7);" for i, name in enumerate(NUMBERS))}
END_PROGRAM
"""


# As OpenPLC and Beremiz write text: it is in the dialect of what they draw.
MATIEC = "CONFIGURATION c\n  RESOURCE r ON PLC\n  END_RESOURCE\nEND_CONFIGURATION\n"


class Network:
    """A PROGRAM in both forms: elements of a body, and statements."""

    def __init__(self, draw, name):
        self.draw, self.name = draw, name
        self.elements, self.statements, self.declared = [], [], []
        self.count = 0
        for i in range(3):
            self.declare(f"b{i}", "BOOL")
            self.declare(f"v{i}", "INT")

    def declare(self, name, kind):
        self.declared.append((name, kind))
        return name

    def own(self, kind):
        """A variable or an instance that only the text has."""
        self.count += 1
        name = f"t{self.count}"
        self.text_only = getattr(self, "text_only", []) + [(name, kind)]
        return name

    def instance(self, kind):
        self.count += 1
        return self.declare(f"i{self.count}", kind)

    def element(self, tag, inside, y=0, **attributes):
        number = len(self.elements) + 1
        more = "".join(f' {key}="{value}"' for key, value in attributes.items())
        self.elements.append(f'<{tag} localId="{number}"{more}><position x="{number}" y="{y}"/>{inside}</{tag}>')
        return number

    def xml(self, language):
        kinds = {"BOOL": "<BOOL/>", "INT": "<INT/>"}
        def variables(of):
            return "".join(f'<variable name="{n}"><type>{kinds.get(k) or f"""<derived name="{k}"/>"""}</type></variable>' for n, k in of)
        outside = variables([(n, "BOOL") for n in BOOLS] + [(n, "INT") for n in NUMBERS])
        elements = self.elements[:]
        if language == "LD":
            self.draw.shuffle(elements)
        return (f'<pou name="{self.name}" pouType="program"><interface><externalVars>{outside}</externalVars>'
                f'<localVars>{variables(self.declared)}</localVars></interface><body><{language}>'
                + "\n".join(elements) + f"</{language}></body></pou>\n")

    def text(self):
        own = "".join(f"{n} : {k}; " for n, k in self.declared + getattr(self, "text_only", []))
        return f"PROGRAM {self.name}\nVAR {own}END_VAR\n" + "\n".join(self.statements) + "\nEND_PROGRAM\n"


def lines(ids):
    return "".join(f'<connection refLocalId="{i}"' + (f' formalParameter="{pin}"' if pin else "") + "/>" for i, pin in ids)


def point(ids):
    return f"<connectionPointIn>{lines(ids)}</connectionPointIn>"


def pin(name, ids, **attributes):
    more = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f'<variable formalParameter="{name}"{more}>{point(ids)}</variable>'


def outputs(*names):
    return "<outputVariables>" + "".join(f'<variable formalParameter="{n}"><connectionPointOut/></variable>' for n in names) + "</outputVariables>"


# ---- ladder: a tree of contacts in series and parallel, coils at its end

def tree(draw, depth):
    kind = draw.random()
    if depth == 0 or kind < 0.35:
        return ("contact", draw.choice(BOOLS + ["b0", "b1", "b2"]), draw.choice(["", "", "", "negated", "rising", "falling"]))
    if kind < 0.45:
        return ("timer", draw.choice(["TON", "TOF", "TP"]), draw.choice([10, 25, 40]))
    if kind < 0.52:
        return ("compare", draw.choice(["GT", "LE", "EQ", "NE"]), draw.choice(NUMBERS), draw.choice(NUMBERS + ["3"]))
    return (draw.choice(["series", "parallel"]), [tree(draw, depth - 1) for _ in range(draw.randint(2, 3))])


def drawn(net, part, before, y):
    """The elements behind `before`, as XML."""
    kind = part[0]
    if kind == "contact":
        more = {"negated": {"negated": "true"}, "rising": {"edge": "rising"}, "falling": {"edge": "falling"}}.get(part[2], {})
        return [(net.element("contact", point(before) + f"<variable>{part[1]}</variable>", y, **more), "")]
    if kind == "timer":
        time = net.element("inVariable", f"<expression>T#{part[2]}ms</expression>", y)
        number = net.element("block", "<inputVariables>" + pin("IN", before) + pin("PT", [(time, "")]) + "</inputVariables>" + outputs("Q", "ET"),
                             y, typeName=part[1], instanceName=part[3])
        return [(number, "Q")]
    if kind == "compare":
        sides = [net.element("inVariable", f"<expression>{name}</expression>", y) for name in part[2:4]]
        number = net.element("block", "<inputVariables>" + pin("EN", before) + pin("IN1", [(sides[0], "")]) + pin("IN2", [(sides[1], "")])
                             + "</inputVariables>" + outputs("OUT"), y, typeName=part[1])
        return [(number, "OUT")]
    if kind == "series":
        for each in part[1]:
            before = drawn(net, each, before, y)
        return before
    return [end for each in part[1] for end in drawn(net, each, before, y)]


SIGNS = {"GT": ">", "LE": "<=", "EQ": "=", "NE": "<>", "GE": ">=", "LT": "<"}


def said(net, part, before):
    """What comes behind `before`, as an expression; edges and timers are statements."""
    kind = part[0]
    if kind == "contact":
        value = part[1]
        if part[2] in ("rising", "falling"):
            trigger = net.own("R_TRIG" if part[2] == "rising" else "F_TRIG")
            net.statements.append(f"{trigger}(CLK := {value});")
            value = f"{trigger}.Q"
        return f"({before} AND {'NOT ' if part[2] == 'negated' else ''}{value})"
    if kind == "timer":
        net.statements.append(f"{part[3]}(IN := {before}, PT := T#{part[2]}ms);")
        return f"{part[3]}.Q"
    if kind == "compare":
        return f"({before} AND ({part[2]} {SIGNS[part[1]]} {part[3]}))"
    if kind == "series":
        for each in part[1]:
            before = said(net, each, before)
        return before
    return "(" + " OR ".join(said(net, each, before) for each in part[1]) + ")"


def with_instances(net, part):
    if part[0] == "timer":
        return part + (net.instance(part[1]),)
    if part[0] in ("series", "parallel"):
        return (part[0], [with_instances(net, each) for each in part[1]])
    return part


def ladder(draw, name):
    net = Network(draw, name)
    rail = net.element("leftPowerRail", "")
    rungs = []
    for number in range(draw.randint(1, 4)):
        part = with_instances(net, tree(draw, draw.randint(0, 3)))
        coils = [(draw.choice(["b0", "b1", "b2"]), draw.choice(["", "", "negated", "set", "reset", "rising", "falling"]))
                 for _ in range(draw.randint(1, 3))]
        rungs.append((100 * number, part, coils, draw.random() < 0.3))
    for y, part, coils, in_series in rungs:
        value = net.own("BOOL")
        net.statements.append(f"{value} := {said(net, part, 'TRUE')};")
        for target, kind in coils:
            if kind in ("rising", "falling"):
                trigger = net.own("R_TRIG" if kind == "rising" else "F_TRIG")
                net.statements.append(f"{trigger}(CLK := {value}); {target} := {trigger}.Q;")
            elif kind in ("set", "reset"):
                net.statements.append(f"IF {value} THEN {target} := {'TRUE' if kind == 'set' else 'FALSE'}; END_IF")
            else:
                net.statements.append(f"{target} := {'NOT ' if kind else ''}{value};")
    for y, part, coils, in_series in draw.sample(rungs, len(rungs)):
        ends = drawn(net, part, [(rail, "")], y)
        for place, (target, kind) in enumerate(coils):
            more = {"negated": {"negated": "true"}, "": {}}.get(kind) if kind in ("negated", "") else (
                {"storage": kind} if kind in ("set", "reset") else {"edge": kind})
            number = net.element("coil", point(ends) + f"<variable>{target}</variable>", y + place, **more)
            if in_series:
                ends = [(number, "")]
    return net


# ---- function block diagrams: elements in an order of their own, each into a variable in the text

FUNCTIONS = {  # name: types of the inputs, type of the result, the text
    "ADD": (["INT", "INT"], "INT", "{0} + {1}"), "SUB": (["INT", "INT"], "INT", "{0} - {1}"),
    "MUL": (["INT", "INT"], "INT", "{0} * {1}"), "MAX": (["INT", "INT", "INT"], "INT", "MAX({0}, {1}, {2})"),
    "LIMIT": (["INT", "INT", "INT"], "INT", "LIMIT({0}, {1}, {2})"), "SEL": (["BOOL", "INT", "INT"], "INT", "SEL({0}, {1}, {2})"),
    "AND": (["BOOL", "BOOL", "BOOL"], "BOOL", "{0} AND {1} AND {2}"), "OR": (["BOOL", "BOOL"], "BOOL", "{0} OR {1}"),
    "XOR": (["BOOL", "BOOL"], "BOOL", "{0} XOR {1}"), "NOT": (["BOOL"], "BOOL", "NOT {0}"),
    "GT": (["INT", "INT"], "BOOL", "{0} > {1}"), "EQ": (["INT", "INT"], "BOOL", "{0} = {1}"),
    "MOVE": (["INT"], "INT", "{0}")}
BLOCKS = {  # name: inputs, outputs
    "TON": ([("IN", "BOOL"), ("PT", "TIME")], [("Q", "BOOL")]), "TP": ([("IN", "BOOL"), ("PT", "TIME")], [("Q", "BOOL")]),
    "CTU": ([("CU", "BOOL"), ("R", "BOOL"), ("PV", "INT")], [("Q", "BOOL"), ("CV", "INT")]),
    "SR": ([("S1", "BOOL"), ("R", "BOOL")], [("Q1", "BOOL")]), "R_TRIG": ([("CLK", "BOOL")], [("Q", "BOOL")])}


def diagram(draw, name):
    """Boxes and variables, of which some have an executionOrderId, as in Beremiz. A box with one takes what comes from a later box as it was in the
    last scan; for all else that box is evaluated first."""
    net = Network(draw, name)
    kinds = [draw.choice(list(FUNCTIONS) * 2 + list(BLOCKS) * 3 + ["out"] * 12) for _ in range(draw.randint(2, 9))] + ["out"]
    plan = []
    for kind, number in zip(kinds, draw.sample(range(1, 40), len(kinds))):
        entry = {"kind": kind, "order": number if draw.random() < 0.65 else 0, "outputs": {}}
        if kind in FUNCTIONS:
            entry["outputs"]["OUT"] = (FUNCTIONS[kind][1], net.own(FUNCTIONS[kind][1]))
            if draw.random() < 0.25:
                entry["outputs"]["ENO"] = ("BOOL", net.own("BOOL"))
        elif kind in BLOCKS:
            entry["instance"] = net.instance(kind)
            entry["outputs"] = {pin: (of, f"{entry['instance']}.{pin}") for pin, of in BLOCKS[kind][1]}
        plan.append(entry)
    rest = []  # variables that boxes take

    def line(of, negatable=True, is_typed=False):
        """Where it comes from, its attributes, and the same as text; `is_typed`: from a variable, which says the type."""
        found = [(i, pin, text) for i, entry in enumerate(plan) for pin, (kind, text) in entry["outputs"].items() if kind == of]
        source, trigger = None, None
        if found and not is_typed and draw.random() < 0.7:
            source, pin_name, text = draw.choice(found)
            ends = [(source + 1, pin_name)]
        else:
            text = {"BOOL": lambda: draw.choice(BOOLS + ["b0", "b1", "b2"]), "TIME": lambda: "T#30ms",
                    "INT": lambda: draw.choice(NUMBERS + ["v0", "v1", "v2"] + (["2"] if negatable and not is_typed else []))}[of]()
            ends = [(100 + len(rest), "")]
            rest.append(f'<inVariable localId="{100 + len(rest)}"><position x="0" y="0"/><expression>{text}</expression></inVariable>')
        more = {}
        if of == "BOOL" and draw.random() < 0.2:
            more, text = {"negated": "true"}, f"NOT {text}"
        if of == "BOOL" and negatable and draw.random() < 0.1:
            more["edge"], trigger = "rising", net.own("R_TRIG")
        return {"ends": ends, "more": more, "source": source, "text": text, "trigger": trigger}

    for entry in plan:
        kind, order = entry["kind"], {"executionOrderId": entry["order"]} if entry["order"] else {}
        if kind == "out":
            of = draw.choice(["BOOL", "INT"])
            entry["target"] = draw.choice(["b0", "b1", "b2"] if of == "BOOL" else ["v0", "v1", "v2"])
            taken = line(of)
            entry["pins"] = [("", taken)]
            net.element("outVariable", point(taken["ends"]) + f"<expression>{entry['target']}</expression>", 0, **order, **taken["more"])
            continue
        if kind in FUNCTIONS:
            types = FUNCTIONS[kind][0]
            entry["pins"] = [("EN", line("BOOL", False))] if "ENO" in entry["outputs"] else []
            entry["pins"] += [(f"IN{i + 1}", line(of, True, of == "INT" and i == len(types) - 1)) for i, of in enumerate(types)]
        else:
            entry["pins"] = [(pin_name, line(of)) for pin_name, of in BLOCKS[kind][0]]
            order["instanceName"] = entry["instance"]
        pins = "".join(pin(pin_name, taken["ends"], **taken["more"]) for pin_name, taken in entry["pins"])
        net.element("block", f"<inputVariables>{pins}</inputVariables>" + outputs(*reversed(entry["outputs"])), 0, typeName=kind, **order)
    in_file = list(range(len(plan)))
    draw.shuffle(in_file)
    net.elements = [net.elements[i] for i in in_file] + rest
    evaluated = set()

    def value(taker, taken):
        source = taken["source"]
        if source is not None and not (taker["kind"] != "out" and taker["order"]):
            evaluate(source)
        if not taken["trigger"]:
            return taken["text"]
        net.statements.append(f"{taken['trigger']}(CLK := {taken['text']});")
        return f"{taken['trigger']}.Q"

    def evaluate(i):
        if i in evaluated:
            return
        evaluated.add(i)
        entry = plan[i]
        kind = entry["kind"]
        texts = [value(entry, taken) for _, taken in entry["pins"]]
        if kind in BLOCKS:
            inside = ", ".join(f"{pin_name} := {text}" for (pin_name, _), text in zip(entry["pins"], texts))
            net.statements.append(f"{entry['instance']}({inside});")
            return
        if kind == "out":
            source = entry["pins"][0][1]["source"]
            enabled = plan[source]["outputs"].get("ENO") if source is not None else None
            statement = f"{entry['target']} := {texts[0]};"
            net.statements.append(f"IF {enabled[1]} THEN {statement} END_IF" if enabled else statement)
            return
        (of, target), enabled = entry["outputs"]["OUT"], entry["outputs"].get("ENO")
        statement = f"{target} := {FUNCTIONS[kind][2].format(*(f'({text})' for text in (texts[1:] if enabled else texts)))};"
        net.statements.append(f"{enabled[1]} := {texts[0]}; IF {enabled[1]} THEN {statement} ELSE {target} := {'FALSE' if of == 'BOOL' else '0'}; END_IF"
                              if enabled else statement)

    for i in sorted(in_file, key=lambda i: (not plan[i]["order"], plan[i]["order"] or (plan[i]["kind"] != "out"))):
        evaluate(i)
    return net


# ---- instruction lists: the text has the current result in a variable

def instructions(draw, name):
    net = Network(draw, name)
    result, inner = net.own("BOOL"), net.own("BOOL")
    number = net.own("INT")
    labels = 0

    def operand():
        return draw.choice(BOOLS + ["b0", "b1", "b2"])

    def put(line, *statements):
        net.elements.append(line + draw.choice(["", "", " (* why *)"]))
        return list(statements)

    def operate(target):
        """One operator on the result in `target`."""
        op, no = draw.choice(["AND", "OR", "XOR"]), draw.random() < 0.3
        if target == result and draw.random() < 0.25:
            first = operand()
            made = put(f"{op}{'N' if no else ''}( {first}", f"{inner} := {first};")
            for _ in range(draw.randint(0, 2)):
                made += operate(inner)
            return made + put(")", f"{result} := {result} {op} {'NOT ' if no else ''}{inner};")
        other = operand()
        return put(f"{op}{'N' if no else ''} {other}", f"{target} := {target} {op} {'NOT ' if no else ''}{other};")

    def load():
        if draw.random() < 0.3:
            a, b, op = draw.choice(NUMBERS + ["v0"]), draw.choice(NUMBERS + ["3"]), draw.choice(list(SIGNS))
            plus = draw.choice(NUMBERS + ["v1", "2"])
            return (put(f"LD {a}", f"{number} := {a};") + put(f"ADD {plus}", f"{number} := {number} + {plus};")
                    + (put("ST v0", f"v0 := {number};") if draw.random() < 0.3 else [])
                    + put(f"{op} {b}", f"{result} := {number} {SIGNS[op]} {b};"))
        first, no = operand(), draw.random() < 0.3
        return put(f"LD{'N' if no else ''} {first}", f"{result} := {'NOT ' if no else ''}{first};")

    def store():
        target, kind = draw.choice(["b0", "b1", "b2"]), draw.choice(["ST", "ST", "STN", "S", "R"])
        if kind in "SR":
            return put(f"{kind} {target}", f"IF {result} THEN {target} := {'TRUE' if kind == 'S' else 'FALSE'}; END_IF")
        return put(f"{kind} {target}", f"{target} := {'NOT ' if kind == 'STN' else ''}{result};")

    def segment(depth):
        nonlocal labels
        made = load()
        for _ in range(draw.randint(0, 3)):
            made += operate(result)
        if draw.random() < 0.2:
            timer = net.instance("TON")
            source = operand()
            made += put(f"CAL {timer}(IN := {source}, PT := T#25ms)", f"{timer}(IN := {source}, PT := T#25ms);")
        if depth > 0 and draw.random() < 0.4:
            labels += 1
            label, no = f"l{labels}", draw.random() < 0.3
            made += put(f"JMPC{'N' if no else ''} {label}")
            inside = segment(depth - 1)
            made += [f"IF {'' if no else 'NOT '}{result} THEN", *inside, "END_IF"]
            made += put(f"{label}:" + draw.choice(["", " NOT"]))
            if net.elements[-1].split(" (*")[0].endswith("NOT"):
                made.append(f"{result} := NOT {result};")
            return made + store()
        made += store()
        return made + (store() if draw.random() < 0.4 else [])

    for _ in range(draw.randint(1, 4)):
        net.statements += segment(2)
    return net


# ---- networks of TwinCAT: trees, in files of their own

NEGATED, SET, RESET, JUMP, RISING, FALLING = 1, 2, 3, 4, 16, 32  # Flags
FLAGS = "Flags"


def value(name, text):
    return f'<v n="{name}">{text}</v>'


def operand(text, marks=0, name="", kind="Operand", of=""):
    named = f' n="{name}"' if name else ""
    return (f'<o{named} t="{kind}">' + (value("Operand", f'"{text}"') if text else '<n n="Operand" />') + value("Type", f'"{of}"')
            + f'<o n="Flags" t="Flags">{value("Flags", marks)}</o></o>')


def strings(name, texts):
    return f'<l2 n="{name}" cet="String">' + "".join(f"<v>{each}</v>" for each in texts) + "</l2>"


def box(kind, call, inputs, names, outs, takers, instance="", marks=(), has_en=False, has_eno=False):
    """`inputs` are trees; `outs` names and types; `takers` operands, `<n />` where the tree goes on."""
    flags = (f'<l2 n="InputFlags" cet="Flags">{"".join(f"<o>{value(FLAGS, m)}</o>" for m in marks)}</l2>' if any(marks)
             else '<n n="InputFlags" />')
    return (f'<o t="BoxTreeBox">{value("BoxType", chr(34) + kind + chr(34))}{operand(instance, name="Instance")}'
            f'<o n="OutputItems" t="OutputItemList"><l2 n="OutputItems">{"".join(takers)}</l2></o>'
            f'<o n="Flags" t="Flags">{value("Flags", 0)}</o>{flags}<l2 n="InputItems">{"".join(inputs)}</l2>'
            f'<o n="InputParam" t="ParamList">{strings("Names", names)}{strings("Types", ["BOOL" for _ in names])}</o>'
            f'<o n="OutputParam" t="ParamList">{strings("Names", [n for n, _ in outs])}{strings("Types", [k for _, k in outs])}</o>'
            f'<v n="CallType" t="Operator">{call}</v>{value("EN", str(has_en).lower())}{value("ENO", str(has_eno).lower())}'
            f'<n n="STSnippet" />{value("ProvidesSTSnippet", "false")}</o>')


def inside(tree, name):
    """A tree as a member of another."""
    return tree.replace("<o ", f'<o n="{name}" ', 1) if tree else f'<n n="{name}" />'


class Trees(Network):
    """A PROGRAM whose networks are trees."""

    def __init__(self, draw, name):
        super().__init__(draw, name)
        self.networks, self.wires = [], []

    def leaf(self, text, marks=0, of="BOOL"):
        return f'<o t="BoxTreeOperand">{inside(operand(text, marks, of=of), "Operand")}</o>'

    def edge(self, text, marks):
        if marks & (RISING | FALLING):
            trigger = self.own("R_TRIG" if marks & RISING else "F_TRIG")
            self.statements.append(f"{trigger}(CLK := {text});")
            text = f"{trigger}.Q"
        return f"(NOT {text})" if marks & NEGATED else text

    def contact(self, may_have_edge=True):
        name = self.draw.choice(BOOLS + ["b0", "b1", "b2"])
        marks = self.draw.choice([0, 0, 0, NEGATED] + ([RISING, FALLING] if may_have_edge else []))
        return self.leaf(name, marks), self.edge(name, marks)

    def kept(self, text):
        name = self.own("BOOL")
        self.statements.append(f"{name} := {text};")
        return name

    def boolean(self, depth):
        """A tree of a BOOL, and its text."""
        kind = self.draw.random()
        if self.wires and kind < 0.15:
            number, text = self.draw.choice(self.wires)
            return f'<o t="BoxTreeDemux">{value("VarId", number)}<n n="Input" /></o>', text
        if kind < 0.18:
            return '<o t="BoxTreeTerminator"><n n="Input" /></o>', "TRUE"
        if depth == 0 or kind < 0.4:
            return self.contact()
        if kind < 0.6:
            return self.operator(depth)
        if kind < 0.7:
            return self.compare(depth)
        if kind < 0.8:
            return self.parallel()
        if kind < 0.9:
            return self.sum(depth, True)
        return self.block(depth, True)

    def operator(self, depth):
        name = self.draw.choice(["AND", "OR", "XOR", "NOT"])
        parts, marks, texts = [], [], []
        for _ in range(1 if name == "NOT" else self.draw.randint(2, 3)):
            tree, text = self.boolean(depth - 1)
            mark = self.draw.choice([0, 0, 0, NEGATED, RISING])
            parts.append(tree)
            marks.append(mark)
            texts.append(self.edge(text, mark))
        text = f"(NOT {texts[0]})" if name == "NOT" else f"({f' {name} '.join(texts)})"
        return box(name, name.capitalize(), parts, [], [("", "BOOL")], ["<n />"], marks=marks), text

    def compare(self, depth):
        name, a, b = self.draw.choice(list(SIGNS)), self.draw.choice(NUMBERS), self.draw.choice(NUMBERS + ["3"])
        has_en = self.draw.random() < 0.5
        parts, text = [], f"({a} {SIGNS[name]} {b})"
        if has_en:
            tree, enabled = self.boolean(depth - 1)
            parts, text = [tree], f"({enabled} AND {text})"
        return box(name, name.capitalize(), parts + [self.leaf(a, of="INT"), self.leaf(b, of="INT")], ["EN"] if has_en else [],
                   [("", "BOOL")], ["<n />"], has_en=has_en), text

    def branch_of_box(self, left):
        """A box with EN, to which a contact leads, or the branch itself."""
        contact, text = self.contact(False)
        if self.draw.random() < 0.3:
            contact, text = '<o t="BoxTreeTerminator"><n n="Input" /></o>', "TRUE"
        target, a, b = self.draw.choice(["v0", "v1", "v2"]), self.draw.choice(NUMBERS), self.draw.choice(NUMBERS + ["v0", "2"])
        enabled = self.kept(f"({left} AND {text})")
        self.statements.append(f"IF {enabled} THEN {target} := {a} + {b}; END_IF")
        return box("ADD", "Add", [contact, self.leaf(a, of="INT"), self.leaf(b, of="INT")], ["EN"], [("ENO", "BOOL"), ("", "INT")],
                   ["<n />", operand(target, of="INT")], has_en=True, has_eno=True), enabled

    def parallel_of_boxes(self):
        before, left = self.contact() if self.draw.random() < 0.7 else ("", "TRUE")
        plain = [self.contact(False) for _ in range(self.draw.randint(0, 2))]
        is_short = self.draw.random() < 0.5
        left = self.kept(left)
        either = " OR ".join(text for _, text in plain) or "FALSE"
        if is_short:
            due, found = self.kept(f"({left} AND NOT ({either}))"), self.kept("FALSE")
            self.statements.append(f"IF {due} THEN")
        boxes = [self.branch_of_box("TRUE" if is_short else left) for _ in range(self.draw.randint(1, 2))]
        text = " OR ".join(enabled for _, enabled in boxes)
        if is_short:
            self.statements += [f"{found} := {text};", "END_IF"]
            text = found
        trees = [tree for tree, _ in plain + boxes]
        mode = value("Mode", "BoxShortCircuit" if is_short else "Sequential")
        return (f'<o t="BoxTreeParallel">{inside(before, "Input")}<l2 n="Trees">{"".join(trees)}</l2>{mode}</o>',
                f"(({left} AND ({either})) OR {text})")

    def parallel(self):
        if self.draw.random() < 0.4:
            return self.parallel_of_boxes()
        branches = [self.contact(False) for _ in range(self.draw.randint(2, 3))]
        text = f"({' OR '.join(text for _, text in branches)})"
        before = ""
        if self.draw.random() < 0.5:
            before, text_before = self.contact()
            text = f"({text_before} AND {text})"
        trees = "".join(tree for tree, _ in branches)
        return f'<o t="BoxTreeParallel">{inside(before, "Input")}<l2 n="Trees">{trees}</l2>{value("Mode", "Sequential")}</o>', text

    def sum(self, depth, is_taken):
        """What is behind it takes ENO."""
        name, sign = self.draw.choice([("ADD", "+"), ("SUB", "-")])
        a, b = self.draw.choice(NUMBERS), self.draw.choice(NUMBERS + ["v0", "v1", "2"])
        target = self.draw.choice(["v0", "v1", "v2"])
        has_en = is_taken or self.draw.random() < 0.5
        parts, enabled = [], "TRUE"
        if has_en:
            tree, text = self.boolean(depth - 1)
            parts, enabled = [tree], self.kept(text)
        self.statements.append(f"IF {enabled} THEN {target} := {a} {sign} {b}; END_IF")
        takers = ["<n />"] * has_en + [operand(target, of="INT")]
        return box(name, name.capitalize(), parts + [self.leaf(a, of="INT"), self.leaf(b, of="INT")], ["EN"] * has_en,
                   [("ENO", "BOOL")] * has_en + [("", "INT")], takers, has_en=has_en, has_eno=has_en), enabled

    def block(self, depth, is_taken):
        name = self.draw.choice(["TON", "TP", "CTU"])
        instance = self.instance(name)
        has_en = self.draw.random() < 0.4
        parts, names, enabled = [], [], "TRUE"
        if has_en:
            tree, text = self.boolean(depth - 1)
            parts, names, enabled = [tree], ["EN"], self.kept(text)
        tree, text = self.boolean(depth - 1)
        given = [(BLOCKS[name][0][0][0], tree, text)]
        if name == "CTU":
            tree, text = self.boolean(depth - 1)
            given += [("RESET", tree, text), ("PV", self.leaf("3", of="INT"), "3")]
        else:
            given += [("PT", self.leaf("T#30ms", of="TIME"), "T#30ms")]
        self.statements.append(f"IF {enabled} THEN {instance}({', '.join(f'{n} := {text}' for n, _, text in given)}); END_IF")
        takers, outs, taken = ["<n />"], [("Q", "BOOL")], f"{instance}.Q"
        if name == "CTU" and not is_taken:
            target = self.draw.choice(["v0", "v1", "v2"])
            takers.append(operand(target, of="INT"))
            outs.append(("CV", "INT"))
            self.statements.append(f"IF {enabled} THEN {target} := {instance}.CV; END_IF")
        if has_en:
            takers, outs = [operand("e") if is_taken else "<n />"] + takers, [("ENO", "BOOL")] + outs
            if is_taken:
                self.statements.append(f"e := {enabled};")
        return box(name, "FunctionBlock", parts + [tree for _, tree, _ in given], names + [n for n, _, _ in given], outs, takers, instance,
                   has_en=has_en, has_eno=has_en), taken

    def assign(self, tree, targets):
        return (f'<o t="BoxTreeAssign"><o n="OutputItems" t="OutputItemList"><l2 n="OutputItems" cet="Operand">{"".join(targets)}</l2></o>'
                f'<o n="Flags" t="Flags">{value("Flags", 0)}</o>{inside(tree, "RValue")}</o>')

    def coils(self):
        tree, text = self.boolean(self.draw.randint(0, 3))
        text = self.kept(text)
        targets = []
        for _ in range(self.draw.choice([1, 1, 1, 2, 3])):
            name, marks = self.draw.choice(["b0", "b1", "b2"]), self.draw.choice([0, 0, NEGATED, SET, RESET, RISING, FALLING])
            targets.append(operand(name, marks, of="BOOL"))
            if marks in (SET, RESET):
                self.statements.append(f"IF {text} THEN {name} := {'TRUE' if marks == SET else 'FALSE'}; END_IF")
            else:
                self.statements.append(f"{name} := {self.edge(text, marks)};")
        return self.assign(tree, targets)

    def wire(self):
        tree, text = self.boolean(2)
        number = len(self.wires) + 1
        self.wires.append((number, self.kept(text)))
        return f'<o t="BoxTreeDemux">{value("VarId", number)}{inside(tree, "Input")}</o>'

    def network(self, number, jumps):
        """Its label is that of its number; at its end it may jump to one behind it."""
        self.wires = []
        trees = [self.draw.choice([self.coils, self.coils, self.wire, lambda: self.sum(2, False)[0], lambda: self.block(2, False)[0]])()
                 for _ in range(self.draw.randint(1, 3))]
        if self.draw.random() < 0.25:
            tree, text = self.boolean(1)
            name = self.own("BOOL")
            self.statements.append(f"{name} := {text};")
            jumps.append((name, number + self.draw.randint(1, 3)))
            trees.append(self.assign(tree, [operand(f"n{jumps[-1][1]}", JUMP)]))
        self.networks.append(f'<o>{value("ILActive", "false")}{value("Label", f"{chr(34)}n{number}{chr(34)}")}{value("OutCommented", "false")}'
                             f'<l2 n="NetworkItems">{"".join(trees)}</l2></o>')

    def xml(self, language):
        own = "".join(f"{n} : {k}; " for n, k in self.declared)
        return (f'<?xml version="1.0" encoding="utf-8"?>\n<TcPlcObject Version="1.1.0.1"><POU Name="{self.name}"><Declaration><![CDATA[PROGRAM {self.name}\n'
                f'VAR {own}END_VAR\n]]></Declaration><Implementation><NWL><XmlArchive><Data><o t="NWLImplementationObject">'
                f'<l2 n="NetworkList" cet="Network">' + "\n".join(self.networks)
                + "</l2></o></Data></XmlArchive></NWL></Implementation></POU></TcPlcObject>\n")


def trees(draw, name):
    net = Trees(draw, name)
    net.declare("e", "BOOL")
    count, jumps, whole = draw.randint(1, 5), [], []
    for number in range(count + 3):  # the last three do nothing but be jumped to
        net.statements = []
        leading = [name for name, to in jumps if to > number]
        if number < count:
            net.network(number, jumps)
        else:
            net.networks.append(f'<o>{value("Label", f"{chr(34)}n{number}{chr(34)}")}{value("OutCommented", "false")}<l2 n="NetworkItems" /></o>')
        body = " ".join(net.statements)
        whole.append(f"IF NOT ({' OR '.join(leading)}) THEN {body} END_IF" if leading and body else body)
    net.statements = [f"{name} := FALSE;" for name, _ in jumps] + whole
    return net


# ---- ladders of B&R: rows of cells, in a folder each

EMPTY, LINE = "<empty/>", "<line/>"


def joined(cell):
    """Its right end goes up to the row above."""
    return cell if 'or="true"' in cell else cell.replace("/>", ' or="true"/>', 1) if cell.endswith("/>") and ">" not in cell[:-2] else cell.replace(
        ">", ' or="true">', 1)


def widened(rows, height, width):
    rows = [row + [LINE if i == 0 else EMPTY] * (width - wide(row)) for i, row in enumerate(rows)]
    return rows + [[EMPTY] * width for _ in range(height - len(rows))]


def wide(row):
    return sum(2 if cell.startswith("<function") else 1 for cell in row)


def function(kind, position, input_name="", output_name="", eno=False):
    mark = ' ENO="true"' if eno else ""
    return (f'<function position="{position}" type="{kind}">' + (f'<input name="{input_name}"{mark}/>')
            + (f'<output name="{output_name}"{mark}/>' if output_name else "") + "</function>")


class Cells(Network):
    """A PROGRAM whose networks are rows of cells: contacts, lines and boxes in series and in parallel, with coils behind them."""

    def __init__(self, draw, name):
        super().__init__(draw, name)
        self.networks = []

    def contact(self):
        name, kind = self.draw.choice(BOOLS + ["b0", "b1", "b2"]), self.draw.choice(["open", "open", "closed", "positive transition", "negative transition"])
        if kind.endswith("transition"):
            before, now = self.own("BOOL"), self.own("BOOL")
            self.statements.append(f"{now} := {f'{name} AND NOT {before}' if kind[0] == 'p' else f'{before} AND NOT {name}'}; {before} := {name};")
            text = now
        else:
            text = f"(NOT {name})" if kind == "closed" else name
        return [[f'<contact type="{kind}" name="{name}"/>']], text

    def sum(self):
        """A box with EN, whose ENO leads on; it is written when what leads to it is known."""
        target, a, b = self.draw.choice(["v0", "v1", "v2"]), self.draw.choice(NUMBERS), self.draw.choice(NUMBERS + ["3"])
        rows = [[LINE, function("ADD", "top", "EN", "ENO", True), LINE],
                [f'<analog type="input" name="{a}"/>', function("ADD", "middle", "", "4"), f'<analog type="output" name="{target}"/>'],
                [f'<analog type="input" name="{b}"/>', function("ADD", "bottom"), EMPTY]]
        return rows, ("sum", f"{target} := {a} + {b};")

    def compare(self):
        """It begins at the rail."""
        name, a, b = self.draw.choice(list(SIGNS)), self.draw.choice(NUMBERS), self.draw.choice(NUMBERS + ["3"])
        return [[f'<analog type="input" name="{a}"/>', function(name, "top", "IN1", "1")],
                [f'<analog type="input" name="{b}"/>', function(name, "bottom", "IN2")]], f"({a} {SIGNS[name]} {b})"

    def series(self, left, right):
        (a, text_a), (b, text_b) = left, right
        height, width = max(len(a), len(b)), wide(a[0])
        a = widened(a, height, width)
        for row in range(1, len(b)):
            a[row][-1] = joined(a[row][-1])
        return [x + y for x, y in zip(a, widened(b, height, wide(b[0])))], ("and", text_a, text_b)

    def parallel(self, above, below):
        (a, text_a), (b, text_b) = above, below
        width = max(wide(a[0]), wide(b[0]))
        rows = widened(a, len(a), width) + widened(b, len(b), width)
        for row in range(1, len(a) + 1):
            rows[row][-1] = joined(rows[row][-1])
        return rows, ("or", text_a, text_b)

    def part(self, depth, is_first):
        kind = self.draw.random()
        if is_first and kind < 0.15:
            return self.compare()
        if kind < 0.25 and depth < 2:
            return self.sum()
        if depth == 0 or kind < 0.45:
            return self.contact()
        make = self.draw.choice([self.series, self.parallel])
        first = self.part(depth - 1, is_first)
        return make(first, self.part(depth - 1, is_first and make == self.parallel))

    def value(self, text, left):
        """What comes out of a part that `left` leads to; boxes do their work, from left to right."""
        if isinstance(text, str):
            return f"({left} AND {text})"
        if text[0] == "sum":
            self.sums.append(f"IF {left} THEN {text[1]} END_IF")
            return left
        if text[0] == "and":
            return self.value(text[2], self.value(text[1], left))
        return f"({self.value(text[1], left)} OR {self.value(text[2], left)})"

    def network(self):
        rows, text = self.part(2, True)
        self.sums = []
        value = self.own("BOOL")
        power = self.value(text, "TRUE")
        if len(self.sums) > 1:
            return self.network()  # which of them comes first is a matter of columns
        self.statements += [f"{value} := {power};"] + self.sums
        coils = self.draw.randint(1, 3)
        rows = widened(rows, max(len(rows), coils), wide(rows[0]))
        for row in range(len(rows)):
            if row >= coils:
                rows[row].append(EMPTY)
                continue
            if row > 0:
                rows[row][-1] = joined(rows[row][-1])
            name, kind = self.draw.choice(["b0", "b1", "b2"]), self.draw.choice(["open", "open", "negated", "set", "reset"])
            rows[row].append(f'<coil type="{kind}" name="{name}"/>')
            self.statements.append(f"IF {value} THEN {name} := {'TRUE' if kind == 'set' else 'FALSE'}; END_IF" if kind in ("set", "reset")
                                   else f"{name} := {'NOT ' if kind == 'negated' else ''}{value};")
        self.write(rows)

    def timer(self):
        name, instance = self.draw.choice(["TON", "TOF", "TP"]), self.instance("TON")
        self.declared[-1] = (instance, name)
        contact, text = self.contact()
        target = self.draw.choice(["b0", "b1", "b2"])
        self.write([[EMPTY, f'<functionblock position="header" name="{instance}" type="{name}"/>', EMPTY],
                    [contact[0][0], f'<functionblock position="top" type="{name}"><input name="IN"/><output name="Q"/></functionblock>',
                     f'<coil type="open" name="{target}"/>'],
                    ['<analog type="input" name="T#25ms"/>',
                     f'<functionblock position="bottom" type="{name}"><input name="PT"/><output name="ET"/></functionblock>', EMPTY]])
        self.statements.append(f"{instance}(IN := {text}, PT := T#25ms); {target} := {instance}.Q;")

    def write(self, rows):
        self.networks.append('<network label="" commented="0">\n' + "\n".join(f"<row>{''.join(row)}</row>" for row in rows) + "\n</network>\n")

    def xml(self, _):
        return "PROGRAM _CYCLIC\n<?xml version=\"1.0\"?>\n<networks maxcolumn=\"0\">\n" + "".join(self.networks) + "</networks>\nEND_PROGRAM\n"


def cells(draw, name):
    net = Cells(draw, name)
    for _ in range(draw.randint(1, 4)):
        net.timer() if draw.random() < 0.2 else net.network()
    return net


def write_folders(folder, nets):
    for net in nets:
        of = folder / "Logical" / net.name
        of.mkdir(parents=True, exist_ok=True)
        (of / "IEC.prg").write_text('<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files><File>Variables.var</File>'
                                    "<File>Cyclic.ld</File></Files></Program>\n")
        (of / "Variables.var").write_text("VAR\n" + "".join(f"{n} : {k};\n" for n, k in net.declared) + "END_VAR\n")
        (of / "Cyclic.ld").write_text(net.xml("LD"))
    return "Logical"


def write_project(folder, nets):
    for net in nets:
        (folder / f"{net.name}.TcPOU").write_text(net.xml("NWL"))
    (folder / "drawn.plcproj").write_text('<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003"><ItemGroup>'
                                          + "".join(f'<Compile Include="{net.name}.TcPOU"/>' for net in nets) + "</ItemGroup></Project>\n")
    return "drawn.plcproj"


def write_export(folder, language, nets, name="drawn.xml"):
    (folder / name).write_text('<project xmlns="http://www.plcopen.org/xml/tc6_0201">'
                               f'<fileHeader productName="{"CODESYS" if language == "LD" else "Beremiz"}"/><types><pous>\n'
                               + "".join(net.xml(language) for net in nets) + "</pous></types></project>\n")
    return name


def run(folder, name, sources, nets):
    signals = [f"{net.name}.{v}" for net in nets for v in ("b0", "b1", "b2", "v0", "v1", "v2")]
    blocks = "".join(f"  {net.name}: {{type: {net.name}, task: main}}\n" for net in nets)
    (folder / f"{name}.yaml").write_text(
        f"lineshaft: 1\ntitle: t\nsources: [driver.st, {sources}]\ntasks: {{main: {{every: 10 ms}}}}\nblocks:\n  d: {{type: Driver, task: main}}\n"
        f"{blocks}run: {{for: 400 ms}}\ntrace: {{task: main, signals: [{', '.join(signals)}]}}\n")
    done = subprocess.run([lineshaft, "run", "--quiet", f"{name}.yaml", "--trace", f"{name}.csv"], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout + done.stderr)
        subprocess.run([lineshaft, "show", sources], cwd=folder)
        sys.exit(f"{name} of seed {seed} gave {done.returncode}")
    return [line for line in (folder / f"{name}.csv").read_bytes().splitlines() if not line.startswith(b"#")]


done = 0
batch = 50
with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    (folder / "driver.st").write_text(DRIVER)
    while done < networks:
        draw = random.Random(f"{seed} {done}")
        language, make = (("LD", ladder), ("FBD", diagram), ("IL", instructions), ("NWL", trees), ("rows", cells))[done // batch % 5]
        nets = [make(draw, f"Net{i}") for i in range(batch)]
        drawn_as = (write_project(folder, nets) if language == "NWL" else write_folders(folder, nets) if language == "rows"
                    else write_export(folder, language, nets))
        said_as = "said.EXP" if language in ("NWL", "LD") else "said.st"  # edges and counters of the dialect
        mark = MATIEC if language in ("FBD", "IL") else ""
        (folder / said_as).write_text("".join(net.text() for net in nets) + mark)
        a, b = run(folder, "drawn", drawn_as, nets), run(folder, "said", said_as, nets)
        if a != b:
            first = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            columns = [j for j, (x, y) in enumerate(zip(a[first].split(b","), b[first].split(b","))) if x != y]
            net = nets[(columns[0] - 2) // 6]
            print(net.xml(language), net.text(), sep="\n")
            one = (f"{net.name}.TcPOU" if language == "NWL" else f"Logical/{net.name}/IEC.prg" if language == "rows"
                   else write_export(folder, language, [net], "one.xml"))
            subprocess.run([lineshaft, "show", one], cwd=folder)
            sys.exit(f"seed {seed}, networks from {done} on: line {first} differs in columns {columns}: {net.name}")
        changing = len(set(a[1:]))
        assert changing > 10, f"the trace shows only {changing} different lines"
        done += batch
print(f"{done} networks and lists, drawn and written: the same bytes")
