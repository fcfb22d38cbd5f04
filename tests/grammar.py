#!/usr/bin/python3
"""The rules that stand above the parser's functions (runtime/st/syntax/parse_*.cpp) are one grammar, and it is what is
read: each name in a rule is a rule or a token, each rule is used, and sources drawn from the rules at random are read
without a mistake of syntax (L0901, L0902), whatever the checker says of them.

usage: grammar.py COMPILE_ST SYNTAX_DIR [SOURCES [SEED]]
"""

import pathlib
import random
import re
import subprocess
import sys
import tempfile

compiler, syntax = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
count = int(sys.argv[3]) if len(sys.argv) > 3 else 300
draw = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
deepest = 60

tokens = {"Name": ["a", "b1", "_c", '"d e"', "#f"], "Quoted_Name": ['"d e"'], "Unsigned_Int": ["1", "16#F", "2#1_0"],
          "Real": ["1.5", "2e3"], "Text": ["'x'", "'it$'s'"], "Direct": ["%X1"], "Duration": ["1h2m"],
          "Type_Prefix": ["INT", "Colour"], "Any_Token": ["w"]}


def rules_above_functions():
    rules = {}
    for path in sorted(syntax.glob("*.cpp")):
        name = None
        for line in path.read_text(encoding="utf-8").splitlines():
            if found := re.match(r"/// ([A-Z]\w*) : (.*)", line):
                name = found[1]
                rules.setdefault(name, []).append(found[2])
            elif name and (found := re.match(r"/// {3,}(.*)", line)):
                rules[name][-1] += " " + found[1]
            else:
                name = None
    return {name: choice_of((" | ".join(texts)).split()) for name, texts in rules.items()}


def choice_of(words):
    """A list of sequences; one is a list of (what, how often): what is a word in quotes, a name or again a choice."""
    choice = [[]]
    while words and words[0] != ")":
        what = words.pop(0)
        if what == "|":
            choice.append([])
            continue
        if what == "(":
            what = choice_of(words)
            words.pop(0)
        choice[-1].append((what, words.pop(0) if words and words[0] in ("?", "*", "+") else ""))
    return choice


def names_in(choice):
    for what, _ in (part for sequence in choice for part in sequence):
        if isinstance(what, list):
            yield from names_in(what)
        elif not what.startswith("'"):
            yield what


grammar = rules_above_functions()
used = {name for choice in grammar.values() for name in names_in(choice)}
unknown, unused = used - set(grammar) - set(tokens), set(grammar) - used - {"Source"}
if unknown or unused or not grammar:
    sys.exit(f"rules that are not there: {sorted(unknown)}; rules that none uses: {sorted(unused)}")


# What the sentences below the rules say: what a rule is within another.
def within(rule, inside):
    rows = {
        "Source": {"Var_Sections": "Var_Section *", "Section_Word": "'VAR_GLOBAL'", "Action_Body": "Stmt_List", "Declaration": "POU | Action_Decl | Data_Type_Decl | Var_Section | Config_Decl",
                   "Stmt": "';' | Region | ( IF_Stmt | Case_Stmt | For_Stmt | While_Stmt | Repeat_Stmt ) ';' ? | "
                           "Jump_Stmt | Simple_Stmt",
                   "Variable_Name": "( 'THIS' '^' ? '.' ) ? Name", "Value": "Expression", "Assigned": "Expression",
                   "Typed_Literal": "'T#1h2m' | 'INT#' Signed_Primary", "Region": "'\nREGION w\n' Stmt_List 'END_REGION\n'",
                   "Attribute": "'VERSION' ':' Real | '\nTITLE' '=' Any_Token '\n'",
                   "Data_Block_Type": "( Array_Spec | Struct_Decl | Type_Access ) ';'",
                   "Type_Access": "( '_' '.' ) ? Name | 'STRING' Text_Length | Name Enum_Values | Name '(' Subrange ')'",
                   "Enum_Spec": "Enum_Values Name",
                   "Variable_Access": "Primary_Expr | Variable_Name ( '(' Params ')' | '[' Subscripts ']' | '.' Member ) +",
                   "Primary_Expr": "Unsigned_Int | Real | Text | Typed_Literal | In_Parentheses | Variable_Name",
                   "Struct_Init": "'(' Name ':=' Init ')' | '(' Init ',' Init ')' | '(' ')'"},
        "Variable_Access": {"Value": "Expression"},
        "Array_Init": {"Value": "Init"}, "Array_Elem_Init": {"Value": "Init"},
        "Case_List_Elem": {"Expression": "Name | '-' ? Unsigned_Int | Name '.' Name"},
        "Access_Stmt": {"Variable_Access": "Name ( '[' Subscripts ']' | '.' Name ) *", "Expression": "Name '(' Name ')'"},
        "Latch_Stmt": {"Variable_Access": "Name ( '.' Name ) *"},
        "Invocation": {"Variable_Access": "Name ( '[' Subscripts ']' | '.' Name ) * '(' Params ')'"},
        "Assign_Stmt": {"Variable_Access": "Name ( '[' Subscripts ']' | '.' Member ) *"},
    }
    if rule == "POU":
        word = "'METHOD'" if "POU_Word" in inside else draw.choice(grammar["POU_Word"][:-1])[0][0]
        has_methods = word in ("'FUNCTION_BLOCK'", "'PROGRAM'")
        rows["POU"] = {"POU_Word": word, "POU_End": "'END_" + word[1:],
                       "Section_Word": "'VAR' | 'VAR_INPUT' | 'VAR_TEMP'",
                       "POU_Body": "Stmt_List ( ( POU | Action_Decl ) Stmt_List ) *" if has_methods else "Stmt_List"}
        rows["POU"]["POU_Header"] = "Attribute * ( 'NON_RETAIN' | 'RETAIN' ) ?" + \
            (" Data_Block_Type" if word == "'DATA_BLOCK'" else "")
    return {**inside, **{name: choice_of(split(text)) for name, text in rows.get(rule, {}).items()}}


def split(text):
    return [word for word in re.findall(r"'[^']*'|\S+", text)]


def least_depths():
    depths = dict.fromkeys(tokens, 0)

    def least(what):
        if isinstance(what, list):
            return min(of_sequence(sequence) for sequence in what)
        return 0 if what.startswith("'") else depths.get(what, 1000)

    def of_sequence(sequence):
        return max((least(what) for what, times in sequence if times in ("", "+")), default=0)

    for _ in grammar:
        depths.update({name: 1 + least(choice) for name, choice in grammar.items()})
    return of_sequence


of_sequence = least_depths()


def drawn(what, depth, inside):
    """Words of a rule, a choice or a token."""
    if isinstance(what, str):
        if what.startswith("'"):
            return [what[1:-1]]
        if what in tokens:
            return [draw.choice(tokens[what])]
        choice = inside.get(what, grammar[what])
        return drawn(choice, depth - 1, within(what, inside))
    least = min(map(of_sequence, what))
    sequence = draw.choice([s for s in what if depth > 0 or of_sequence(s) == least])
    words = []
    for part, times in sequence:
        least, most = {"": (1, 1), "?": (0, 1), "*": (0, 2), "+": (1, 2)}[times]
        more = draw.choices(range(most - least + 1), (1 + deepest - depth, 2, 2)[:most - least + 1])[0] if depth > 0 else 0
        for _ in range(least + more):
            words += drawn(part, depth, inside)
    return words


def text_of(words):
    return " ".join(words).replace(";", ";\n")


with tempfile.TemporaryDirectory() as folder:
    path, wrong, characters = pathlib.Path(folder) / "source.st", 0, 0
    for _ in range(count):
        text = text_of(drawn("Source", deepest, within("Source", {})))
        characters += len(text)
        path.write_text(text, encoding="utf-8")
        answer = subprocess.run([compiler, path.name], cwd=folder, capture_output=True, text=True, timeout=60).stderr
        if found := re.search(r"^.*error\[L090[12]\].*\n.*\n.*", answer, re.M):
            wrong += 1
            print(f"{text}\n{found[0]}\n")
print(f"{len(grammar)} rules, {count} sources of {characters} characters, {wrong} not read")
sys.exit(bool(wrong) or characters < 100 * count)
