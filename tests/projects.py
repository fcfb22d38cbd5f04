#!/usr/bin/python3
"""Projects of others at the prompt: `new --from`, the page of `check PROJECT`, `show`, folders of Automation Studio and SIMATIC
AX, and XML that means harm, each within 1 s of processor time and 256 MB.

usage: projects.py LINESHAFT
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
MOST_SECONDS = 1
MOST_KILOBYTES = float("inf") if os.environ.get("LINESHAFT_MEMORY_LIMITS") == "off" else 256 * 1024


def run(*arguments, code=0, cwd=None):
    done = subprocess.run([lineshaft, *map(str, arguments)], cwd=cwd or work, capture_output=True, text=True)
    assert done.returncode == code, f"{arguments} gave {done.returncode}:\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def write(name, text):
    path = work / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def drawn(body, language="LD", variables="a b"):
    declared = "".join(f'<variable name="{name}"><type><BOOL/></type></variable>' for name in variables.split())
    return (f'<?xml version="1.0" encoding="utf-8"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous>\n'
            f'<pou name="P" pouType="program"><interface><localVars>{declared}</localVars></interface><body><{language}>\n'
            f"{body}\n</{language}></body></pou></pous></types></project>\n")


RUNG = ('<leftPowerRail localId="0"/>\n<contact localId="1"><connectionPointIn><connection refLocalId="0"/></connectionPointIn>'
        '<variable>a</variable></contact>\n'
        '<coil localId="2" negated="true"><connectionPointIn><connection refLocalId="1"/></connectionPointIn><variable>b</variable></coil>')


CODESYS = "http://www.3s-software.com/plcopenxml/"


def addition(kind, text):
    return f'<addData><data name="{CODESYS}{kind}" handleUnknown="implementation">{text}</data></addData>'


def plain(text):
    return f'<InterfaceAsPlainText><xhtml xmlns="http://www.w3.org/1999/xhtml">{text}</xhtml></InterfaceAsPlainText>'


def st(text):
    return f'<body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">{text}</xhtml></ST></body>'


# Bases, interfaces and declarations as text where CODESYS and TwinCAT have them: beside a unit's interface, in it, in a member.
INHERITED = f"""<?xml version="1.0" encoding="utf-8"?>
<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types>
<dataTypes>
<dataType name="Point"><baseType><struct><variable name="x"><type><INT/></type></variable></struct></baseType></dataType>
<dataType name="Place"><baseType><struct><variable name="z"><type><INT/></type></variable></struct></baseType>
{addition("datatypeinheritance", "<Inheritance><Extends>Point</Extends></Inheritance>")}</dataType>
</dataTypes>
<pous>
<pou name="Base" pouType="functionBlock"><interface><localVars><variable name="n"><type><INT/></type></variable></localVars></interface>
{st("")}{addition("method", '<Method name="Twice"><interface><returnType><INT/></returnType></interface>'
                   + st("Twice := 2 * n;") + plain("METHOD Twice : INT&#10;VAR_INPUT&#10;END_VAR") + "</Method>")}</pou>
<pou name="Derived" pouType="functionBlock"><interface>
{addition("pouinheritance", "<Inheritance><Extends>Base</Extends><Implements>Named</Implements><Implements>Sized</Implements></Inheritance>")}
</interface>{st("n := n + 1;")}
<addData><data name="{CODESYS}property" handleUnknown="implementation"><Property name="Name"><interface/>
<GetAccessor><interface/>{st("Name := 'derived';")}{plain("VAR&#10;END_VAR")}</GetAccessor>{plain("PROPERTY Name : STRING")}</Property></data>
<data name="{CODESYS}method" handleUnknown="implementation"><Method name="Size"><interface/>{st("Size := SUPER^.Twice() + add_;")}
{plain("METHOD Size : INT&#10;VAR_INPUT add_ : INT; END_VAR")}</Method></data></addData></pou>
<pou name="Plain" pouType="functionBlock"><interface/>{st("SUPER^();")}
{addition("interfaceasplaintext", plain("FUNCTION_BLOCK Plain EXTENDS Derived&#10;VAR more : INT := 5; END_VAR"))}</pou>
<pou name="Sum" pouType="function"><interface><returnType><INT/></returnType><inputVars>
<variable name="all"><type><pointer><baseType><INT/></baseType></pointer></type>
{addition("attributes", '<Attributes><Attribute Name="variable_length_array_original_scope" Value="Inout"/>'
          '<Attribute Name="variable_length_array" Value="ARRAY[*] OF INT"/></Attributes>')}</variable>
<variable name="more"><type><INT/></type></variable></inputVars>
<localVars><variable name="i"><type><DINT/></type></variable></localVars></interface>
{st("Sum := more; FOR i := LOWER_BOUND(all, 1) TO UPPER_BOUND(all, 1) DO Sum := Sum + all[i]; END_FOR")}</pou>
<pou name="Main" pouType="program"><interface><localVars>
<variable name="all"><type><array><dimension lower="2" upper="4"/><baseType><INT/></baseType></array></type></variable>
<variable name="one"><type><derived name="Plain"/></type></variable><variable name="sized"><type><derived name="Sized"/></type></variable>
<variable name="place"><type><derived name="Place"/></type></variable>
</localVars><outputVars><variable name="size"><type><INT/></type></variable></outputVars></interface>
{st("one(); sized := one; place.x := one.more; place.z := 100; all[3] := 4; size := sized.Size(add_ := place.z) + Sum(all, place.x - 4);")}</pou>
</pous></types>
<instances><configurations><configuration name="c"><resource name="r"><task name="slow" interval="PT0S" priority="3">
<pouInstance name="Main" typeName=""/>
{addition("tasksettings", '<TaskSettings KindOfTask="Cyclic" Interval="20000" IntervalUnit="us"/>')}
</task></resource></configuration></configurations></instances>
<addData>
<data name="{CODESYS}interface" handleUnknown="implementation"><Interface name="Named"><Properties><Property name="Name">
<GetAccessor>{plain("")}</GetAccessor>{plain("PROPERTY Name : STRING")}</Property></Properties>{plain("INTERFACE Named")}</Interface></data>
<data name="{CODESYS}interface" handleUnknown="implementation"><Interface name="Sized"><Methods><Method name="Size"><interface>
<returnType><INT/></returnType><inputVars><variable name="add_"><type><INT/></type></variable></inputVars></interface></Method></Methods>
</Interface></data>
</addData></project>
"""


def check_inherited():
    project = write("inherited/plant.xml", INHERITED)
    assert run("check", project).startswith("ok "), run("check", project)
    run("new", "inherited/machine", "--from", project)
    text = (work / "inherited/machine.yaml").read_text()
    assert "slow: {every: 20 ms, priority: 1}" in text, text
    (work / "inherited/machine.yaml").write_text(text + "expect: [{at: 30 ms, Main.size: 109}]\n")  # 2 * 2 + 100 + 5
    run("run", "inherited/machine.yaml")
    wrong = write("inherited/wrong.xml", INHERITED.replace("<Extends>Base</Extends>", "<Extends>Bse</Extends>"))
    said = run("check", wrong, code=2)
    line = 1 + INHERITED[:INHERITED.index("<Extends>Base")].count("\n")
    assert f"wrong.xml:{line}:" in said and "'Bse'" in said, said


def check_new_from():
    """What `new --from` says and writes runs as it is said."""
    for folder, project in (("beside", "beside/plant/P.xml"), ("away/here", "away/there/P.xml"), ("away/here2", "a way/P.xml")):
        write(project, drawn(RUNG))
        target = work / folder
        target.mkdir(parents=True, exist_ok=True)
        said = run("new", "machine", "--from", work / project, cwd=target)
        command = re.search(r"try: lineshaft (.+)", said)[1]
        run(*shlex.split(command), cwd=target)
        in_file = re.findall(r"^#   lineshaft (.+)", (target / "machine.yaml").read_text(), re.M)
        assert len(in_file) == 2
        for command in in_file:
            run(*shlex.split(command), cwd=target)
        values = (target / "machine.csv").read_text().splitlines()[-1].lower()
        assert values.endswith((",0,1", ",false,true")), values


def check_new_traces():
    """The trace of a program with axes shows where they are, and not the pins of its blocks."""
    write("traced.st", "PROGRAM Main\nVAR x, y : AXIS_REF; power : MC_Power; move : MC_MoveVelocity; scans : INT; END_VAR\n"
          "power(Axis := x, Enable := TRUE);\nmove(Axis := y, Execute := power.Status, Velocity := 10.0);\nscans := scans + 1;\nEND_PROGRAM\n")
    run("new", "traced", "--from", "traced.st")
    text = (work / "traced.yaml").read_text()
    signals = "[Main_x.position, Main_x.velocity, Main_y.position, Main_y.velocity, Main.scans]"
    assert f"trace: {{task: main, signals: {signals}}}\n" in text, text
    run("run", "--quiet", "traced.yaml", "--trace", "traced.csv")
    write("bare.st", "PROGRAM Main\n;\nEND_PROGRAM\n")
    run("new", "bare", "--from", "bare.st")
    assert "--trace" not in (work / "bare.yaml").read_text()


def check_page():
    """`check PROJECT` names causes with counts and the first place."""
    write("page/A.xml", drawn(RUNG))
    write("page/B.xml", drawn(RUNG.replace(">a<", ">nobody<")).replace('name="P"', 'name="Q"'))
    page = run("check", "page", code=2)
    assert "page: 1 of 2 POUs, types and lists have no mistake; 0 tasks, 0 libraries\n" in page, page
    assert re.search(r"\n +1 +1  L0904 '\.\.\.' is not declared\n +page/B\.xml:5:", page), page
    assert "page/B.xml:5:99: error[L0904]: 'nobody' is not declared (network 1, contact 1)" in page, page
    write("parts/Logical/P/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Main.st</File><File>Variables.var</File></Files></Program>\n")
    write("parts/Logical/P/Variables.var", "VAR\n\tn : Nowhere;\nEND_VAR\n")
    write("parts/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tm := 1;\nEND_PROGRAM\n")
    page = run("check", "parts", code=2)
    assert "parts: 0 of 1 POUs, types and lists have no mistake" in page and "'Nowhere' is not a type" in page, page
    assert run("check", "page/A.xml") == "ok  page/A.xml\n"
    assert "P.b" not in run("show", "page/A.xml") and "b := NOT a;\n" in run("show", "page/A.xml")
    listed = write("listed.xml", drawn("").replace("<LD>\n\n</LD>", "<IL><p>LD a\nSTN b</p></IL>"))
    assert "b := NOT a;\n" in run("show", listed)
    bad = write("bad.xml", drawn("").replace("<LD>\n\n</LD>", "<IL><p>ADD a</p></IL>"))
    assert re.search(r"bad.xml:\d+:\d+: error.* there is no result that ADD takes", run("show", bad, code=2))


def check_configuration():
    """The tasks of a CONFIGURATION in Structured Text, which OpenPLC writes, are those of the program around it."""
    write("configured.st", "PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\nPROGRAM Slow VAR n : INT; END_VAR n := n + 1; "
          "END_PROGRAM\nCONFIGURATION c\n  RESOURCE r ON PLC\n    TASK quick(INTERVAL := T#5ms, PRIORITY := 0);\n"
          "    TASK idle(PRIORITY := 3, INTERVAL := T#1s_500ms);\n    PROGRAM one WITH quick : Main;\n"
          "    PROGRAM two WITH idle : Slow;\n  END_RESOURCE\nEND_CONFIGURATION\n")
    run("new", "configured", "--from", "configured.st")
    text = (work / "configured.yaml").read_text()
    for line in ("quick: {every: 5 ms, priority: 2}", "idle: {every: 1500 ms, priority: 1}", "Main: {type: Main, task: quick}",
                 "Slow: {type: Slow, task: idle}"):
        assert line in text, text
    run("run", "--quiet", "configured.yaml")
    write("several.st", "PROGRAM Belt VAR_INPUT speed : INT; on : BOOL; END_VAR VAR_OUTPUT way : INT; END_VAR "
          "IF on THEN way := way + speed; END_IF; END_PROGRAM\nCONFIGURATION c\n  RESOURCE r ON PLC\n"
          "    TASK quick(INTERVAL := T#5ms, PRIORITY := 0);\n    PROGRAM left WITH quick : Belt(speed := 2, on := TRUE);\n"
          "    PROGRAM right WITH quick : Belt(speed := -3, on := TRUE);\n  END_RESOURCE\nEND_CONFIGURATION\n")
    run("new", "several", "--from", "several.st")
    text = (work / "several.yaml").read_text()
    for line in ("left: {type: Belt, task: quick, speed: 2, on: true}", "right: {type: Belt, task: quick, speed: -3, on: true}"):
        assert line in text, text
    run("run", "--quiet", "several.yaml")
    write("placed.st", "PROGRAM main\n  VAR\n    start AT %IX0.2 : BOOL;\n    level AT %IW1 : INT;\n    lamp AT %QX0.0 : BOOL;\n"
          "    speed AT %QW0 : INT;\n  END_VAR\n  lamp := NOT start;\n  speed := level;\nEND_PROGRAM\n\nCONFIGURATION Config0\n\n"
          "  RESOURCE Res0 ON PLC\n    TASK task0(INTERVAL := T#20ms,PRIORITY := 0);\n    PROGRAM instance0 WITH task0 : main;\n"
          "  END_RESOURCE\nEND_CONFIGURATION\n")
    run("new", "placed", "--from", "placed.st")
    text = (work / "placed.yaml").read_text()
    for line in ("  IX0_2: false  # start", "  IW1: 0  # level", '  "%IX0.2": inputs.IX0_2', '"%QX0.0", "%QW0", "%IX0.2"'):
        assert line in text, text
    run("run", "--quiet", "placed.yaml", "--force", "inputs.IW1=7", "--trace", "placed.csv")
    assert (work / "placed.csv").read_text().splitlines()[1].startswith("0,0,1,7,"), "lamp is no bit of speed"


def check_exported_tasks():
    """CoDeSys 2.3 exports its tasks, and names of inputs and outputs, beside its programs; without tasks it runs PLC_PRG."""
    programs = "".join(f"PROGRAM {name}\nVAR n : INT; END_VAR\nn := n + 1; {more}\nEND_PROGRAM\n" for name, more in
                       (("PLC_PRG", "Helper(); lamp := start; speed := level;"), ("Helper", ""), ("Fast", ""), ("Late", "")))
    write("exported/PRG.EXP", programs + "VAR_GLOBAL\n  go : BOOL;\nEND_VAR\n")
    whole = (work / "exported/PRG.EXP").read_text() + "\nFUNCTION Other : INT\nOther := 1;\nEND_FUNCTION\n"
    write("exported/whole.exp", whole)  # what stands in it alone, too, counts once
    write("exported/IO.EXP", """PLC_CONFIGURATION
_GLOBAL
_VERSION: 3
_END_GLOBAL
_MODULE: '3S'
_SECTION_NAME: 'Root'
_CHANNEL
_SECTION_NAME: 'ByteInput'
_SYMBOLIC_NAME: ''
_CHANNEL_MODE: 'I'
_IECADR: %IB0.0
_BIT 0: %IX0.0.0 'start' 'begins'
_BIT 1: %IX0.0.1 '' 'Bit 1'
_END_CHANNEL
_CHANNEL
_SECTION_NAME: 'FloatInput'
_SYMBOLIC_NAME: 'level'
_CHANNEL_MODE: 'I'
_IECADR: %ID9.1.0
_END_CHANNEL
_CHANNEL
_SECTION_NAME: 'FloatOutput'
_SYMBOLIC_NAME: 'speed'
_IECADR: %QD9.265.0
_END_CHANNEL
_CHANNEL
_SECTION_NAME: 'BitOutput'
_SYMBOLIC_NAME: 'lamp'
_IECADR: %QX2.3
_END_CHANNEL
_END_MODULE
PLC_END
MACRO
MacroName: 'export'
MacroCmd: 'project expmul'
END_MACRO
""")
    run("new", "untasked", "--from", "exported")
    text = (work / "untasked.yaml").read_text()
    assert "PLC_PRG: {type: PLC_PRG, task: main}" in text and "{type: Fast" not in text, text
    assert "IX0_0: false  # start" in text, text
    run("run", "--quiet", "untasked.yaml")
    write("exported/TASKS.EXP", """RESOURCE

TASK free (PRIORITY := 1);
PLC_PRG();
{Additional_info : 2,0,0,0,1,4294967295}
END_TASK

TASK quick (PRIORITY := 0, INTERVAL := T#200ms);
Fast();
END_TASK

TASK late (PRIORITY := 3, EVENT := go);
Late();
END_TASK
{event_task : 'start','Called when program starts','','FUNCTION systemevent: DWORD'}{event_task_info : 0,1,27841}

END_RESOURCE
""")
    run("new", "tasked", "--from", "exported")
    text = (work / "tasked.yaml").read_text()
    for line in ("free: {every: 10 ms, priority: 1}  # it runs freely there, without an interval", "quick: {every: 200 ms, priority: 2}",
                 "# 'late' runs Late at the event 'go': give it a task such as x: {on: a.signal}", "Fast: {type: Fast, task: quick}",
                 "PLC_PRG: {type: PLC_PRG, task: free}"):
        assert line in text, text
    assert "{type: Late" not in text and "{type: Helper" not in text, text
    run("run", "--quiet", "tasked.yaml")


def check_tasks_of_codesys():
    """A task of CODESYS 3 is cyclic, free or of an event, whatever its interval says."""
    pous = "".join(f'<pou name="{name}" pouType="program"><interface><localVars><variable name="n"><type><INT/></type></variable>'
                   f'</localVars></interface>{st("n := n + 1;")}</pou>' for name in ("Free", "Late"))
    tasks = "".join(f'<task name="{name}" interval="PT0.02S" priority="{priority}"><pouInstance name="{name}" typeName=""/>'
                    + addition("tasksettings", f"<TaskSettings {settings}/>") + "</task>" for name, priority, settings in
                    (("Free", 2, 'KindOfTask="Freewheeling"'), ("Late", 1, 'KindOfTask="Event" Event="GVL.go"')))
    write("settings.xml", f'<project xmlns="http://www.plcopen.org/xml/tc6_0200"><types><pous>{pous}</pous></types><instances>'
          f'<configurations><configuration name="c"><resource name="r">{tasks}</resource></configuration></configurations></instances>'
          "</project>")
    run("new", "settings", "--from", "settings.xml")
    text = (work / "settings.yaml").read_text()
    for line in ("Free: {every: 10 ms, priority: 1}  # it runs freely there", "# 'Late' runs Late at the event 'GVL.go'"):
        assert line in text, text
    assert "{type: Late" not in text, text


def exported(name, number, owner, declaration, body=None, excluded="False"):
    """An object as CODESYS 3 has it in `.export`."""
    def lines(text):
        return "".join(f'<Single Type="{{a5}}"><Single Name="Id" Type="long">1</Single><Null Name="Tag" />'
                       f'<Single Name="Text" Type="string">{line}</Single></Single>' for line in text.split("\n"))

    def document(part, text):
        return (f'<Single Name="{part}" Type="{{b}}"><Single Name="TextDocument" Type="{{f3}}"><Array Name="TextLines" Type="{{a5}}">'
                f'{lines(text)}</Array></Single></Single>')
    return (f'<Single Type="{{61}}"><Single Name="IsRoot" Type="bool">True</Single><Single Name="MetaObject" Type="{{81}}">'
            f'<Single Name="Guid" Type="System.Guid">{number}</Single><Single Name="ParentGuid" Type="System.Guid">{owner}</Single>'
            f'<Single Name="Name" Type="string">{name}</Single><Dictionary Type="{{2c}}" Name="Properties"><Entry><Key/><Value>'
            f'<Single Type="{{24}}"><Single Name="ExcludeFromBuild" Type="bool">{excluded}</Single></Single></Value></Entry></Dictionary>'
            f'</Single><Single Name="Object" Type="{{6f}}">{"" if body is None else document("Implementation", body)}'
            f'{document("Interface", declaration) if declaration else ""}</Single></Single>')


def check_codesys_export():
    """`.export` of CODESYS 3: lines of texts, and methods, properties and actions as objects of their own."""
    objects = (exported("Belt", 1, 0, "FUNCTION_BLOCK Belt\nVAR\n  n : INT;\nEND_VAR", "IF n &lt; 100 THEN\n  n := n + Step(2);\nEND_IF\nDouble();")
               + exported("Step", 2, 1, "METHOD PUBLIC Step : INT\nVAR_INPUT\n  more : INT;\nEND_VAR", "Step := more;")
               + exported("Double", 3, 1, "", "n := n * 2;")
               + exported("Count", 4, 1, "PROPERTY Count : INT") + exported("Get", 5, 4, "VAR\nEND_VAR", "Count := n;")
               + exported("Kind", 6, 0, "TYPE Kind : (idle, busy); END_TYPE") + exported("GVL", 7, 0, "VAR_GLOBAL\n  kind : Kind;\nEND_VAR")
               + exported("Old", 8, 0, "PROGRAM Old\nVAR\nEND_VAR", "nonsense", "True")
               + exported("PLC_PRG", 9, 0, "PROGRAM PLC_PRG\nVAR\n  belt : Belt;\n  n : INT;\nEND_VAR", "belt();\nn := belt.Count;\nGVL.kind := busy;"))
    path = "exported3/line.export"
    write(path, '<ExportFile>\n<StructuredView Guid="{21}">\n<Single xml:space="preserve" Type="{3d}"><Array Name="Profile" Type="byte">AA==</Array>'
          f'<List Name="Entries">{objects}</List></Single></StructuredView></ExportFile>')
    write("exported3/other.export", "PATH=/bin")
    run("new", "line", "--from", "exported3")
    assert "PLC_PRG: {type: PLC_PRG, task: main}" in (work / "line.yaml").read_text()
    run("run", "--quiet", "line.yaml", "--trace", "line.csv")
    header, *rows = (work / "line.csv").read_text().splitlines()
    at = header.split(",").index("PLC_PRG.n")
    assert [row.split(",")[at] for row in rows[:3]] == ["4", "12", "28"], (header, rows[:3])
    write(path, (work / path).read_text().replace("belt();", "belt(]);"))
    told = run("check", path, code=2)
    assert "line.export:3:" in told, told


def check_unread_bodies():
    """A TEST that needs a body which is not read does not pass."""
    write("unread/p.xml", drawn("<p/>", "LISP").replace('pouType="program"', 'pouType="functionBlock"'))
    write("unread/p_test.st", "SETUP\nVAR p : P; END_VAR\nEND_SETUP\nTEST 'does nothing'\np();\nASSERT_EQ(1, 1);\nEND_TEST\n")
    told = run("test", "unread", code=1)
    assert "the body of 'P' is drawn (LISP), which is not read" in told, told
    write("unread_rung/A.s7dcl", 'FUNCTION_BLOCK "A"\nVAR_INPUT a : Bool; END_VAR\nVAR_OUTPUT y : Bool; END_VAR\n{ S7_Language := "LAD" }\n'
          "NETWORK\nRUNG wire#powerrail\nContact( #a )\nNContact( #a )\nCoil( #y )\nEND_RUNG\nEND_NETWORK\nEND_FUNCTION_BLOCK\n")
    write("unread_rung/a_test.scl", "TEST 'lit'\nVAR f : \"A\"; END_VAR\nf(a := TRUE); ASSERT_TRUE(f.y);\nEND_TEST\n")
    told = run("test", "unread_rung", code=1)
    assert "A.s7dcl:8:1: error[L0903]: the instruction NContact is not supported" in told, told
    write("unread_list/list.EXP", "FUNCTION_BLOCK A\nVAR_OUTPUT y : BOOL; END_VAR\nLD TRUE\nST y\nJMPC nowhere\nEND_FUNCTION_BLOCK\n")
    write("unread_list/a_test.st", "TEST 'lit'\nVAR f : A; END_VAR\nf(); ASSERT_TRUE(f.y);\nEND_TEST\n")
    told = run("test", "unread_list", code=1)
    assert "list.EXP:5:1: error" in told, told
    shutil.copytree(pathlib.Path(__file__).parent / "cases" / "openplc_editor_4", work / "unread_ladder")
    ladder = work / "unread_ladder/pous/programs/main.ld"
    ladder.write_text(ladder.read_text().replace('"variant": "set"', '"variant": "sett"'))
    write("unread_ladder/main_test.st", "TEST 'runs'\nVAR p : main; END_VAR\np();\nASSERT_EQ(1, 1);\nEND_TEST\n")
    told = run("test", "unread_ladder", code=1)
    assert "'sett' is no kind of coil" in told, told
    write("unread_file/One/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC"><Files>\n<File>Cyclic.st</File>\n<File>Actions.st</File>\n</Files></Program>\n')
    write("unread_file/One/Cyclic.st", "PROGRAM _CYCLIC\nEND_PROGRAM\n")
    write("unread_file/one_test.st", "TEST 'runs'\nVAR p : One; END_VAR\np();\nASSERT_EQ(1, 1);\nEND_TEST\n")
    told = run("test", "unread_file", code=1)
    assert "IEC.prg:4:1: error" in told and "Actions.st" in told, told


CELL = """PROGRAM Main
VAR_INPUT gain : INT; on : BOOL; END_VAR
VAR_OUTPUT cnt : INT; lamp : BOOL; END_VAR
VAR start : INT; lit AT %Q* : BOOL; END_VAR
cnt := cnt + gain; lamp := on; lit := start = 42;
END_PROGRAM
FUNCTION_BLOCK Part
VAR_OUTPUT n : INT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
PROGRAM Count
VAR_OUTPUT n : INT; END_VAR
VAR own : Part; END_VAR
n := n + 1;
own();
END_PROGRAM
CONFIGURATION Cell
VAR_GLOBAL total : INT; g : INT := 3; go : BOOL; END_VAR
VAR_GLOBAL CONSTANT CYCLE : TIME := T#20ms; END_VAR
RESOURCE R1 ON CPU
 TASK Fast(INTERVAL := T#10ms, PRIORITY := 1);
 TASK Named(INTERVAL := CYCLE, PRIORITY := 2);
 TASK Event(SINGLE := go, PRIORITY := 0);
 TASK Pressed(SINGLE := %IX7.0, PRIORITY := 0);
 PROGRAM P1 WITH Fast : Main(gain := g, on := %IX0.1, cnt => total, lamp => %QX0.3);
 PROGRAM P2 WITH Named : Count(own WITH Fast);
 PROGRAM P3 WITH Event : Count;
 PROGRAM P4 : Count;
 PROGRAM P5 WITH Pressed : Count;
END_RESOURCE
RESOURCE R2 ON CPU
 TASK Fast(INTERVAL := T#50ms, PRIORITY := 1);
 PROGRAM P1 WITH Fast : Count;
END_RESOURCE
VAR_CONFIG R1.P1.start : INT := 42; R1.P1.lit AT %QX2.0 : BOOL; END_VAR
END_CONFIGURATION
"""


def check_configured_programs():
    """Programs of a CONFIGURATION are connected; events, constants, what has no task and tasks of one name are tasks of their own."""
    write("cell.st", CELL)
    said = run("new", "cell", "--from", "cell.st")
    assert "cell.st:26:32: warning[L0903]: 'own' runs where Count calls it, not in the task 'Fast'" in said, said
    text = (work / "cell.yaml").read_text()
    for line in ("  Fast: {every: 10 ms, priority: 3}", "  Named: {every: 20 ms, priority: 2}", "  Event: {on: [globals.go], priority: 4}",
                 "  background: {every: 10 ms, priority: 1}  # without a TASK a controller runs it again and again",
                 "  R2_Fast: {every: 50 ms, priority: 3}", "  P1: {type: R1.P1, task: Fast}",
                 "  P2: {type: Count, task: Named}  # 'own' is of the task 'Fast' in the project", "  P3: {type: Count, task: Event}",
                 "  P4: {type: Count, task: background}", "  Pressed: {on: [inputs.IX7_0], priority: 4}", "  IX7_0: false  # starts the task Pressed",
                 "  P1_R2_Fast: {type: Count, task: R2_Fast}"):
        assert line + "\n" in text, text
    write("cell.yaml", text + "stimulus:\n  - {at: 105 ms, set: {inputs.IX0_1: true, inputs.IX7_0: true}}\nforce:\n  - {set: {globals.go: true}, from: 105 ms}\nexpect:\n  - {at: 95 ms, globals.total: 30}\n"
          '  - {at: 95 ms, P1.lamp: false}\n  - {at: 95 ms, "%QX2.0": true}\n  - {at: 995 ms, "%QX0.3": true}\n  - {at: 995 ms, P1.lamp: true}\n'
          "  - {at: 995 ms, P2.n: 50}\n  - {at: 995 ms, P3.n: 1}\n  - {at: 995 ms, P5.n: 1}\n  - {at: 995 ms, P4.n: 100}\n  - {at: 995 ms, P1_R2_Fast.n: 20}\n")
    said = run("run", "--quiet", "cell.yaml")
    assert "CONFIGURATION" not in said, "all its programs run"
    write("part.yaml", "lineshaft: 1\nsources: cell.st\ntasks: {t: {every: 10 ms}}\nblocks: {a: {type: R1.P1, task: t}, b: {type: Count, task: t}}\n"
          "run: {for: 20 ms}\nexpect: [{at: end, total: 6}]\n")
    said = run("check", "part.yaml", code=2)
    assert "write globals.total" in said, said
    write("part.yaml", (work / "part.yaml").read_text().replace("total", "globals.total"))
    said = run("check", "part.yaml")
    assert said.count("no block runs this program of the CONFIGURATION, a 'Count'") == 4, said


def check_tasks_of_plcopen():
    """What starts a task of PLCopen XML, programs beside its tasks, and several of one PROGRAM by their own names."""
    pou = '<pou name="P" pouType="program"><interface><localVars><variable name="n"><type><INT/></type></variable></localVars></interface>' + st("n := n + 1;") + "</pou>"
    write("started.xml", f'<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201"><fileHeader productName="Beremiz"/><types><dataTypes/><pous>{pou}'
          '</pous></types><instances><configurations><configuration name="c"><resource name="r"><task name="quick" priority="0" interval="T#5ms">'
          '<pouInstance name="one" typeName="P"/></task><task name="event" priority="1" single="go"><pouInstance name="two" typeName="P"/></task>'
          '<pouInstance name="three" typeName="P"/><globalVars><variable name="go"><type><BOOL/></type></variable></globalVars></resource></configuration>'
          "</configurations></instances></project>\n")
    run("new", "started", "--from", "started.xml")
    text = (work / "started.yaml").read_text()
    for line in ("quick: {every: 5 ms, priority: 3}", "event: {on: [globals.go], priority: 2}", "background: {every: 5 ms, priority: 1}",
                 "one: {type: P, task: quick}", "two: {type: P, task: event}", "three: {type: P, task: background}"):
        assert line in text, text
    write("started.yaml", text + "expect: [{at: end, one.n: 201}, {at: end, two.n: 0}, {at: end, three.n: 201}]\n")
    run("run", "--quiet", "started.yaml")
    # Beside a project with a mistake what no program names is left out, and so is what only starts a task.
    whole = (work / "started.xml").read_text()
    write("lost/a/plc.xml", whole)
    write("lost/b/plc.xml", re.sub("<instances>.*</instances>", "", whole).replace('name="P"', 'name="Wrong"').replace("n := n + 1", "n := missing"))
    run("new", "lost", "--from", "lost")
    assert "'event' runs P at the event 'go'" in (work / "lost.yaml").read_text()
    run("run", "--quiet", "lost.yaml")


def check_order_of_programs():
    """What MatIEC calls in one scan stands in the order of the RESOURCE, or of the tasks of a drawn project, not of PRIORITY."""
    bodies = {name: f"seen := g; g := {number};" for number, name in enumerate(("First", "Second"), 1)}
    text = "".join(f"PROGRAM {name}\nVAR_EXTERNAL g : INT; END_VAR\nVAR seen : INT; END_VAR\n{body}\nEND_PROGRAM\n" for name, body in bodies.items())
    write("ordered.st", text + "CONFIGURATION c\n  VAR_GLOBAL g : INT; END_VAR\n  RESOURCE r ON PLC\n    TASK quick(INTERVAL := T#20ms, PRIORITY := 0);\n"
          "    TASK slow(INTERVAL := T#40ms, PRIORITY := 5);\n    PROGRAM i1 WITH slow : First;\n    PROGRAM i2 WITH quick : Second;\n"
          "  END_RESOURCE\nEND_CONFIGURATION\n")
    variable = '<variable name="{}"><type><INT/></type></variable>'
    pous = "".join(f'<pou name="{name}" pouType="program"><interface><externalVars>{variable.format("g")}</externalVars>'
                   f'<localVars>{variable.format("seen")}</localVars></interface>{st(body)}</pou>' for name, body in bodies.items())
    tasks = "".join(f'<task name="{name}" priority="{priority}" interval="T#{every}ms"><pouInstance name="i{name}" typeName="{of}"/></task>'
                    for name, priority, every, of in (("slow", 5, 40, "First"), ("quick", 0, 20, "Second")))
    write("ordered.xml", '<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201"><fileHeader productName="Beremiz"/><types><dataTypes/>'
          f'<pous>{pous}</pous></types><instances><configurations><configuration name="c"><resource name="r">{tasks}</resource><globalVars>'
          f'{variable.format("g")}</globalVars></configuration></configurations></instances></project>\n')
    for number, source in enumerate(("ordered.st", "ordered.xml")):
        run("new", f"ordered{number}", "--from", source)
        text = (work / f"ordered{number}.yaml").read_text()
        write(f"ordered{number}.yaml", text + "expect: [{at: 10 ms, First.seen: 0}, {at: 10 ms, Second.seen: 1}, {at: 50 ms, First.seen: 2}, {at: end, globals.g: 2}]\n")
        run("run", "--quiet", f"ordered{number}.yaml")


def check_coil_in_mid_rung():
    """What Beremiz makes of several lines to a coil that more stands behind is not what is drawn."""
    def element(tag, number, lines, variable):
        ends = "".join(f'<connection refLocalId="{i}"/>' for i in lines)
        return (f'<{tag} localId="{number}"><position x="{number}" y="0"/><connectionPointIn>{ends}</connectionPointIn>'
                f"<variable>{variable}</variable></{tag}>\n")
    rung = '<leftPowerRail localId="0"/>\n' + element("contact", 1, [0], "a") + element("contact", 2, [0], "b")
    for lines, count in (([1, 2], 1), ([1], 0)):
        whole = drawn(rung + element("coil", 3, lines, "c") + element("coil", 4, [3], "d"), variables="a b c d")
        said = run("check", write("middle.xml", whole.replace("<types>", '<fileHeader productName="Beremiz"/><types>')))
        assert said.count("Beremiz and OpenPLC ask for all of them there (network 1, coil 3)") == count, said
        assert "Beremiz" not in run("check", write("middle.xml", whole)), "CODESYS does as it is drawn"


def check_programs_without_tasks():
    """Where no task is said, what another PROGRAM calls runs there alone."""
    write("calling.st", "PROGRAM Sub\nVAR_OUTPUT n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM\nPROGRAM PLC_PRG\nVAR seen : INT; END_VAR\nSub();\n"
          "seen := Sub.n;\nEND_PROGRAM\nPROGRAM Other\nVAR n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM\n")
    run("new", "calling", "--from", "calling.st")
    text = (work / "calling.yaml").read_text()
    assert "  Other: {type: Other, task: main}" in text and "Sub:" not in text, text
    write("calling.yaml", text + "expect: [{at: end, PLC_PRG.seen: 101}]\n")
    run("run", "--quiet", "calling.yaml")


def check_texts_of_any_name():
    """Structured Text is known by what it begins with, where the file's name does not say it; in a folder that has nothing else."""
    unit = "(* of an editor *)\nPROGRAM {}\nVAR n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM\n"
    for name in ("a.iecst", "b.iec", "c.txt", "d.scl.txt", "e.il"):
        write(f"any_name/{name}/{name}", unit.format("Main"))
        assert run("check", f"any_name/{name}/{name}").startswith("ok"), name
        run("new", f"of_{name[0]}", "--from", f"any_name/{name}")
        assert "Main: {type: Main, task: main}" in (work / f"of_{name[0]}.yaml").read_text(), name
        run("run", "--quiet", f"of_{name[0]}.yaml")
    write("any_mixed/main.st", unit.format("Main"))
    write("any_mixed/old.txt", unit.format("Main"))
    write("any_mixed/notes.txt", "Type what you see.\n")
    assert run("check", "any_mixed").startswith("ok"), "a copy beside it"
    write("any_notes/notes.txt", "Program the clock first.\n")
    assert "there is no source of a controller" in run("check", "any_notes", code=2)


CHART = """PROGRAM PLC_PRG
VAR_INPUT reset, init : BOOL; END_VAR
VAR machine : Machine; END_VAR
VAR_OUTPUT done, runs, begun : INT; END_VAR
machine.Act(SFCReset := reset, SFCInit := init);
done := machine.done; runs := machine.runs; begun := machine.begun;
END_PROGRAM
FUNCTION_BLOCK Machine
VAR SFCInit, SFCReset, lamp : BOOL; done, runs, begun : INT; END_VAR
ACTION Act:
INITIAL_STEP Begin:
    Count(N);
END_STEP
STEP Work:
    Run(N);
    lamp(S);
END_STEP
STEP Done: END_STEP
TRANSITION FROM Begin TO Work := Begin.T >= T#2ms; END_TRANSITION
TRANSITION FROM Work TO Done := Work.T >= T#2ms; END_TRANSITION
END_ACTION
ACTION Count: begun := begun + 1; END_ACTION
ACTION Run: runs := runs + 1; done := BOOL_TO_INT(lamp); END_ACTION
END_FUNCTION_BLOCK
"""


def check_chart_flags():
    """SFCReset and SFCInit of CODESYS begin a chart again; who calls an action gives its block's inputs."""
    write("chart/ALL.EXP", CHART)
    write("chart/chart.yaml", "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nsources: ALL.EXP\nblocks: {p: {type: PLC_PRG, task: t, "
          "reset: inputs.reset, init: inputs.init}}\ninputs: {reset: false, init: false}\nrun: {for: 30 ms}\nstimulus:\n"
          "  - {at: 10 ms, set: {inputs.reset: true}}\n  - {at: 12 ms, set: {inputs.reset: false}}\n"
          "  - {at: 20 ms, set: {inputs.init: true}}\nexpect:\n  - {at: 9 ms, p.begun: 4}\n  - {at: 9 ms, p.runs: 4}\n"
          "  - {at: 11 ms, p.begun: 6}\n  - {at: 11 ms, p.runs: 4}\n  - {at: 19 ms, p.runs: 8}\n  - {at: end, p.runs: 8}\n"
          "  - {at: 19 ms, p.begun: 10}\n  - {at: end, p.begun: 10}\n")
    run("run", "chart/chart.yaml")


def check_older_forms():
    """CoDeSys 2.3 exports pictures and open addresses beside its units; B&R declares what is elsewhere, by any name."""
    write("old/ALL.EXP", "(* @NESTEDCOMMENTS := 'Yes' *)\nPROGRAM PLC_PRG\nVAR x AT %Q* : BOOL; n : ARRAY[1..3] OF INT := 3(7); m : ARRAY[1..2] OF INT := 0; "
          "axis : MpAxis := (0); END_VAR\n(* @END_DECLARATION := '0' *)\nn[1] := m[2];\nEND_PROGRAM\nVISUALISATION View _VISU_TYPES : 1,1\n"
          "_TEXT : '$R$N', ''not of the language {\nEND_VISUALISATION\nVAR_CONFIG\n  PLC_PRG.x AT %QX0.0 : BOOL;\nEND_VAR\n"
          "FUNCTION Twice : INT\nVAR_INPUT x : INT; END_VAR\nTwice := 2 * x;\nEND_FUNCTION\n")
    write("old/operator.fun", "FUNCTION AND : ANY\nVAR_INPUT IN1 : ANY; END_VAR\nEND_FUNCTION\nFUNCTION ADR : UDINT\nVAR_INPUT x : ANY; END_VAR\n"
          "END_FUNCTION\n{REDUND_OK} FUNCTION_BLOCK MpAxis\nVAR_INPUT Continue : BOOL; to : UDINT; END_VAR\nEND_FUNCTION_BLOCK\n")
    write("old/Global.var", "VAR\n  pins : pins_typ := (0);\n  flags : BOOL;\nEND_VAR\n")
    write("old/Global.typ", "TYPE pins_typ : STRUCT\n  x, y : INT;\n END_STRUCT; END_TYPE\n")
    write("old/motion.typ", "TYPE move_typ : STRUCT\n  TargetPosition : DINT;\n  targetPosition : DINT;\n END_STRUCT; END_TYPE\n")
    write("old/ident.fun", "FUNCTION ST_ident : UINT\nVAR_INPUT name, st_ident : UDINT; END_VAR\nEND_FUNCTION\n")
    write("old/log.typ", "TYPE LogRead : STRUCT\n  entry : UDINT;\n END_STRUCT; END_TYPE\n")
    write("old/log.fun", "FUNCTION_BLOCK logRead\nVAR_INPUT enable : BOOL; END_VAR\nEND_FUNCTION_BLOCK\n")
    write("old/mixer.fun", "FUNCTION_BLOCK Mixer\nVAR_INPUT on : BOOL; END_VAR\nVAR inner : UDINT; END_VAR\nEND_FUNCTION_BLOCK\n")
    said = run("check", "old")
    assert "'inner' is declared and never used" not in said, "the body of a binary library is not here"
    assert said.splitlines()[0] == "ok  old" and "'logRead' differs from 'LogRead' in capitals alone" in said, said
    wrong = write("wrong.var", "VAR\n  pins : STRING := (0);\nEND_VAR\n")
    assert "expected STRING, found a whole number" in run("check", wrong, code=2)
    wrong = write("wrong.st", "FUNCTION_BLOCK B\nVAR_INPUT to : UDINT; END_VAR\nEND_FUNCTION_BLOCK\n")
    assert "'to' is a word of the language, not a name" in run("check", wrong, code=2)


def check_binary_libraries():
    """What Automation Studio only declares of a library is meant as it is here; what is not here is told once for all of it."""
    lists = '<?xml version="1.0"?>\n<Library SubType="binary" xmlns="http://br-automation.co.at/AS/Library"><Files><File>{}.fun</File></Files></Library>\n'
    declared = {
        "standard": "{REDUND_OK} FUNCTION_BLOCK TON\n\tVAR_INPUT\n\t\tIN : BOOL;\n\t\tPT : TIME;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tQ : BOOL;\n"
                    "\tEND_VAR\n\tVAR\n\t\tStartTime : TIME;\n\tEND_VAR\nEND_FUNCTION_BLOCK\nFUNCTION LEN : INT\n\tVAR_INPUT\n\t\tIN : STRING[32767];\n"
                    "\tEND_VAR\nEND_FUNCTION\n",
        "AsIecCon": "FUNCTION REAL_TO_INT : INT\n\tVAR_INPUT\n\t\tIN : REAL;\n\tEND_VAR\nEND_FUNCTION\n",
        "AsBrStr": "FUNCTION brsmemset : UDINT\n\tVAR_INPUT\n\t\tpDest : UDINT;\n\t\tvalue : USINT;\n\t\tlength : UDINT;\n\tEND_VAR\nEND_FUNCTION\n",
        "McAxis": "FUNCTION_BLOCK MC_Power\n\tVAR_INPUT\n\t\tAxis : REFERENCE TO McAxisType;\n\t\tEnable : BOOL;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n"
                  "FUNCTION_BLOCK MC_BR_Reset\n\tVAR_INPUT\n\t\tExecute : BOOL;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n"
                  "FUNCTION_BLOCK FRM_write\n\tVAR_INPUT\n\t\tenable : BOOL;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tstatus : UINT;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n"
                  "FUNCTION_BLOCK MC_BR_NotUsed\n\tVAR_INPUT\n\t\tExecute : BOOL;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n",
        "McBase": "FUNCTION_BLOCK MC_BR_Other\nEND_FUNCTION_BLOCK\n",
        "FileIO": "FUNCTION_BLOCK FileClose\n\tVAR_INPUT\n\t\tenable : BOOL;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n"}
    for name, text in declared.items():
        write(f"Binary/Logical/Libraries/{name}/{'Binary' if name == 'standard' else 'binary'}.lby", lists.format(name))
        write(f"Binary/Logical/Libraries/{name}/{name}.fun", text)
    write("Binary/Logical/Libraries/McBase/McBase.typ", "TYPE\n\tMcAxisType : STRUCT\n\t\tcontrolif : REFERENCE TO McInternal;\n\tEND_STRUCT;\nEND_TYPE\n")
    write("Binary/Logical/Libraries/FileIO/binary.lby", lists.format("FileIO").replace("</Files>", "<File>FileIO.var</File></Files>"))
    write("Binary/Logical/Libraries/FileIO/FileIO.var", "VAR CONSTANT\n\tfiERR_EXIST : UINT := 20705;\n\tfiOWN : UINT := 1;\nEND_VAR\n")
    write("Binary/Logical/P/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Main.st</File><File>Variables.var</File></Files></Program>\n")
    write("Binary/Logical/P/Variables.var", "VAR\n\tt : TON := (0);\n\taxis : McAxisType;\n\tpower : MC_Power;\n\treset : MC_BR_Reset;\n\tframe : FRM_write;\n\ti, n, filled : INT;\n\texists : UINT;\nEND_VAR\n")
    write("Binary/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tt(IN := TRUE, PT := T#10ms);\n\tIF t.Q THEN n := n + 1; END_IF\n\ti := REAL_TO_INT(42.0) + LEN('abc');\n"
          "\texists := fiERR_EXIST + fiOWN;\n\tbrsmemset(ADR(filled), 1, SIZEOF(filled));\n\tpower(Axis := ADR(axis), Enable := TRUE);\n\treset();\n\tframe(enable := TRUE);\nEND_PROGRAM\n")
    said = run("check", "Binary")
    assert said.splitlines()[0] == "ok  Binary" and said.count("warning") == 1, said
    assert "of the library 'McAxis' there are declarations alone, so this does nothing: MC_BR_Reset, FRM_write" in said, said
    run("new", "binary", "--from", "Binary")
    write("binary.yaml", (work / "binary.yaml").read_text() + "expect:\n  - {at: 95 ms, P.n: 9}\n  - {at: 95 ms, P.i: 45}\n  - {at: 95 ms, P.filled: 257}\n  - {at: 95 ms, P.exists: 20706}\n  - {at: 95 ms, P.frame.status: 9999}\n")
    run("run", "binary.yaml", "--quiet")


def check_addresses():
    """An address is a UDINT in Automation Studio: programs keep it, reckon with it, give it to functions and refer to what is there."""
    program = ('<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
               "<File>Variables.var</File><File>Main.st</File></Files></Program>\n")
    write("Addresses/Logical/P/IEC.prg", program)
    write("Addresses/Logical/Libraries/AsBrStr/binary.lby",
          '<?xml version="1.0"?>\n<Library SubType="binary" xmlns="http://br-automation.co.at/AS/Library"><Files><File>AsBrStr.fun</File></Files></Library>\n')
    write("Addresses/Logical/Libraries/AsBrStr/AsBrStr.fun",
          "FUNCTION brsstrcpy : UDINT\n\tVAR_INPUT\n\t\tpDest : UDINT;\n\t\tpSrc : UDINT;\n\tEND_VAR\nEND_FUNCTION\n"
          "FUNCTION brsstrcat : UDINT\n\tVAR_INPUT\n\t\tpDest : UDINT;\n\t\tpSrc : UDINT;\n\tEND_VAR\nEND_FUNCTION\n")
    write("Addresses/Logical/Types.typ", "TYPE\n\tBelt_type : STRUCT\n\t\tspeed : REAL;\n\t\tcount : UINT;\n\tEND_STRUCT;\nEND_TYPE\n")
    write("Addresses/Logical/Lib/IEC.lby", '<?xml version="1.0"?>\n<Library SubType="IEC" xmlns="http://br-automation.co.at/AS/Library"><Files>'
          "<File>Lib.fun</File><File>count.st</File></Files></Library>\n")
    write("Addresses/Logical/Lib/Lib.fun", "FUNCTION countOne : UINT\n\tVAR_INPUT\n\t\tpBelt : UDINT;\n\tEND_VAR\n\tVAR\n"
          "\t\tbelt : REFERENCE TO Belt_type;\n\t\tedge : R_TRIG;\n\tEND_VAR\nEND_FUNCTION\n")
    write("Addresses/Logical/Lib/count.st", "FUNCTION countOne\n\tIF pBelt = 0 THEN\n\t\tcountOne := 65535;\n\t\tRETURN;\n\tEND_IF\n"
          "\tbelt ACCESS pBelt;\n\tedge(CLK := TRUE);\n\tIF edge.Q THEN belt.count := belt.count + LEN('a'); END_IF\n\n\tcountOne := belt.count;\nEND_FUNCTION\n")
    write("Addresses/Logical/P/Variables.var", "VAR CONSTANT\n\tMOST : USINT := 3;\nEND_VAR\nVAR\n\tbelt : Belt_type;\n\tname : STRING[80];\n"
          "\tn, none, bits : UINT;\n\taddress, third : UDINT;\n\trow : ARRAY[0..2] OF UINT := [MOST(7)];\n\tvalue : REFERENCE TO UINT;\n\tis_set, is_named : BOOL;\nEND_VAR\n")
    main = ("PROGRAM _CYCLIC\n\taddress := ADR(belt);\n\tn := countOne(address);\n\tnone := countOne(0);\n\tbrsstrcpy(ADR(name), ADR('belt'));\n"
            "\tbrsstrcat(ADR(name), ADR(' 1'));\n\tthird := ADR(row) + 2 * SIZEOF(row[0]);\n\tvalue ACCESS third;\n\tvalue := value + 1;\n"
            "\tbits := 255;\n\tbits := BIT_SET(BIT_CLR(bits, 0), 8);\n\tis_set := BIT_TST(bits, 8) AND NOT BIT_TST(bits, 0);\n\tis_named := name = 'belt 1';\nEND_PROGRAM\n")
    write("Addresses/Logical/P/Main.st", main)
    assert run("check", "Addresses").splitlines()[0] == "ok  Addresses"
    run("new", "addresses", "--from", "Addresses")
    text = (work / "addresses.yaml").read_text()
    write("addresses.yaml", text + "expect:\n  - {at: 95 ms, P.belt.count: 10}\n  - {at: 95 ms, P.n: 10}\n  - {at: 95 ms, P.none: 65535}\n"
          "  - {at: 95 ms, 'P.row[0]': 7}\n  - {at: 95 ms, 'P.row[2]': 17}\n  - {at: 95 ms, P.is_named: true}\n  - {at: 95 ms, P.bits: 510}\n  - {at: 95 ms, P.is_set: true}\n")
    run("run", "addresses.yaml", "--quiet")
    for wrong, fault in (("value ACCESS third + 2;", "outside_of_variable"), ("value ACCESS third + 16#100000;", "no_reference"),
                         ("value ACCESS third - third;", "no_reference")):
        write("Addresses/Logical/P/Main.st", main.replace("value ACCESS third;", wrong))
        said = run("run", "addresses.yaml", "--quiet", code=3)
        assert fault in said and "Main.st:9" in said, said


# What B&R's manual TM251 says: the value of AsBrStr's functions is the address behind what was written.
MEMORY_OF_BR = """TYPE S : STRUCT a : INT; s : STRING[10]; END_STRUCT; END_TYPE
TYPE Mode : (STOP, GO); END_TYPE
FUNCTION_BLOCK Base
VAR_INPUT e : BOOL; p : REFERENCE TO S; END_VAR
VAR c : INT; mode : Mode; text : STRING[300]; list : ARRAY[0..99] OF S; t : TON; END_VAR
VAR_OUTPUT is_bound : BOOL; END_VAR
c := c + 1;
is_bound := p <> 0;
t(IN := e, PT := T#1s);
END_FUNCTION_BLOCK
FUNCTION_BLOCK User
VAR_INPUT p : REFERENCE TO S; END_VAR
VAR_OUTPUT o : INT; END_VAR
o := p.a;
END_FUNCTION_BLOCK
TEST 'memory, one behind the other'
VAR Memory : ARRAY[0..99] OF BYTE; Value : USINT := 252; NextAdr : UDINT; s : ARRAY[0..2] OF USINT := [1, 2, 3]; END_VAR
NextAdr := brsmemset(ADR(Memory), Value, 50);
NextAdr := brsmemset(NextAdr, 12, 25);
ASSERT_EQ(Memory[49], 252); ASSERT_EQ(Memory[50], 12); ASSERT_EQ(Memory[74], 12); ASSERT_EQ(Memory[75], 0);
NextAdr := brsmemmove(brsmemcpy(NextAdr, ADR(s), 3), ADR(s), 2);
ASSERT_EQ(Memory[77], 3); ASSERT_EQ(Memory[78], 1); ASSERT_EQ(Memory[80], 0);
ASSERT_EQ(NextAdr - ADR(Memory), 80);
END_TEST
TEST 'texts, one behind the other'
VAR s : STRING[20]; p : UDINT; END_VAR
p := brsstrcpy(ADR(s), ADR('ab'));
p := brsstrcpy(p, ADR('cd'));
ASSERT_EQ(s, 'abcd');
p := brsstrcat(ADR(s), ADR('ef'));
brsstrcpy(p, ADR('gh'));
ASSERT_EQ(s, 'abcdefgh');
END_TEST
TEST 'an instance becomes zero'
VAR x : Base; n : S; END_VAR
x.mode := GO; x.text := 'abc'; x.list[99].a := 3; x.list[99].s := 'd'; x.p := ADR(n);
x(e := TRUE);
ASSERT_TRUE(x.is_bound); ASSERT_TRUE(x.t.IN);
brsmemset(ADR(x), 0, SIZEOF(x));
ASSERT_EQ(x.c, 0); ASSERT_EQ(x.mode, STOP); ASSERT_EQ(x.text, ''); ASSERT_EQ(x.list[99].a, 0); ASSERT_EQ(x.list[99].s, '');
ASSERT_FALSE(x.t.IN); ASSERT_EQ(x.t.PT, T#0s); ASSERT_FALSE(x.is_bound);
x();
ASSERT_FALSE(x.is_bound); ASSERT_EQ(x.c, 1);
END_TEST
TEST 'an address that is kept as a number goes to a pin that is a reference'
VAR f : User; x : S; u : UDINT; END_VAR
x.a := 5; u := ADR(x); f.p := u; f(); ASSERT_EQ(f.o, 5);
END_TEST
TEST 'distances of addresses'
VAR s : STRING[20]; p, n : UDINT; END_VAR
p := ADR(s) + 2; n := p - ADR(s); ASSERT_EQ(n, 2);
END_TEST
TEST 'timers of 10 ms, and both edges'
VAR on : TON_10ms; off : TOF_10ms; pulse : TP_10ms; edge : RF_TRIG; END_VAR
on(IN := TRUE, PT := 5); off(IN := TRUE, PT := 5); off(IN := FALSE); pulse(IN := TRUE, PT := 5); edge(CLK := TRUE);
ASSERT_FALSE(on.Q); ASSERT_TRUE(off.Q); ASSERT_TRUE(pulse.Q); ASSERT_TRUE(edge.Q);
ADVANCE_TIME(T#40ms);
on(); off(); pulse(); edge();
ASSERT_FALSE(on.Q); ASSERT_TRUE(off.Q); ASSERT_TRUE(pulse.Q); ASSERT_FALSE(edge.Q); ASSERT_EQ(on.ET, 4);
ADVANCE_TIME(T#10ms);
on(); off(); pulse(); edge(CLK := FALSE);
ASSERT_TRUE(on.Q); ASSERT_FALSE(off.Q); ASSERT_FALSE(pulse.Q); ASSERT_TRUE(edge.Q); ASSERT_EQ(on.ET, 5);
END_TEST
"""


def check_memory_of_br():
    path = write("br/memory_test.st", MEMORY_OF_BR)
    told = run("test", path, "--source-dialect", "automation_studio")
    assert "6 of 6 passed" in told, told
    path.write_text(MEMORY_OF_BR.replace("brsmemset(ADR(x), 0, SIZEOF(x))", "brsmemset(ADR(x), 1, SIZEOF(x))"))
    assert "outside_of_variable" in run("test", path, "--source-dialect", "automation_studio", code=1)
    library = "br_libraries/Logical/Libraries/"
    for name, declared in (("standard", "TON_10ms\n\tVAR_INPUT\n\t\tIN : BOOL;\n\t\tPT : UDINT;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tQ : BOOL;\n\t\tET : UDINT;"),
                           ("runtime", "rf_trig\n\tVAR_INPUT\n\t\tCLK : BOOL;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tQ : BOOL;")):
        write(f"{library}{name}/binary.lby", f'<?xml version="1.0"?>\n<Library SubType="binary" xmlns="http://br-automation.co.at/AS/Library"><Files><File>{name}.fun</File></Files></Library>\n')
        write(f"{library}{name}/{name}.fun", f"FUNCTION_BLOCK {declared}\n\tEND_VAR\nEND_FUNCTION_BLOCK\n")
    write("br_libraries/Logical/P/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Variables.var</File><File>Main.st</File></Files></Program>\n")
    write("br_libraries/Logical/P/Variables.var", "VAR\n\tt : TON_10ms;\n\tedge : rf_trig;\n\tdone : BOOL;\n\tedges : INT;\nEND_VAR\n")
    write("br_libraries/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tt(IN := TRUE, PT := 5);\n\tdone := t.Q;\n\tedge(CLK := done);\n\tIF edge.Q THEN edges := edges + 1; END_IF\nEND_PROGRAM\n")
    assert "does nothing" not in run("check", "br_libraries")
    run("new", "br_libraries", "--from", "br_libraries")
    text = (work / "br_libraries.yaml").read_text()
    write("br_libraries.yaml", text + "expect:\n  - {at: 45 ms, P.done: false}\n  - {at: 65 ms, P.done: true}\n  - {at: 95 ms, P.edges: 1}\n")
    run("run", "br_libraries.yaml", "--quiet")


def check_instruction_lists():
    """Bodies in IL of a text are read as those of PLCopen XML are, with places in the text."""
    plant = """FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
LD x
MUL 2
ST Twice
END_FUNCTION

FUNCTION_BLOCK Latch
VAR_INPUT on, off : BOOL; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
(* on goes before *)
LD off
R q
LD on
S q
END_FUNCTION_BLOCK

PROGRAM Main
VAR a : BOOL := TRUE; b, both, nested, above, late, passed, negated : BOOL; n, twice, most, jumped, rounds : INT; t : TON; latch : Latch; END_VAR
      LD a (* what is
              loaded *)
      ANDN b
      ST both
      LD b
      OR( a
      ANDN( both
      OR b
      )
      )
      ST nested
      LD 3
      ADD 4
      MUL 2
      ST n
      GT 13
      ST above
      STN negated
      LD n
      Twice
      ST twice
      LD n
      MAX 20
      ST most
      CAL t(IN := a, PT := T#20ms)
      LD t.Q
      ST late
      CAL latch(on := late,
                off := b)
      LD 0
      ST jumped
again: LD jumped
      ADD 1
      ST jumped
      LT 5
      JMPC again
      LD rounds
      ADD 1
      ST rounds
      LD late
      JMPCN behind
      LD TRUE
      ST passed
behind: LD a
      RETC
      LD 0
      ST n
END_PROGRAM

CONFIGURATION Config0
  RESOURCE Res0 ON PLC
    TASK slow(INTERVAL := T#10ms, PRIORITY := 0);
    PROGRAM line WITH slow : Main;
  END_RESOURCE
END_CONFIGURATION
"""
    path = write("instructions/plant.st", plant)
    assert run("check", path).startswith("ok"), run("check", path)
    run("new", "of_lists", "--from", path)
    write("of_lists.yaml", (work / "of_lists.yaml").read_text() + "expect:\n" + "".join(
        f"  - {{at: {at} ms, Main.{name}: {value}}}\n" for at, name, value in (
            (5, "both", "true"), (5, "nested", "false"), (5, "n", 14), (5, "above", "true"), (5, "negated", "false"), (5, "twice", 28), (5, "most", 20),
            (5, "late", "false"), (5, "passed", "false"), (35, "late", "true"), (35, "passed", "true"), (35, "latch.q", "true"), (35, "jumped", 5),
            (35, "rounds", 4))))
    run("run", "of_lists.yaml", "--quiet")
    write("instructions/old.EXP", "PROGRAM Old\nVAR n, m : INT; END_VAR\nLD n\nADD 1\nST n\nGE 3\nJMPCN behind\nLD 7\nST m\nbehind:\nLD m\nEND_PROGRAM\n"
          "ACTION Turn:\nLD n\nST m\nEND_ACTION\n\nPROGRAM Shorter\nLD TRUE\nJMPC away\nLD FALSE\naway:\nRET\nEND_PROGRAM\n")
    run("new", "old_lists", "--from", "instructions/old.EXP")
    write("old_lists.yaml", (work / "old_lists.yaml").read_text() + "expect:\n  - {at: 15 ms, Old.m: 0}\n  - {at: 25 ms, Old.m: 7}\n")
    run("run", "old_lists.yaml", "--quiet")
    wrong = write("instructions/wrong.st", plant.replace("ANDN b\n      ST both", "ANDN bb\n      ST both"))
    said = run("check", wrong, code=2)
    assert "wrong.st:22:12: error[L0904]: 'bb' is not declared" in said, said
    wrong = write("instructions/wrong.st", plant.replace("      )\n      )", "      )"))
    assert "error[L0903]: this list has a '(' without a ')'" in run("check", wrong, code=2)


def check_editors_of_matiec():
    """Texts without quotes, and points of a bus, as the editors of Beremiz and OpenPLC keep them; CODESYS' lists of several kinds."""
    variables = ('<variable name="{}"{}><type><{}/></type>{}</variable>')
    begun = '<initialValue><simpleValue value="{}"/></initialValue>'
    interface = "<localVars>" + "".join(
        variables.format(*row) for row in (("plain", "", "string", begun.format("hello")), ("quoted", "", "string", begun.format("'ab'")),
                                           ("wide", "", "wstring", begun.format("a b c")), ("n", "", "INT", ""), ("of_wide", "", "INT", ""),
                                           ("first", ' address="%QW0.1.0.0"', "WORD", ""), ("second", ' address="%QW0.0.8192.0"', "WORD", ""))) + "</localVars>"
    write("editors/plc.xml", '<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201"><fileHeader companyName="Beremiz"/><types><dataTypes/><pous>'
          f'<pou name="Main" pouType="program"><interface>{interface}</interface><body><ST><xhtml:p><![CDATA[n := LEN(plain) + LEN(quoted);'
          "of_wide := LEN(wide); first := 3; second := first + 1;]]></xhtml:p></ST></body></pou></pous></types><instances/></project>\n")
    run("new", "of_editors", "--from", "editors/plc.xml")
    write("of_editors.yaml", (work / "of_editors.yaml").read_text() + "expect:\n  - {at: end, Main.n: 7}\n  - {at: end, Main.of_wide: 5}\n"
          "  - {at: end, Main.second: 4}\n")
    run("run", "of_editors.yaml", "--quiet")
    for name in ("Main.st", "with_scada.st"):
        write(f"editors/{name}", "PROGRAM Main\n  VAR n : INT; END_VAR\n  n := 1;\nEND_PROGRAM\n\n\nCONFIGURATION Config0\n\n  RESOURCE Res0 ON PLC\n"
              "    TASK task0(INTERVAL := T#20ms,PRIORITY := 0);\n    PROGRAM instance0 WITH task0 : Main;\n  END_RESOURCE\nEND_CONFIGURATION\n")
    assert run("check", "editors").startswith("ok"), "what an editor generates of its plc.xml"
    for name in ("plc.st", "generated_plc.st"):
        shutil.copy(work / "editors/Main.st", write(f"generated/{name}", ""))
    write("generated/plc.st", (work / "generated/plc.st").read_text() + "FUNCTION twice : INT\n  VAR_INPUT x : INT; END_VAR\n  twice := 2 * x;\nEND_FUNCTION\n")
    assert run("check", "generated").startswith("ok"), "generated_plc.st is what plc.st begins with"
    listed = '<globalVars name="G"{}><variable name="{}"><type><INT/></type>' + begun.format(3) + "</variable></globalVars>"
    write("mixed.xml", '<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0200"><fileHeader productName="CODESYS"/><types><dataTypes/><pous>'
          '<pou name="P" pouType="program"><interface><localVars><variable name="a"><type><array><dimension lower="1" upper="MOST"/><baseType><INT/></baseType>'
          "</array></type></variable></localVars></interface><body><ST><xhtml>a[MOST] := one;</xhtml></ST></body></pou></pous></types><instances/><addData>"
          '<data name="http://www.3s-software.com/plcopenxml/globalvars"><globalVars name="G"><variable name="one"><type><INT/></type></variable>'
          '<variable name="MOST"><type><INT/></type></variable><addData><data name="http://www.3s-software.com/plcopenxml/mixedattrsvarlist"><MixedAttrsVarList>'
          + listed.format("", "one") + listed.format(' constant="true"', "MOST") + "</MixedAttrsVarList></data></addData></globalVars></data></addData></project>\n")
    assert run("check", "mixed.xml").startswith("ok"), "a list with constants among its variables"
    write("old.il", "LD a\n")
    assert "this is an instruction list, which is not read" in run("check", "old.il", code=2)


def check_prefix():
    """Names with a prefix are those of its namespace."""
    plain = drawn(RUNG)
    prefixed = re.sub(r"<(/?)(?=[a-zA-Z])", r"<\1ppx:", plain).replace("xmlns=", "xmlns:ppx=")
    assert "<ppx:project xmlns:ppx=" in prefixed, prefixed
    write("prefixed/plc.xml", prefixed)
    assert run("check", "prefixed/plc.xml").startswith("ok"), "a namespace with a prefix"
    run("new", "prefixed/made", "--from", "prefixed/plc.xml")
    assert "type: P," in (work / "prefixed/made.yaml").read_text()


def check_yaml_folder():
    program = ("lineshaft: 1\ntitle: t\ntasks: {main: {every: 10 ms}}\nblocks: {x: {type: axis, task: main}}\n"
               "run: {for: 20 ms}\n")
    write("one/a.yaml", program)
    assert run("check", "one") == "ok  one: 1 file\n"
    write("one/b.yaml", program)
    assert run("check", "one") == "ok  one: 2 files\n"
    write("one/c.yaml", program.replace("type: axis", "type: axes"))
    assert "one/c.yaml:4:" in run("check", "one", code=2)


def check_names_of_types():
    """A type is in quotes where YAML needs them; blocks of two types have two names."""
    for at, name in enumerate(("Main [OB1]", "Main: x", "Main, 2", "Main #1", "{x}", "it's", "Größe")):
        write(f"names{at}.scl", f'ORGANIZATION_BLOCK "{name}"\nVERSION : 0.1\nVAR_TEMP a : Int; END_VAR\nBEGIN\n #a := 1;\nEND_ORGANIZATION_BLOCK\n')
        run("new", f"names{at}", "--from", f"names{at}.scl")
        run("run", "--quiet", f"names{at}.yaml")
    write("alike.st", "".join(f"FUNCTION_BLOCK {name}\nVAR_OUTPUT n : INT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n"
                              for name in ("Abc_X", "AbcX", "RF_TRIG", "rf__trig", "rfTrig")))
    run("new", "alike", "--from", "alike.st")
    run("run", "--quiet", "alike.yaml")


def check_dialects():
    """What a file in .st says by its text, by the option, and by the program that is written around it."""
    source = "PROGRAM Main\nVAR a : ARRAY[3..REAL_TO_INT(2.5)] OF INT; END_VAR\nEND_PROGRAM\n"
    write("said.st", source)
    run("check", "said.st", code=2)
    run("check", "said.st", "--source-dialect", "codesys")
    assert "--source-dialect" in run("check", "said.st", "--source-dialect", "pascal", code=2)
    run("new", "said", "--from", "said.st", "--source-dialect", "codesys")
    assert "\ndialect: codesys\n" in (work / "said.yaml").read_text()
    run("run", "said.yaml", "--quiet")
    write("marked.st", "{attribute 'qualified_only'}\nVAR_GLOBAL g : INT; END_VAR\n" + source)
    run("check", "marked.st")
    run("check", "marked.st", "--source-dialect", "iec", code=2)


def check_neighbours():
    """Programs beside each other that share names: each is checked with what is nearest to it."""
    def export(name, program, text):
        write(f"exports/{name}.xml", f'<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous>'
              f'<pou name="{program}" pouType="program"><interface><localVars><variable name="n"><type><derived name="Count"/></type></variable>'
              f"</localVars></interface>{st(text)}</pou></pous><dataTypes><dataType name='Count'><baseType><INT/></baseType></dataType>"
              "</dataTypes></types></project>\n")
    export("first", "Main", "n := n + 1;")
    export("second", "Main", "n := n + 2;")
    said = run("check", "exports")
    assert said.startswith("ok  exports\n") and "declared twice, in programs that are checked apart" in said, said
    assert "error[L0909]" in run("check", "--strict", "exports", code=2)
    export("third", "Main", "n := Missing(n);")
    said = run("check", "exports", code=2)
    assert "exports/third.xml" in said and "exports/first.xml:" not in said and "error[L0909]" not in said, said

    write("exports/editor/plc.xml", (work / "exports/first.xml").read_text())
    write("exports/editor/build/program.st", "PROGRAM Main\nn := 1;\nEND_PROGRAM\n")
    assert run("check", "exports/editor").startswith("ok  exports/editor")

    for name, kind in (("one", "INT"), ("two", "BOOL")):
        write(f"examples/{name}/PLC_PRG.st", "PROGRAM PLC_PRG\nVAR t : Thing; x : Shared; END_VAR\nt.value := "
              + ("1" if kind == "INT" else "TRUE") + ";\nx := 3;\nEND_PROGRAM\n")
        write(f"examples/{name}/Thing.st", f"TYPE Thing : STRUCT value : {kind}; END_STRUCT END_TYPE\n")
    write("examples/Shared.st", "TYPE Shared : INT; END_TYPE\n")
    assert run("check", "examples").startswith("ok  examples\n")
    write("examples/two/More.st", "FUNCTION More : BOOL\nMore := 5;\nEND_FUNCTION\nPROGRAM PLC_PRG\nEND_PROGRAM\n")
    said = run("check", "examples", code=2)
    assert "examples/two/More.st:2:9: error[L0905]" in said and "examples/two/PLC_PRG.st:1:9: error[L0909]" in said, said
    assert said.count("is declared twice") == 1 and "examples/one" not in said, said

    for name, last in (("a", "Up"), ("b", "Left, Right")):
        value = last.split(", ")[-1]
        write(f"flat/{name}.st", f"TYPE St : (Idle, {last}); END_TYPE\nPROGRAM Main\nVAR s : St; END_VAR\ns := St#{value};\nEND_PROGRAM\n")
        write(f"flat/{name}_test.st", f"TEST 'of {name}' VAR m : Main; END_VAR m(); ASSERT_TRUE(m.s = St#{value}); END_TEST\n")
        write(f"flat/alone_{name}.st", "PROGRAM Alone\nVAR n : INT; END_VAR\nn := n + 1;\nEND_PROGRAM\n")
    for said in (run("check", "flat"), run("check", "flat/a.st", "flat/b.st")):
        assert "flat/b.st:1:6: warning[L0909]" in said and "error" not in said, said
    assert "flat/alone_b.st:1:9: warning[L0909]" in run("check", "flat")
    run("test", "flat")
    write("flat/c.st", (work / "flat/a.st").read_text().replace("#Up", "#Right"))
    said = run("check", "flat", code=2)
    assert "flat/c.st:4:9: error[L0904]" in said and said.count("error[") == 1, said


def check_standard_xml():
    """XML of IEC 61131-10: types, lists, bodies in ST and ladders, and a body that is not read."""
    def variable(name, type_, more=""):
        return f'<Variable name="{name}"><Type><TypeName>{type_}</TypeName></Type>{more}</Variable>'

    def rung(*elements):
        return "<Rung>" + "".join(elements) + "</Rung>"

    def point(tag, numbers):
        lines = "".join(f'<Connection refConnectionPointOutId="{n}"/>' for n in numbers)
        return f"<ConnectionPointIn>{lines}</ConnectionPointIn>" if tag == "in" else f'<ConnectionPointOut connectionPointOutId="{numbers[0]}"/>'

    def ladder(kind, more, come, go):
        return (f'<LdObject xsi:type="{kind}" {more}>' + (point("in", come) if come else "") + (point("out", go) if go else "") + "</LdObject>")

    timer = ('<FbdObject xsi:type="DataSource" identifier="T#20ms">' + point("out", [3]) + "</FbdObject>"
             '<FbdObject xsi:type="Block" typeName="TON" instanceName="timer"><InputVariables><InputVariable parameterName="In">' + point("in", [2])
             + '</InputVariable><InputVariable parameterName="PT">' + point("in", [3]) + "</InputVariable></InputVariables><OutputVariables>"
             '<OutputVariable parameterName="Q">' + point("out", [4]) + "</OutputVariable></OutputVariables></FbdObject>")
    rungs = (rung(ladder("LeftPowerRail", "", [], [1]), ladder("Contact", 'operand="start"', [1], [2]), timer,
                  ladder("Coil", 'operand="late"', [4], [5]), ladder("RightPowerRail", "", [5], []))
             + rung(ladder("LeftPowerRail", "", [], [1]), ladder("Contact", 'negated="true" operand="late"', [1], [2]),
                    ladder("Contact", 'operand="start"', [1], [3]), ladder("Coil", 'operand="early"', [2, 3], [5]), ladder("RightPowerRail", "", [5], [])))

    def project(bodies):
        return ('<?xml version="1.0" encoding="utf-8"?>\n<Project xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:smcext="https://www.ia.omron.com/Smc"'
                ' xmlns="www.iec.ch/public/TC65SC65BWG7TF10" schemaVersion="1">\n<FileHeader companyName="OMRON"/>\n<Types><GlobalNamespace>\n'
                '<DataTypeDecl name="Mode"><UserDefinedTypeSpec xsi:type="EnumTypeWithNamedValueSpec"><Enumerator name="Idle" value="0"/>'
                '<Enumerator name="Busy" value="4"/><BaseType>DINT</BaseType></UserDefinedTypeSpec></DataTypeDecl>\n'
                '<DataTypeDecl name="Record"><UserDefinedTypeSpec xsi:type="StructTypeSpec"><Member name="mode"><Type><TypeName>Mode</TypeName></Type></Member>'
                '<Member name="list"><Type><InstantlyDefinedType xsi:type="ArrayTypeSpec"><BaseType><TypeName>INT</TypeName></BaseType>'
                '<DimensionSpec dimensionNumber="1"><IndexRange lower="1" upper="3"/></DimensionSpec></InstantlyDefinedType></Type></Member>'
                '<Member name="part"><Type><TypeName><![CDATA[Common\\Part]]></TypeName></Type></Member></UserDefinedTypeSpec></DataTypeDecl>\n'
                '<NamespaceDecl name="Common"><DataTypeDecl name="Part"><UserDefinedTypeSpec xsi:type="StructTypeSpec"><Member name="text"><Type>'
                "<TypeName>STRING[9]</TypeName></Type></Member></UserDefinedTypeSpec></DataTypeDecl></NamespaceDecl>\n"
                '<Function name="Twice"><ResultType><TypeName>INT</TypeName></ResultType><Parameters><InputVars>' + variable("x", "INT")
                + '</InputVars></Parameters><MainBody><BodyContent xsi:type="ST"><ST>Twice := 2 * x;</ST></BodyContent></MainBody></Function>\n'
                '<Program name="Main"><ExternalVars>' + variable("total", "INT") + "</ExternalVars><Vars>"
                + variable("n", "INT", '<InitialValue><SimpleValue value="5"/></InitialValue>') + variable("r", "Record")
                + "".join(variable(name, "BOOL") for name in ("start", "late", "early")) + variable("timer", "TON")
                + "</Vars><MainBody>" + bodies + "</MainBody></Program>\n</GlobalNamespace></Types>\n"
                '<Instances><Configuration name="C"><Resource name="R"><GlobalVars>' + variable("total", "INT") + "</GlobalVars></Resource></Configuration></Instances></Project>\n")

    def statements(text):
        return f'<BodyContent xsi:type="ST"><ST>{text}</ST></BodyContent>'

    steps = "IF n &lt; 7 AND n &gt; 0 THEN\n n := n + 1;\nEND_IF;\nstart := TRUE; total := Twice(n);\nr.list[3] := n; r.mode := Mode#Busy; r.part.text := 'a';\n"
    write("standard.xml", project(statements(steps) + f'<BodyContent xsi:type="smcext:LdSection" name="s">{rungs}</BodyContent>'))
    run("check", "standard.xml")
    run("new", "standard", "--from", "standard.xml")
    text = (work / "standard.yaml").read_text()
    expected = (("5 ms", "Main.late", "false"), ("5 ms", "Main.early", "true"), ("end", "Main.n", 7), ("end", "'Main.r.list[3]'", 7),
                ("end", "Main.late", "true"), ("end", "Main.early", "true"))
    write("standard.yaml", text.split("run:")[0] + "run: {for: 100 ms}\nexpect:\n"
          + "".join(f"  - {{at: {at}, {signal}: {value}}}\n" for at, signal, value in expected))
    run("run", "standard.yaml", "--quiet")
    write("standard.xml", project(statements("n := missing;") + '<BodyContent xsi:type="SFC"/>'))
    said = run("check", "standard.xml", code=2)
    assert "standard.xml:9:657" in said and "'missing' is not declared" in said and "this body of 'Main' is in SFC" in said, said


def check_foreign_files():
    """Files of tools that are not read: which tool, and what to do; and what else is in a folder."""
    write("foreign/plant.L5X", "<RSLogix5000Content/>\n")
    write("foreign/save.zap17", b"PK\3\4\0\1")
    for name, tool in (("plant.L5X", "Rockwell"), ("save.zap17", "TIA Portal")):
        assert tool in run("check", f"foreign/{name}", code=2)
        assert tool in run("new", "x", "--from", f"foreign/{name}", code=2)
    said = run("check", "foreign", code=2)
    assert "1 .L5X (a file of Rockwell's" in said and "1 .zap17" in said, said
    source = "PROGRAM Main\nVAR x : INT; END_VAR\nx := x + 1;\nEND_PROGRAM\n"
    for ending in ("st", "plc", "STL", "structuredtext"):
        write(f"endings/main.{ending}", source)
        run("check", f"endings/main.{ending}")
    write("foreign/main.st", source)
    assert "are not read: 1 .L5X" in run("check", "foreign")
    write("endings/main.code", source)
    assert "give its name the ending .st" in run("check", "endings/main.code", code=2)
    write("endings/notes.md", "# Notes\n")
    assert "this is neither a program nor a source" in run("check", "endings/notes.md", code=2)


def check_nothing():
    write("nothing/below/notes.txt", "no source\n")
    assert "there is no source of a controller in 'nothing'" in run("check", "nothing", code=2)
    write("nothing/below/history.db", b"SQLite format 3\0\1")
    write("nothing/below/Thumbs.db", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0")
    write("nothing/below/packages.db", "INSTALLED.DB 3\n")
    write("nothing/below/Library.exp", b"d\x86\x02\0\x9c\xf1\x05\0")
    assert "there is no source of a controller in 'nothing'" in run("check", "nothing", code=2)
    assert "the file is not a text" in run("check", "nothing/below/history.db", code=2)


def check_automation_studio():
    program = ('<?xml version="1.0" encoding="utf-8"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program">\n <Files>\n'
               + "".join(f"  <File{more}>{name}</File>\n" for name, more in
                         (("Variables.var", ""), ("Init.st", ""), ("Cyclic.st", ""), ("Actions.st", ""), ("Exit.st", ""), ("Types.typ", "")))
               + " </Files>\n</Program>\n")
    write("Plant/Logical/Belt/IEC.prg", program)
    write("Plant/Logical/Belt/Variables.var", "VAR\n\tstate : State_type;\n\tn, started, digits : INT;\n\tlist : ARRAY[0..1] OF INT;\nEND_VAR\n")
    write("Plant/Logical/Belt/Types.typ", "TYPE\n\tState_type : (WAIT, GO);\nEND_TYPE\n")
    write("Plant/Logical/Belt/Init.st", "PROGRAM _INIT\n\tstarted := started + 1;\nEND_PROGRAM\n")
    write("Plant/Logical/Belt/Cyclic.st", "PROGRAM _CYCLIC\n\tcount;\n\tstate := GO;\n\tlist[0];\n"
          "\tdigits := LEN(INT_TO_STRING(5));\nEND_PROGRAM\n")
    write("Plant/Logical/Belt/Actions.st", "ACTION count:\n\tn := n + 1;\nEND_ACTION\n")
    write("Plant/Logical/Belt/Exit.st", "PROGRAM _EXIT\n\tn := 0;\nEND_PROGRAM\n")
    write("Plant/Logical/Other/IEC.prg", program.replace("<File>", '<File Reference="true">\\Logical\\Belt\\'))
    run("check", "Plant")
    run("new", "belt", "--from", "Plant")
    text = (work / "belt.yaml").read_text()
    assert "Belt: {type: Belt," in text and "Other: {type: Other," in text, text
    write("belt.yaml", text + "expect:\n  - {at: end, Belt.n: 101}\n  - {at: end, Belt.started: 1}\n  - {at: end, Belt.digits: 1}\n  - {at: end, Other.n: 101}\n")
    run("run", "belt.yaml", "--quiet")
    write("Plant/Logical/Second/IEC.prg", program)
    for name, type_ in (("Variables.var", "VAR\n\tstate : State_type;\n\tn, started : INT;\nEND_VAR\n"), ("Init.st", ""),
                        ("Types.typ", "TYPE\n\tState_type : (STOP, TURN);\nEND_TYPE\n"), ("Exit.st", ""), ("Actions.st", ""),
                        ("Cyclic.st", "PROGRAM _CYCLIC\n\tstate := TURN;\nEND_PROGRAM\n")):
        write(f"Plant/Logical/Second/{name}", type_)
    run("check", "Plant")
    write("Plant/Logical/Belt/Cyclic.st", "PROGRAM _CYCLIC\n\tcount;\n\tmissing := GO;\nEND_PROGRAM\n")
    assert "Plant/Logical/Belt/Cyclic.st:3:2: error[L0904]: 'missing' is not declared" in run("check", "Plant", code=2)


def check_programs_with_packages():
    """A program of Automation Studio may list objects: files, and packages of files; its own functions stand in any of them."""
    def listed(root, *objects):
        return (f'<?xml version="1.0"?>\n<{root}>\n <Objects>\n'
                + "".join(f'  <Object Type="{kind}"{more}>{name}</Object>\n' for kind, name, more in objects) + f" </Objects>\n</{root.split()[0]}>\n")
    private = ' Private="true"'
    write("Nested/Logical/Belt/IEC.prg", listed('Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"', ("File", "Main.st", ""),
          ("File", "Belt.var", private), ("File", "Belt.fun", private), ("Package", "Steps", ' Description="x"')))
    write("Nested/Logical/Belt/Steps/Package.pkg", listed("Package", ("File", "Go.st", ""), ("File", "Go.typ", private), ("Package", "Deep", ""), ("Package", "..\\Steps", "")))
    write("Nested/Logical/Belt/Steps/Deep/Package.pkg", listed("Package", ("File", "Stop.st", "")))
    write("Nested/Logical/Belt/Belt.var", "VAR\n\tn, stops : INT;\n\tstep : Step_type;\nEND_VAR\n")
    write("Nested/Logical/Belt/Belt.fun", "FUNCTION Doubled : INT\n\tVAR_INPUT\n\t\tx : INT;\n\tEND_VAR\nEND_FUNCTION\n")
    write("Nested/Logical/Belt/Main.st", "PROGRAM _CYCLIC\n\tgo;\n\tstop;\nEND_PROGRAM\n")
    write("Nested/Logical/Belt/Steps/Go.typ", "TYPE\n\tStep_type : (WAIT, RUN);\nEND_TYPE\n")
    write("Nested/Logical/Belt/Steps/Go.st", "ACTION go:\n\tn := Doubled(4);\n\tstep := RUN;\nEND_ACTION\n\nFUNCTION Doubled\n\tDoubled := 2 * x;\nEND_FUNCTION\n")
    write("Nested/Logical/Belt/Steps/Deep/Stop.st", "ACTION stop:\n\tstops := stops + 1;\nEND_ACTION\n")
    assert run("check", "Nested").splitlines()[0] == "ok  Nested"
    run("new", "nested", "--from", "Nested")
    write("nested.yaml", (work / "nested.yaml").read_text() + "expect:\n  - {at: end, Belt.n: 8}\n  - {at: end, Belt.stops: 101}\n  - {at: end, Belt.step: RUN}\n")
    run("run", "nested.yaml", "--quiet")
    write("Nested/Logical/Belt/Steps/Deep/Stop.st", "ACTION stop:\n\tmissing := 1;\nEND_ACTION\n")
    assert "Steps/Deep/Stop.st:2:2: error[L0904]: 'missing' is not declared" in run("check", "Nested", code=2)


PACKAGE = '<?xml version="1.0"?>\n<Package xmlns="http://br-automation.co.at/AS/Package">\n <Objects>\n{}\n </Objects>\n</Package>\n'


def check_packages():
    """What a Package.pkg or an IEC.lby does not list is not read, nor is Structured Text that a package itself lists."""
    def listed(*names):
        return PACKAGE.format("\n".join(f'  <Object Type="File">{name}</Object>' for name in names))

    types = "TYPE\n\tBelt_type : STRUCT\n\t\tn : INT;\n\tEND_STRUCT;\nEND_TYPE\n"
    write("Packed/Logical/Package.pkg", listed("Belt", "Global.typ", "R&amp;D", "Robots"))
    write("Packed/Logical/Global.typ", types)
    write("Packed/Logical/Global - Copy.typ", types)
    write("Packed/Logical/old/Types.typ", types)
    write("Packed/Logical/Robots/Package.pkg", listed("Robot.st", "Types.typ"))
    write("Packed/Logical/Robots/Robot.st", "PROGRAM _MAIN\n\tMoveLR(ParkPos);\nEND_PROGRAM\n")
    write("Packed/Logical/Robots/types.typ", types.replace("Belt_type", "Robot_type"))
    write("Packed/Logical/R&D/IEC.lby", '<Library><Files>\n<File Description="x">Lib.fun</File>\n<File>sub\\Half.st</File>\n</Files></Library>\n')
    write("Packed/Logical/R&D/Lib.fun", "FUNCTION Half : INT\n\tVAR_INPUT\n\t\tn : INT;\n\tEND_VAR\nEND_FUNCTION\n")
    write("Packed/Logical/R&D/sub/Half.st", "FUNCTION Half\n\tHalf := n / 2;\nEND_FUNCTION\n")
    write("Packed/Logical/R&D/Left.st", "FUNCTION Half\n\tHalf := missing;\nEND_FUNCTION\n")
    write("Packed/Logical/Belt/IEC.prg", '<Program SubType="IEC"><Files><File>Main.st</File><File>Belt.var</File></Files></Program>\n')
    write("Packed/Logical/Belt/Belt.var", "VAR\n\tbelt : Belt_type;\n\trobot : Robot_type;\nEND_VAR\n")
    write("Packed/Logical/Belt/Main.st", "PROGRAM _CYCLIC\n\tbelt.n := Half(8);\n\trobot.n := belt.n;\nEND_PROGRAM\n")
    run("check", "Packed")
    run("new", "packed", "--from", "Packed")
    run("run", "--quiet", "packed.yaml")


def check_classes_of_system():
    """Events of TwinCAT itself are of classes that no file of a project has."""
    twincat("system", "POU", "MAIN", "PROGRAM MAIN\nVAR class : GUID; n : INT; END_VAR",
            "IF class.Data1 <> TC_EVENT_CLASSES.TcRouterEventClass.Data1 THEN n := n + 1; END_IF\nclass := TC_EVENT_CLASSES.TcRouterEventClass;")
    write("system/Task.TcTTO", TASK)
    plcproj("system/System.plcproj", "System", ["MAIN.TcPOU", "Task.TcTTO"], [])
    run("new", "system_classes", "--from", "system")
    made = (work / "system_classes.yaml").read_text()
    (work / "system_classes.yaml").write_text(made + "expect:\n  - {at: end, MAIN.n: 1}\n")
    run("run", "--quiet", "system_classes.yaml")


def check_private_packages():
    """What a package has for itself is of its programs and of those below it: others may have the same names."""
    private = '  <Object Type="File" Private="true">{}</Object>'
    program = '<Program SubType="IEC"><Files><File>Main.st</File>{}</Files></Program>\n'
    write("Apart/Logical/Package.pkg", PACKAGE.format("  <Object>Global.var</Object>\n  <Object>Left</Object>\n  <Object>Right</Object>"))
    write("Apart/Logical/Global.var", "VAR\n\tshared : INT;\nEND_VAR\n")
    for cell, step in (("Left", 1), ("Right", 100)):
        write(f"Apart/Logical/{cell}/Package.pkg",
              PACKAGE.format("\n".join([private.format("Own.var"), private.format("Own.typ"), "  <Object>Deep</Object>", "  <Object>Task</Object>"])))
        write(f"Apart/Logical/{cell}/Own.typ", f"TYPE\n\tOwn_type : STRUCT\n\t\t{cell}_n : INT;\n\tEND_STRUCT;\nEND_TYPE\n")
        write(f"Apart/Logical/{cell}/Own.var", "VAR\n\tcount : INT;\n\town : Own_type;\nEND_VAR\n")
        write(f"Apart/Logical/{cell}/Task/IEC.prg", program.format(""))
        write(f"Apart/Logical/{cell}/Task/Main.st", f"PROGRAM _CYCLIC\n\tcount := count + {step};\n\tshared := shared + 1;\nEND_PROGRAM\n")
        write(f"Apart/Logical/{cell}/Deep/Package.pkg", PACKAGE.format(private.format("Deep.var") + f"\n  <Object>{cell}Deep</Object>"))
        write(f"Apart/Logical/{cell}/Deep/Deep.var", "VAR\n\tdeep : Own_type;\nEND_VAR\n")
        write(f"Apart/Logical/{cell}/Deep/{cell}Deep/IEC.prg", program.format("<File>V.var</File><File Private=\"true\">T.typ</File>"))
        write(f"Apart/Logical/{cell}/Deep/{cell}Deep/T.typ", "TYPE\n\tPair : ARRAY[0..1] OF Own_type;\nEND_TYPE\n")
        write(f"Apart/Logical/{cell}/Deep/{cell}Deep/V.var", "VAR\n\tn : INT;\n\tpair : Pair;\nEND_VAR\n")
        write(f"Apart/Logical/{cell}/Deep/{cell}Deep/Main.st", f"PROGRAM _CYCLIC\n\tdeep.{cell}_n := count;\n\town.{cell}_n := deep.{cell}_n;\n"
              f"\tn := own.{cell}_n;\n\tpair[1].{cell}_n := shared;\nEND_PROGRAM\n")
    (work / "Apart/Logical/Left/Task").rename(work / "Apart/Logical/Left/LeftTask")
    (work / "Apart/Logical/Right/Task").rename(work / "Apart/Logical/Right/RightTask")
    for cell in ("Left", "Right"):
        listed = work / f"Apart/Logical/{cell}/Package.pkg"
        listed.write_text(listed.read_text().replace(">Task<", f">{cell}Task<"))
    assert "warning" not in run("check", "Apart")
    run("new", "apart", "--from", "Apart")
    made = (work / "apart.yaml").read_text()
    (work / "apart.yaml").write_text(made + "expect:\n  - {at: end, LeftDeep.n: 100}\n  - {at: end, RightDeep.n: 10000}\n")
    run("run", "--quiet", "apart.yaml")
    listed = work / "Apart/Logical/Left/Package.pkg"
    listed.write_text(listed.read_text().replace(' Private="true"', ""))
    main = work / "Apart/Logical/Right/RightTask/Main.st"
    main.write_text(main.read_text().replace("shared := shared", "shared := own.Left_n"))
    told = run("check", "Apart", code=2)
    assert "Main.st:3:16: error[L0904]: _Logical._Right.Own_type has no 'Left_n'" in told, told


def check_projects_beside():
    """Several projects of Automation Studio in a folder are checked apart, each with what is in none of them."""
    for name, member in (("One", "left"), ("Two", "right")):
        write(f"Both/{name}/Logical/Package.pkg", PACKAGE.format("  <Object>Types.typ</Object>\n  <Object>Main</Object>"))
        write(f"Both/{name}/Logical/Types.typ", f"TYPE\n\tBoth_type : STRUCT\n\t\t{member} : Shared_type;\n\tEND_STRUCT;\nEND_TYPE\n")
        write(f"Both/{name}/Logical/Main/IEC.prg", '<Program SubType="IEC"><Files><File>Main.st</File><File>Main.var</File></Files></Program>\n')
        write(f"Both/{name}/Logical/Main/Main.var", "VAR\n\tboth : Both_type;\nEND_VAR\n")
        write(f"Both/{name}/Logical/Main/Main.st", f"PROGRAM _CYCLIC\n\tboth.{member}.n := 1;\nEND_PROGRAM\n")
    write("Both/Common/Shared.typ", "TYPE\n\tShared_type : STRUCT\n\t\tn : INT;\n\tEND_STRUCT;\nEND_TYPE\n")
    told = run("check", "Both")
    assert "warning" not in told, told
    told = run("new", "both", "--from", "Both", code=2)
    assert "'Both' has several projects" in told and "Both/One" in told and "Both/Two" in told, told
    main = work / "Both/Two/Logical/Main/Main.st"
    main.write_text(main.read_text().replace("both.right.n", "both.left.n"))
    told = run("check", "Both", code=2)
    assert "Both/Two/Logical/Main/Main.st:2:7: error[L0904]: Both_type has no 'left'" in told and "3 projects" in told, told


def check_typst():
    """Chapters of a thesis in Typst, which are named as B&R's types are."""
    write("Thesis/chapters/plc.typ", "#import \"lib.typ\": *\n= PLC\nThe program of a PLC ...\n")
    write("Thesis/plc/Types.typ", "TYPE\n\tKind : (STOP, GO);\nEND_TYPE\n")
    write("Thesis/plc/Main.st", "PROGRAM Main\nVAR kind : Kind; END_VAR\nkind := GO;\nEND_PROGRAM\n")
    run("check", "Thesis", "--source-dialect", "automation_studio")
    write("Cut/Types.typ", "TYPE\n\tKind : (STOP, GO);\n")
    assert "END_TYPE" in run("check", "Cut", code=2)


def check_later_constants():
    """B&R's constants may be made of those that stand further down, as a sample of theirs has it."""
    write("Later/Logical/Table/IEC.prg", '<Program SubType="IEC"><Files><File>Main.st</File><File>Table.var</File></Files></Program>\n')
    write("Later/Logical/Table/Table.var", "VAR CONSTANT\n\tHALF : USINT := (LAST + 1) / 2;\n\tLAST : USINT := SLOTS - 1;\n"
          "\tSLOTS : USINT := 32;\nEND_VAR\nVAR\n\tlist : ARRAY[0..LAST] OF USINT;\n\tsum : USINT;\nEND_VAR\n")
    write("Later/Logical/Table/Main.st", "PROGRAM _CYCLIC\n\tlist[LAST] := HALF;\n\tsum := list[31] + SLOTS;\nEND_PROGRAM\n")
    run("new", "later", "--from", "Later")
    made = (work / "later.yaml").read_text()
    (work / "later.yaml").write_text(made + "expect:\n  - {at: end, Table.sum: 48}\n")
    run("run", "--quiet", "later.yaml")
    variables = work / "Later/Logical/Table/Table.var"
    variables.write_text(variables.read_text().replace("SLOTS : USINT := 32", "SLOTS : USINT := LAST + 1"))
    assert "'LAST' is not declared" in run("check", "Later", code=2)


def check_mapp():
    """B&R: what configures mapp declares variables; names may differ in capitals alone; a program's folder has any name."""
    def configuration(path, *elements):
        write(path, '<?xml version="1.0"?>\n<?AutomationStudio Version="4.9"?>\n<Configuration>\n'
              + "".join(f'  <Element ID="{name}" Type="{kind}"/>\n' for name, kind in elements) + "</Configuration>\n")
    program = ('<Program xmlns="http://br-automation.co.at/AS/Program"><Files><File>Variables.var</File><File>Main.st</File>'
               "<File>actions/More.st</File></Files></Program>\n")
    configuration("Mapp/Physical/one/cpu/mappServices/Alarms.mpalarmxcore", ("gAlarms", "mpalarmxcore"))
    configuration("Mapp/Physical/two/cpu/mappServices/Other.mpalarmxcore", ("gAlarms", "mpalarmxcore"))
    configuration("Mapp/Physical/one/cpu/mappMotion/Axes.axis", ("gAxis", "axis"), ("two words", "axis"))
    write("Mapp/Physical/one/cpu/Safe/SafeLOGIC-1.plcproj", "\0\1")
    write("Mapp/Logical/Global.var", "VAR CONSTANT\n\tLOW_a : USINT := 97;\n\tLOW_A : USINT := 65;\nEND_VAR\nVAR\n\tprogram_ : INT;\nEND_VAR\n")
    write("Mapp/Logical/Kinds.typ", "TYPE Mode : (STOP := 0, GO := 70000); END_TYPE\n")
    write("Mapp/Logical/Program/IEC.prg", program)
    write("Mapp/Logical/Program/Variables.var", "VAR\n\tStop, isOn : BOOL;\n\tison, small, big, index : USINT;\n\tmode : Mode;\n\twait : TIME;\n"
          "\tms : UDINT := 1500;\n\tlink : UDINT;\n\taxis : REFERENCE TO McAxisType;\n\tlong_text : STRING[70000];\n\tr : REAL;\nEND_VAR\n")
    write("Mapp/Logical/Program/Main.st", "PROGRAM _CYCLIC\n\tlink := ADR(gAlarms);\n\taxis ACCESS ADR(gAxis);\n\tsmall := LOW_a;\n\tbig := LOW_A;\n"
          "\tCASE mode OF\n\t\tSTOP: Stop := TRUE; mode := GO;\n\t\tGO: isOn := TRUE;\n\tEND_CASE\n\tison := isOn;\n\twait := ms;\n"
          "\tr := SIN(ms);\n\tIF EDGEPOS(isOn) THEN index := index + 1; END_IF\n\tmore;\nEND_PROGRAM\n")
    write("Mapp/Logical/Program/actions/More.st", "ACTION more:\n\tprogram_ := MAX(program_, 1, );\nEND_ACTION\n")
    said = run("check", "Mapp")
    assert said.splitlines()[0] == "ok  Mapp", said
    run("new", "mapp", "--from", "Mapp")
    write("mapp.yaml", (work / "mapp.yaml").read_text() + "expect:\n"
          + "".join(f"  - {{at: end, Program.{name}: {value}}}\n" for name, value in
                    (("small", 97), ("big", 65), ("Stop", "true"), ("index", 1), ("wait", "1.5 s"))))
    run("run", "mapp.yaml", "--quiet")


def check_mapp_motion():
    """B&R: an axis of the configuration is one of the program, which mapp Motion's blocks move by its address; a library of another version stays declared."""
    write("Motion/Physical/one/cpu/mappMotion/Axes.axis", '<?xml version="1.0"?>\n<Configuration>\n  <Element ID="gFirst" Type="axis"/>\n'
          '  <Element ID="gSecond" Type="axis"/>\n  <Element ID="gSector" Type="sector"/>\n</Configuration>\n')
    write("Motion/Physical/one/cpu/mappMotion/PnP/Config_8.pickregister", '<?xml version="1.0"?>\n<Configuration>\n'
          '  <Element ID="gRegister" Type="pickregister"/>\n  <Element ID="gCore" Type="pickcore"/>\n</Configuration>\n')
    write("Motion/Logical/Track.typ", "TYPE\n\tMcSectorType : STRUCT\n\t\tcontrolif : UDINT;\n\tEND_STRUCT;\n"
          "\tMpPickRegisterType : STRUCT\n\t\tsize : UDINT;\n\tEND_STRUCT;\n\tMpPickCoreType : STRUCT\n\t\tparts : UDINT;\n\tEND_STRUCT;\nEND_TYPE\n")
    write("Motion/Logical/P/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Main.st</File><File>Variables.var</File></Files></Program>\n")
    write("Motion/Logical/P/Variables.var", "VAR\n\tbasic : MpAxisBasic;\n\tpar : MpAxisBasicParType;\n\tstep : USINT;\n\tpower : MC_Power;\n\tmove : MC_MoveAbsolute;\n"
          "\tstatus : MC_ReadStatus;\n\tis_connected, is_sector : BOOL;\nEND_VAR\n")
    write("Motion/Logical/P/Main.st", "PROGRAM _INIT\n\tgSecond := gSecond;\n\tpar.Velocity := 100;\n\tpar.Acceleration := 1000;\n\tpar.Deceleration := 1000;\n\tpar.Position := 20;\n"
          "END_PROGRAM\nPROGRAM _CYCLIC\n\tbasic.MpLink := ADR(gFirst);\n\tbasic.Enable := TRUE;\n\tbasic.Parameters := ADR(par);\n"
          "\tis_connected := gFirst.controlif <> 0 AND gFirst.mappLinkInternal.Internal[0] <> 0;\n\tis_sector := gSector.controlif = 0 AND gRegister.size = 0 AND gCore.parts = 0;\n\tCASE step OF\n"
          "\t\t0: IF basic.Info.ReadyToPowerOn THEN basic.Power := TRUE; step := 1; END_IF\n\t\t1: IF basic.PowerOn THEN basic.Home := TRUE; step := 2; END_IF\n"
          "\t\t2: IF basic.IsHomed THEN basic.Home := FALSE; basic.MoveAbsolute := TRUE; step := 3; END_IF\n"
          "\t\t3: IF basic.InPosition THEN basic.MoveAbsolute := FALSE; step := 4; END_IF\n\tEND_CASE\n\tbasic();\n"
          "\tpower(Axis := ADR(gSecond), Enable := TRUE);\n\tmove(Axis := ADR(gSecond), Execute := power.Status, Position := 5, Velocity := 10, BufferMode := mcABORTING);\n"
          "\tstatus(Axis := ADR(gSecond), Enable := TRUE);\nEND_PROGRAM\n")
    assert run("check", "Motion").splitlines()[0] == "ok  Motion"
    run("new", "motion", "--from", "Motion")
    write("motion.yaml", (work / "motion.yaml").read_text() + "expect:\n  - {at: end, gFirst.position: 20 mm}\n  - {at: end, gSecond.position: 5 mm}\n  - {at: end, P.step: 4}\n"
          "  - {at: end, P.is_connected: true}\n  - {at: end, P.is_sector: true}\n  - {at: end, P.status.StandStill: true}\n")
    run("run", "motion.yaml", "--quiet")
    shutil.copytree(work / "Motion", work / "NamedAsType")
    (work / "NamedAsType/Logical/P").rename(work / "NamedAsType/Logical/Axis")
    run("new", "named_as_type", "--from", "NamedAsType")
    write("named_as_type.yaml", (work / "named_as_type.yaml").read_text() + "expect:\n  - {at: end, gFirst.position: 20 mm}\n  - {at: end, Axis.step: 4}\n")
    run("run", "named_as_type.yaml", "--quiet")
    write("Motion/Logical/Libraries/MpAxis/binary.lby",
          '<?xml version="1.0"?>\n<Library SubType="binary" xmlns="http://br-automation.co.at/AS/Library"><Files><File>MpAxis.fun</File></Files></Library>\n')
    write("Motion/Logical/Libraries/MpAxis/MpAxis.typ", "TYPE\n\tMpAxisBasicParType : STRUCT\n\t\tPosition : LREAL;\n\t\tHome : USINT;\n\tEND_STRUCT;\nEND_TYPE\n")
    write("Motion/Logical/Libraries/MpAxis/MpAxis.fun", "FUNCTION_BLOCK MpAxisBasic\n\tVAR_INPUT\n\t\tMpLink : REFERENCE TO MpComIdentType;\n\t\tParameters : REFERENCE TO MpAxisBasicParType;\n"
          "\t\tAxis : UDINT;\n\t\tTorqueLimit : BOOL;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n")
    write("Motion/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tpar.Home := 1;\n\tbasic(Axis := 1, Parameters := ADR(par), TorqueLimit := TRUE);\nEND_PROGRAM\n")
    said = run("check", "Motion")
    assert "of the library 'MpAxis' there are declarations alone, so this does nothing: MpAxisBasic" in said and "ok  Motion" in said, said


def check_mapp_references():
    """B&R: what blocks of mapp are to work with is a variable of the type that they refer to; a list declares each of its points and stations."""
    kinds = {"pickregister": "MpPickRegisterType", "pickcore": "MpPickCoreType", "pickobjectlist": "MpPickObjectListType", "assembly6d": "Mc6DAssemblyType",
             "trafficmanager": "MpTrafficManagerType", "processpoint": "McProcessPointType", "visioncomponent": "ViComponentType"}
    objects = {"gPoint": "McProcessPointType", "S1": "MpTrafficStationType", "G1": "MpTrafficWaypointType", "P1": "MpTrafficPathType"}
    text = "".join(f'  <Element ID="g_{kind}" Type="{kind}"/>\n' for kind in kinds)
    text += '  <Element ID="gPoints" Type="processpointlist">\n   <Selector ID="ProcessPoint[0]"><Property ID="Name" Value="gPoint"/></Selector>\n  </Element>\n'
    text += '  <Element ID="gObjects" Type="trafficobjectlist">\n' + "".join(
        f'   <Selector ID="TrafficObject[1]" Value="{kind}"><Property ID="X" Value="0"/><Property ID="Name" Value="{name}"/></Selector>\n'
        for name, kind in (("S1", "Station"), ("G1", "Waypoint"), ("P1", "Path"), ("N1", "Else"))) + "  </Element>\n"
    write("Linked/Physical/one/cpu/mappMotion/All.pickregister", f'<?xml version="1.0"?>\n<Configuration>\n{text}</Configuration>\n')
    named = {**{f"g_{kind}": type_ for kind, type_ in kinds.items()}, **objects}
    write("Linked/Logical/All.typ", "TYPE\n" + "".join(f"\t{type_} : STRUCT\n\t\tcontrolif : UDINT;\n\tEND_STRUCT;\n" for type_ in sorted(set(named.values()))) + "END_TYPE\n")
    write("Linked/Logical/P/IEC.prg", '<?xml version="1.0"?>\n<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Main.st</File><File>Variables.var</File></Files></Program>\n")
    write("Linked/Logical/P/Variables.var", "VAR\n" + "".join(f"\tto_{name} : REFERENCE TO {type_};\n" for name, type_ in named.items()) + "END_VAR\n")
    write("Linked/Logical/P/Main.st", "PROGRAM _CYCLIC\n" + "".join(f"\tto_{name} ACCESS ADR({name});\n" for name in named) + "END_PROGRAM\n")
    assert run("check", "Linked").splitlines()[0] == "ok  Linked"


def check_headers():
    """PLCopen XML of CODESYS has its texts and edges; that of others, Beremiz or OpenPLC, the standard's. Neither's counters go below 0."""
    body = ('<types><dataTypes/><pous><pou name="P" pouType="program"><interface><localVars>'
            '<variable name="text"><type><string/></type></variable><variable name="counter"><type><derived name="CTD"/></type></variable>'
            '<variable name="size"><type><INT/></type></variable><variable name="falls"><type><derived name="F_TRIG"/></type></variable>'
            '<variable name="pulses"><type><INT/></type></variable></localVars></interface><body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">'
            "counter(CD := TRUE);\nsize := SIZEOF(text);\nfalls(CLK := FALSE);\nIF falls.Q THEN pulses := pulses + 1; END_IF;"
            "</xhtml></ST></body></pou></pous></types><instances><configurations/></instances></project>")
    for product, value in (("CODESYS", (0, 81, 0)), ("Beremiz", (0, 127, 1))):
        write(f"{product}.xml", '<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201">'
              f'<fileHeader companyName="" productName="{product}" productVersion="1" creationDateTime="2024-01-01T00:00:00"/>' + body)
        run("new", product, "--from", f"{product}.xml")
        write(f"{product}.yaml", (work / f"{product}.yaml").read_text() + "expect:\n" + "".join(
            f"  - {{at: end, P.{name}: {number}}}\n" for name, number in zip(("counter.CV", "size", "pulses"), value)))
        run("run", "--quiet", f"{product}.yaml")


def check_task_classes():
    """B&R: Cpu.sw says which program is in which task class, Hardware.hw how often that runs; one that is disabled does not."""
    for name in ("Fast", "Slow", "Off"):
        write(f"Classes/Logical/Line/{name}/IEC.prg", '<?xml version="1.0"?>\n<Program xmlns="http://br-automation.co.at/AS/Program"><Files>'
              "<File>Variables.var</File><File>Main.st</File></Files></Program>\n")
        write(f"Classes/Logical/Line/{name}/Variables.var", "VAR\n\tn : UINT;\n\tname : STRING;\n\tcounter : CTD;\nEND_VAR\n")
        write(f"Classes/Logical/Line/{name}/Main.st", "PROGRAM _CYCLIC\n\tn := n + 1;\n\tcounter(CD := n > 3);\nEND_PROGRAM\n")
    for cpu in ("one/X20", "two/X20"):
        write(f"Classes/Physical/{cpu}/Cpu.sw", '<?xml version="1.0" encoding="utf-8"?>\n<?AutomationStudio FileVersion="4.9"?>\n'
              '<SwConfiguration CpuAddress="SL1" xmlns="http://br-automation.co.at/AS/SwConfiguration">\n'
              '  <TaskClass Name="Cyclic#1">\n    <Task Name="Fast" Source="Line.Fast.prg" Memory="UserROM" Language="IEC" />\n  </TaskClass>\n'
              '  <TaskClass Name="Cyclic#2" />\n  <TaskClass Name="Cyclic#4">\n    <Task Name="Slow" Source="Line.Slow.prg" Language="IEC" />\n'
              '    <Task Name="Off" Source="Line.Off.prg" Language="IEC" Disabled="true" />\n  </TaskClass>\n</SwConfiguration>\n')
    write("Classes/Physical/one/Hardware.hw", '<?xml version="1.0" encoding="utf-8"?>\n<Hardware xmlns="http://br-automation.co.at/AS/Hardware">\n'
          '  <Module Name="X20" Type="X20CP1685">\n    <Parameter ID="Cyclic1Duration" Value="2000" />\n  </Module>\n</Hardware>\n')
    run("new", "classes", "--from", "Classes")
    text = (work / "classes.yaml").read_text()
    for line in ("Cyclic_1: {every: 2 ms, priority: 2}", "Cyclic_4: {every: 100 ms, priority: 1}", "Fast: {type: Fast, task: Cyclic_1}",
                 "Slow: {type: Slow, task: Cyclic_4}"):
        assert line in text, text
    assert "Off: {" not in text, text
    for cpu in ("one/X20", "two/X20"):
        software = work / f"Classes/Physical/{cpu}/Cpu.sw"
        software.write_text(software.read_text().replace("</SwConfiguration>", '  <TaskClass Name="Cyclic#3">\n'
                            '    <Task Name="Vision" Source="Line.Vision.prg" Language="ANSIC" />\n    <Task Name="Web" Source="Line.Web.prg" Language="ANSIC" />\n'
                            "  </TaskClass>\n</SwConfiguration>"))
    said = run("check", "Classes")
    assert said.count("written in C, and so not read and not run: Vision, Web") == 1, said
    write("classes.yaml", text + "expect:\n  - {at: end, Fast.n: 501}\n  - {at: end, Slow.n: 11}\n  - {at: end, Fast.counter.CV: 0}\n")
    run("run", "--quiet", "classes.yaml")


def check_organization_blocks():
    """Siemens: OB100 once, each cyclic interrupt in a task of its own, OB1 in the main task; an interrupt is left to the user."""
    def block(name, title, inputs, body):
        write(f"Tia/{name}.scl", f'ORGANIZATION_BLOCK "{name}"\nTITLE = "{title}"\n{{ S7_Optimized_Access := \'TRUE\' }}\nVERSION : 0.1\n'
              f'   VAR_INPUT\n{inputs}   END_VAR\nBEGIN\n\t{body}\nEND_ORGANIZATION_BLOCK\n')
    write("Tia/Data.db", 'DATA_BLOCK "Data"\nVERSION : 0.1\n   VAR\n      starts, mains, ticks, slow, seen : Int;\n   END_VAR\nBEGIN\nEND_DATA_BLOCK\n')
    block("Main", "Main Program Sweep (Cycle)", "      Initial_Call : Bool;\n      Remanence : Bool;\n", '"Data".mains += 1; "Data".seen := "Data".starts;')
    block("Init", "Complete Restart", "      LostRetentive : Bool;\n      LostRTC : Bool;\n", '"Data".starts += 1;')
    block("Cyclic interrupt", "", "      Initial_Call : Bool;\n      Event_Count : Int;\n", '"Data".ticks += 1;')
    block("OB38_Slow", "", "", '"Data".slow += 1;')
    block("Hardware interrupt", "", "      LADDR : HW_IO;\n", '"Data".mains := 0;')
    run("new", "tia", "--from", "Tia")
    text = (work / "tia.yaml").read_text()
    for line in ("  main: {every: 10 ms, priority: 1}\n", "  Cyclic_interrupt: {every: 100 ms, priority: 8}  # the export does not say the interval\n",
                 "  OB38_Slow: {every: 100 ms, priority: 16}", "  startup: {once: true}\n", "  # 'Hardware interrupt' is of an event",
                 "  Init: {type: Init, task: startup}\n", "  Main: {type: Main, task: main}\n"):
        assert line in text, (line, text)
    assert "type: Hardware" not in text, text
    write("tia.yaml", text + "expect:\n" + "".join(f"  - {{at: end, Data.{name}: {value}}}\n" for name, value in
          (("starts", 1), ("mains", 101), ("seen", 1), ("ticks", 11), ("slow", 11))))
    run("run", "tia.yaml", "--quiet")
    numbered = ('<?xml version="1.0"?>\n<Document><SW.Blocks.OB ID="0"><AttributeList><Name>{0}</Name><Number>{1}</Number>'
                "<ProgrammingLanguage>SCL</ProgrammingLanguage>{2}</AttributeList></SW.Blocks.OB></Document>\n")
    for name, number, kind in (("Plant", 1, "ProgramCycle"), ("Begin", 100, "Startup"), ("Control", 124, "CyclicInterrupt")):
        write(f"Xml/{name}.xml", numbered.format(name, number, f"<SecondaryType>{kind}</SecondaryType>"))
    run("new", "xml", "--from", "Xml")
    text = (work / "xml.yaml").read_text()
    for line in ("  Plant: {type: Plant, task: main}", "  Begin: {type: Begin, task: startup}", "  Control: {type: Control, task: Control}"):
        assert line in text, (line, text)


def check_memory_bytes():
    """Siemens: FirstScan for one scan of OB1, AlwaysTRUE, clocks with halves of the same length; a tag of another name or bit is none."""
    def tags(file, *those):
        write(f"Memory/{file}.xml", f'<Document><SW.Tags.PlcTagTable ID="0"><AttributeList><Name>{file}</Name></AttributeList><ObjectList>' + "".join(
            f'<SW.Tags.PlcTag ID="{i}" CompositionName="Tags"><AttributeList><DataTypeName>Bool</DataTypeName><LogicalAddress>%M{address}</LogicalAddress>'
            f"<Name>{name}</Name></AttributeList></SW.Tags.PlcTag>" for i, (name, address) in enumerate(those)) +
            "</ObjectList></SW.Tags.PlcTagTable></Document>\n")
    tags("Default tag table", ("Clock_1Hz", "0.5"), ("Clock_0.625Hz", "0.6"), ("Clock_2Hz", "0.4"), ("FirstScan", "1.0"), ("AlwaysTRUE", "1.2"), ("Clock_Hz", "0.0"))
    tags("Others", ("Clock_10Hz", "20.0"))
    write("Memory/Main.scl", """ORGANIZATION_BLOCK "Main"
BEGIN
   "Data".first += BOOL_TO_INT("FirstScan");
   "Data".always += BOOL_TO_INT("AlwaysTRUE");
   "Data".high += BOOL_TO_INT("Clock_1Hz");
   "Data".slow += BOOL_TO_INT("Clock_0.625Hz");
   "Data".fast += BOOL_TO_INT("Clock_10Hz");
   "Data".none += BOOL_TO_INT("Clock_2Hz") + BOOL_TO_INT("Clock_Hz");
END_ORGANIZATION_BLOCK
ORGANIZATION_BLOCK "OB30"
BEGIN
   "Data".early += BOOL_TO_INT("AlwaysTRUE");
END_ORGANIZATION_BLOCK
DATA_BLOCK "Data"
STRUCT first, always, high, slow, fast, none, early : Int; END_STRUCT;
BEGIN
END_DATA_BLOCK
""")
    run("new", "memory", "--from", "Memory")
    text = (work / "memory.yaml").read_text()
    for line in ("  clock_memory: {every: 50 ms, priority: 17}\n", "type: 'System memory of Default tag table', task: main}\n  Main: {type: Main, task: main}\n",
                 "type: 'Clock memory of Default tag table', task: clock_memory}\n", "type: 'Clock memory of Others', task: clock_memory}\n"):
        assert line in text, (line, text)
    write("memory.yaml", text.replace("run: {for: 1 s}", "run: {for: 1.595 s}") + "expect:\n" + "".join(f"  - {{at: end, Data.{name}: {value}}}\n"
          for name, value in (("first", 1), ("always", 160), ("early", 16), ("high", 60), ("slow", 80), ("fast", 80), ("none", 0))))
    run("run", "memory.yaml", "--quiet")
    (work / "Memory/Main.scl").write_text("FUNCTION_BLOCK Alone\nBEGIN\nEND_FUNCTION_BLOCK\n")
    run("new", "memory_alone", "--from", "Memory")
    assert "blocks:\n  alone: {type: Alone, task: main}\n" in (work / "memory_alone.yaml").read_text()
    write("MyBlocks.st", "FUNCTION_BLOCK MyLatch\nVAR_INPUT s : BOOL; END_VAR\nVAR_OUTPUT q : BOOL; END_VAR\nq := q OR s;\nEND_FUNCTION_BLOCK\n"
          "FUNCTION_BLOCK Mover\nVAR_IN_OUT axis : AXIS_REF; END_VAR\nEND_FUNCTION_BLOCK\n"
          "FUNCTION_BLOCK Lent\nVAR_IN_OUT n : INT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n")
    run("new", "my_blocks", "--from", "MyBlocks.st")
    assert "  my_latch: {type: MyLatch, task: main}\n  mover: {type: Mover, task: main, axis: mover_axis}\n" in (work / "my_blocks.yaml").read_text()
    run("run", "my_blocks.yaml", "--quiet")
    assert "lineshaft new NAME --from MyBlocks.st" in run("run", "MyBlocks.st", code=2)
    write("Sum.st", "FUNCTION Sum : INT\nVAR_INPUT a : INT; END_VAR\nSum := a;\nEND_FUNCTION\n")
    assert "has no PROGRAM that a task could run" in run("new", "sum", "--from", "Sum.st", code=2)
    run("new", "ending.yml")
    assert (work / "ending.yaml").exists()


def check_softmotion():
    """An axis of the device tree is one wherever it is named; a name that no pin of an axis is given is none."""
    write("soft/A_panel.st", "PROGRAM A_panel\nVAR place : LREAL; stands : BOOL; END_VAR\nplace := Lift.fActPosition;\n"
          "stands := Lift.nAxisState = SMC_AXIS_STATE.standstill;\nEND_PROGRAM\n")
    write("soft/Main.st", "PROGRAM Main\nVAR power : MC_Power := (Enable := TRUE, bRegulatorOn := TRUE, bDriveStart := TRUE); inch : SMC_Inch; END_VAR\n"
          "power(Axis := Lift);\ninch(Axis := Lift, InchForward := power.Status, Distance := 2.0, Velocity := 20.0);\nEND_PROGRAM\n")
    run("new", "soft_motion", "--from", "soft")
    write("soft_motion.yaml", (work / "soft_motion.yaml").read_text() +
          "expect:\n  - {at: end, A_panel.place: 2, within: 1e-9}\n  - {at: end, A_panel.stands: true}\n")
    run("run", "soft_motion.yaml", "--quiet")
    write("soft/B_typo.st", "PROGRAM B_typo\nVAR place : LREAL; END_VAR\nplace := Lft.fActPosition;\nEND_PROGRAM\n")
    assert "'Lft' is not declared" in run("check", "soft", code=2)
    write("soft/B_typo.st", "PROGRAM B_typo\nVAR place : LREAL; END_VAR\nplace := Axis.fActPosition;\nEND_PROGRAM\n")
    assert "'Axis' is not declared" in run("check", "soft", code=2)


def check_local_types():
    """Programs of B&R have types, functions and constants for themselves, by the same names; what its tools make does not count."""
    for name, size, value in (("Belt", 3, "TURN"), ("Press", 5, "PUSH")):
        write(f"Local/Logical/{name}/IEC.prg", '<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
              '<File Private="true">Types.typ</File><File Private="true">Variables.var</File><File Private="true">Functions.fun</File>'
              "<File>Main.st</File></Files></Program>\n")
        write(f"Local/Logical/{name}/Types.typ", f"TYPE\n\tStep : (WAIT, {value});\n\tList : STRUCT\n\t\tall : ARRAY[1..SIZE] OF INT;\n\t\tstep : Step;\n"
              "\tEND_STRUCT;\nEND_TYPE\n")
        write(f"Local/Logical/{name}/Variables.var", f"VAR CONSTANT\n\tSIZE : INT := {size};\nEND_VAR\nVAR\n\tlist : List;\n\tcount : INT;\n"
              "\tis_there : BOOL;\nEND_VAR\n")
        write(f"Local/Logical/{name}/Functions.fun", f"FUNCTION last_of_{name} : INT\nVAR_INPUT\n\tlist : REFERENCE TO List;\nEND_VAR\nEND_FUNCTION\n")
        write(f"Local/Logical/{name}/Main.st", f"PROGRAM _CYCLIC\n\tlist.step := {value};\n\tlist.all[SIZE] := SIZE;\n\tcount := SIZEOF(list.all) / 2;\n"
              f"\tis_there := list.step = {value};\nEND_PROGRAM\n")
    write("Local/Logical/3rd/IEC.prg", '<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files><File>Main.st</File>'
          '<File Private="true">Types.typ</File></Files></Program>\n')
    write("Local/Logical/3rd/Types.typ", "(* none *)\n")
    write("Local/Logical/3rd/Main.st", "PROGRAM _CYCLIC\nEND_PROGRAM\n")
    write("Local/Logical/C/ANSIC.prg", '<Program SubType="ANSIC" xmlns="http://br-automation.co.at/AS/Program"/>\n')
    write("Local/Logical/C/Variables.var", "VAR\n\tx : of_its_headers;\nEND_VAR\n")
    write("Local/Temp/Objects/Main.var", "VAR\n\tx : of_a_tool;\nEND_VAR\n")
    assert run("check", "Local").splitlines()[0] == "ok  Local"
    run("new", "local", "--from", "Local")
    write("local.yaml", (work / "local.yaml").read_text() + "expect:\n  - {at: end, Belt.count: 3}\n  - {at: end, Press.count: 5}\n"
          "  - {at: end, Belt.is_there: true}\n  - {at: end, Press.is_there: true}\n")
    run("run", "local.yaml", "--quiet")


def check_unused_local_types():
    """Types that a program of B&R has for itself, and that nothing uses, are there where it has a mistake."""
    write("Unused/Logical/P/IEC.prg", '<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          '<File>Main.st</File><File Private="true">Types.typ</File></Files></Program>\n')
    write("Unused/Logical/P/Types.typ", "TYPE\n\nEND_TYPE\n")
    write("Unused/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tfoo := 3;\nEND_PROGRAM\n")
    write("Unused/Physical/C/P/Cpu.sw", '<SwConfiguration xmlns="http://br-automation.co.at/AS/SwConfiguration"><TaskClass Name="Cyclic#1">'
          '<Task Name="P" Source="P.prg" Memory="UserROM" Language="IEC" /></TaskClass></SwConfiguration>\n')
    told = run("check", "Unused", code=2)
    assert "Main.st:2:2: error[L0904]: 'foo' is not declared" in told and "namespace" not in told, told


NUMBERS_OF_BR = """TEST 'a BOOL is 0 or 1 beside a number'
VAR b : BOOL := TRUE; u : UDINT := 7; d : DINT := -7; r : REAL := 2.5; n : USINT; END_VAR
ASSERT_EQ(3 + u * b, 10); ASSERT_EQ(d - b, -8); ASSERT_EQ(r * b, 2.5); ASSERT_TRUE(b > n); ASSERT_FALSE(n = b);
n := b + b; ASSERT_EQ(n, 2);
END_TEST
TEST 'signs are mixed beside conversions, too'
VAR u : UDINT := 3; d : DINT := 2; b : BOOL := TRUE; x, y : UDINT; END_VAR
x := u + 2 * d; y := u + 2 * BOOL_TO_DINT(b);
ASSERT_EQ(x, 7); ASSERT_EQ(y, 5);
END_TEST
TEST 'a text over lines may have semicolons'
VAR s, t : STRING[80]; END_VAR
s := '<style>
p {color:red;margin:0}
</style>'; t := 'x';
ASSERT_EQ(LEN(s), 39); ASSERT_EQ(t, 'x');
END_TEST
"""


def check_numbers_of_br():
    path = write("br/numbers_test.st", NUMBERS_OF_BR)
    told = run("test", path, "--source-dialect", "automation_studio")
    assert "3 of 3 passed" in told, told
    path.write_text(NUMBERS_OF_BR.replace("t := 'x'", "t := 'x"))
    assert "numbers_test.st:15:17: error[L0901]: the text does not end" in run("test", path, "--source-dialect", "automation_studio", code=1)


def check_types_by_capitals():
    """To B&R `INV_typ` and `Inv_typ` are two types."""
    write("Capitals/Logical/P/IEC.prg", '<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files><File>Main.st</File>'
          '<File Private="true">Types.typ</File><File Private="true">Variables.var</File></Files></Program>\n')
    write("Capitals/Logical/P/Types.typ", "TYPE\n\tINV_typ : STRUCT\n\t\tInv : Inv_typ;\n\t\tReset : BOOL;\n\tEND_STRUCT;\n\tInv_typ : STRUCT\n\t\tTest : USINT := 4;\n"
          "\tEND_STRUCT;\n\tMODE : (OFF, ON);\n\tMode : (SLOW, FAST);\nEND_TYPE\n")
    write("Capitals/Logical/P/Variables.var", "VAR\n\ti : INV_typ;\n\tone : Inv_typ;\n\tmode : Mode := FAST;\n\tis_fast : BOOL;\n\tn : USINT;\nEND_VAR\n")
    write("Capitals/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tn := i.Inv.Test + one.Test;\n\ti.Inv := one;\n\tis_fast := mode = FAST;\nEND_PROGRAM\n")
    assert run("check", "Capitals").splitlines()[0] == "ok  Capitals"
    run("new", "capitals", "--from", "Capitals")
    write("capitals.yaml", (work / "capitals.yaml").read_text() + "expect:\n  - {at: end, P.n: 8}\n  - {at: end, P.is_fast: true}\n")
    run("run", "capitals.yaml", "--quiet")


def check_actions_of_libraries():
    """An ACTION of a library of B&R is of the block in its folder that runs it, or runs what does; a file of no language is beside."""
    for name, step in (("Up", 1), ("Down", -1)):
        write(f"Steps/Logical/Libraries/{name}/IEC.lby", '<Library SubType="IEC" xmlns="http://br-automation.co.at/AS/Library"><Files>'
              f"<File>{name}.fun</File><File>ACT_Add.st</File><File>{name}.st</File><File>ACT_Step.st</File></Files></Library>\n")
        write(f"Steps/Logical/Libraries/{name}/{name}.fun", f"FUNCTION_BLOCK {name}\n\tVAR_INPUT\n\t\tRun : BOOL;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tN : DINT;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n")
        write(f"Steps/Logical/Libraries/{name}/{name}.st", f"FUNCTION_BLOCK {name}\n\tIF Run THEN\n\t\t{name}Step;\n\tEND_IF\nEND_FUNCTION_BLOCK\n")
        write(f"Steps/Logical/Libraries/{name}/ACT_Step.st", f"ACTION {name}Step:\n\t{name}Add;\nEND_ACTION\n")
        write(f"Steps/Logical/Libraries/{name}/ACT_Add.st", f"ACTION {name}Add:\n\tN := N + {step};\nEND_ACTION\n")
    write("Steps/Logical/P/IEC.prg", '<Program SubType="IEC" xmlns="http://br-automation.co.at/AS/Program"><Files>'
          "<File>Main.st</File><File>Variables.var</File><File>revision.txt</File></Files></Program>\n")
    write("Steps/Logical/P/revision.txt", "V1.0 first\n")
    write("Steps/Logical/P/Variables.var", "VAR\n\tup : Up;\n\tdown : Down;\nEND_VAR\n")
    write("Steps/Logical/P/Main.st", "PROGRAM _CYCLIC\n\tup(Run := TRUE);\n\tdown(Run := TRUE);\nEND_PROGRAM\n")
    run("check", "Steps")
    run("new", "steps", "--from", "Steps")
    write("steps.yaml", (work / "steps.yaml").read_text() + "expect:\n  - {at: 95 ms, P.up.N: 10}\n  - {at: 95 ms, P.down.N: -10}\n")
    run("run", "steps.yaml", "--quiet")
    listed = work / "Steps/Logical/P/IEC.prg"
    listed.write_text(listed.read_text().replace("revision.txt", "picture.ab"))
    assert "'picture.ab' is neither Structured Text nor a ladder" in run("check", "Steps", code=2)


def check_awl():
    write("old.awl", "U E 0.0;\n")
    assert "STL (AWL) of STEP 7, which is not read" in run("check", "old.awl", code=2)


def check_symbols_of_apax():
    """{::ifdef X} of SIMATIC AX asks for the symbols of apax.yml."""
    write("symbols/apax.yml", "name: s\nvariables:\n  DEFINED_PREPROCESSOR_SYMBOLS:\n    - BAR\n    # - FOO\n")
    write("symbols/src/a.st", "PROGRAM P\nVAR a, b, c, d : INT; END_VAR\n{::ifdef FOO}\na := 1;\n{::else}\na := 2;\n{::endif}\n"
          "{::ifndef FOO}\nb := 1;\n{::endif}\n{::ifdef BAR}\nc := 1;\n{::ifdef FOO}\nd := 1; ? {::endif}\n{::endif}\nEND_PROGRAM\n")
    write("symbols.yaml", "lineshaft: 1\ntitle: t\nsources: [symbols/apax.yml]\ntasks: {main: {every: 10 ms}}\n"
          "blocks: {p: {type: P, task: main}}\nrun: {for: 10 ms}\nexpect:\n"
          "  - {at: end, p.a: 2}\n  - {at: end, p.b: 1}\n  - {at: end, p.c: 1}\n  - {at: end, p.d: 0}\n")
    run("run", "symbols.yaml", "--quiet")


def check_apax():
    check_symbols_of_apax()
    write("package/apax.yml", "name: p\n")
    write("package/src/a.st", "FUNCTION_BLOCK Counter\nVAR_OUTPUT n : INT; END_VAR\nn := n + 1;\nEND_FUNCTION_BLOCK\n")
    write("package/scraps/b.st", "this is nothing\n")
    run("show", "package/apax.yml")
    write("package.yaml", "lineshaft: 1\ntitle: t\nsources: [package/apax.yml]\ntasks: {main: {every: 10 ms}}\n"
          "blocks: {c: {type: Counter, task: main}}\nrun: {for: 100 ms}\nexpect:\n  - {at: end, c.n: 11}\n")
    run("run", "package.yaml", "--quiet")
    write("package/src/config.st", "CONFIGURATION C\nVAR_GLOBAL CONSTANT MOST : DINT := 7; END_VAR\nEND_CONFIGURATION\n")
    write("package/src/limits.st", "NAMESPACE N\nCLASS Limits\nMETHOD PUBLIC Top : DINT\nVAR_EXTERNAL CONSTANT MOST : DINT; END_VAR\n"
          "Top := MOST;\nEND_METHOD\nEND_CLASS\nEND_NAMESPACE\n")
    write("package/test/limits.st", "USING AxUnit.Assert;\nUSING N;\n{TestFixture}\nCLASS T\nVAR PROTECTED limits : Limits; END_VAR\n"
          "{Test}\nMETHOD PUBLIC Reads\nVAR_EXTERNAL CONSTANT MOST : DINT; END_VAR\n"
          "Equal(expected := MOST, actual := limits.Top());\nEND_METHOD\nEND_CLASS\n")
    write("package/test/deep/limits.st", (work / "package/test/limits.st").read_text().replace("CLASS T\n", "CLASS Deep\n"))
    assert "2 of 2 passed" in run("test", "package")
    for part in "test/limits.st", "test/deep/limits.st", "test/deep":  # each finds what the package has
        for named, folder in (f"package/{part}", work), (work / "package" / part, work), (part, work / "package"):
            assert "1 of 1 passed" in run("test", named, cwd=folder), (part, named)
    run("test", "../test/deep", cwd=work / "package/src")
    write("package/SystemConstants/limits.st", (work / "package/src/limits.st").read_text())
    write("package/src/main.st", "PROGRAM Main\nVAR c : Counter; END_VAR\nc();\nEND_PROGRAM\n")
    run("check", "package")
    run("new", "of_package", "--from", "package")
    write("ax_named/apax.yml", "name: ax_named\n")
    write("ax_named/src/main.st", "TYPE\nMachineState : (Off, Run) := Run;\nEND_TYPE\nPROGRAM Main\nVAR_EXTERNAL machineState : MachineState; END_VAR\n"
          "VAR is_run : BOOL; cam : REF_TO TO_CamBase; encoder : TO_ExternalEncoder; axis : REF_TO TO_SynchronousAxis; turns : BOOL; END_VAR\n"
          "is_run := machineState = MachineState#Run;\nIF axis <> NULL THEN turns := axis^.Modulo.Enable; END_IF;\nEND_PROGRAM\n"
          "CONFIGURATION C\nTASK T1 (Interval := T#10ms, Priority := 1);\nPROGRAM P1 WITH T1 : Main;\nVAR_GLOBAL machineState : MachineState; END_VAR\nEND_CONFIGURATION\n")
    run("new", "named_state", "--from", "ax_named")
    write("named_state.yaml", (work / "named_state.yaml").read_text() + "expect:\n  - {at: end, Main.is_run: true}\n")
    run("run", "named_state.yaml", "--quiet")


def check_packages_beside():
    write("packages/leaf/apax.yml", "name: '@x/leaf' # the last\ntype: lib\n")
    write("packages/leaf/src/leaf.st", "NAMESPACE X.Leaf\nCLASS Leaf\nMETHOD PUBLIC Two : INT\nTwo := 2;\nEND_METHOD\nEND_CLASS\nEND_NAMESPACE\n")
    write("packages/leaf/test/leaf.st", "this is nothing\n{TestFixture}\n")
    write("packages/stem/apax.yml", 'name: "@x/stem"\ndependencies:\n  "@ax/system-math": ^1.0.0\n  "@x/leaf": ^1.0.0\n')
    write("packages/stem/src/stem.st", "USING X.Leaf;\nNAMESPACE X.Stem\nCLASS Stem\nVAR leaf : Leaf; END_VAR\n"
          "METHOD PUBLIC Four : INT\nFour := 2 * leaf.Two();\nEND_METHOD\nEND_CLASS\nEND_NAMESPACE\n")
    write("packages/other/apax.yml", "name: other\n")
    write("packages/other/src/other.st", "this is nothing\n")
    write("packages/top/apax.yml", "name: top\ndependencies:\n  '@x/stem': 1.0.0\nvariables:\n  other: 1\n")
    write("packages/top/src/top.st", "USING X.Stem;\nPROGRAM Main\nVAR stem : Stem; n : INT; END_VAR\nn := stem.Four();\nEND_PROGRAM\n")
    write("packages/top/test/top.st", "USING AxUnit.Assert;\nUSING X.Stem;\n{TestFixture}\nCLASS T\nVAR PROTECTED stem : Stem; END_VAR\n"
          "{Test}\nMETHOD PUBLIC Counts\nEqual(expected := 4, actual := stem.Four());\nEND_METHOD\nEND_CLASS\n")
    run("check", "packages/top")
    assert "1 of 1 passed" in run("test", "packages/top")
    run("new", "of_packages", "--from", "packages/top")
    (work / "packages/leaf/apax.yml").write_text("name: another\n")
    assert "there is no namespace 'X.Leaf'" in run("check", "packages/top", code=2)


def twincat(folder, kind, name, declaration, body="", members=""):
    ending = {"POU": "TcPOU", "GVL": "TcGVL", "DUT": "TcDUT"}[kind]
    code = f"<Implementation><ST><![CDATA[{body}]]></ST></Implementation>" if kind == "POU" else ""
    write(f"{folder}/{name}.{ending}",
          f'<?xml version="1.0" encoding="utf-8"?>\n<TcPlcObject Version="1.1.0.1"><{kind} Name="{name}">'
          f"<Declaration><![CDATA[{declaration}]]></Declaration>{code}{members}</{kind}></TcPlcObject>\n")


def method(declaration, body):
    return (f'<Method Name="m"><Declaration><![CDATA[{declaration}]]></Declaration>'
            f"<Implementation><ST><![CDATA[{body}]]></ST></Implementation></Method>")


def plcproj(path, title, files, libraries=()):
    listed = "".join(f'<Compile Include="{file}"/>' for file in files)
    used = "".join(f'<PlaceholderReference Include="{name}"><Namespace>{space}</Namespace></PlaceholderReference>' for name, space in libraries)
    write(path, f'<?xml version="1.0"?>\n<Project><PropertyGroup><Name>{title}</Name></PropertyGroup>\n<ItemGroup>{listed}</ItemGroup>'
          f"<ItemGroup>{used}</ItemGroup></Project>\n")


TASK = ('<?xml version="1.0"?>\n<TcPlcObject><Task Name="PlcTask"><CycleTime>10000</CycleTime><Priority>20</Priority>'
        "<PouCall><Name>MAIN</Name></PouCall></Task></TcPlcObject>\n")


def check_solution():
    """Two projects with programs of one name, one the other's library, found by a solution and in a folder; tests of them."""
    lib, app = "sln/lib/Lib", "sln/app/App"
    twincat(lib, "POU", "Ramp", "FUNCTION_BLOCK Ramp\nVAR_OUTPUT n : INT; END_VAR", "n := n + Sizes.step + far;")
    twincat(lib, "POU", "MAIN", "PROGRAM MAIN\nVAR ramp : Ramp; END_VAR", "ramp();")
    twincat(lib, "GVL", "Sizes", "{attribute 'qualified_only'}\nVAR_GLOBAL CONSTANT\n step : INT := 2;\nEND_VAR")
    twincat(lib, "GVL", "Far", "VAR_GLOBAL\n far : INT := 1;\nEND_VAR")
    plcproj(f"{lib}/Lib.plcproj", "Ramps", ["Ramp.TcPOU", "MAIN.TcPOU", "Sizes.TcGVL", "Far.TcGVL"])
    twincat(app, "POU", "MAIN", "PROGRAM MAIN\nVAR a : Ramp; b : R.Ramp; sum : INT; suite : Suite; alarms : Alarms; dry : UDINT; END_VAR",
            "a(); b(); sum := a.n + b.n + Sizes.step + R.Sizes.step; alarms(); dry := alarms.n; TcUnit.RUN();")
    twincat(app, "POU", "Faster", "FUNCTION_BLOCK Faster EXTENDS Elsewhere.Ramp;\nVAR m : INT;; END_VAR", "SUPER^();")
    twincat(app, "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nVAR r : Ramp; END_VAR",
            "TEST('counts'); r(); AssertEquals_INT(3, r.n, 'ramp'); TEST_FINISHED();")
    twincat(app, "POU", "Alarms", "FUNCTION_BLOCK Alarms\nVAR alarm : FB_TcAlarm; n : UDINT; END_VAR",
            "alarm.CreateEx(TC_EVENTS.Pumps.Dry, TRUE, 0); n := alarm.nEventId;")
    write(f"{app}/Pumps.tmc", '<?xml version="1.0"?>\n<TcModuleClass><DataTypes><DataType>'
          '<Name GUID="{665BAD9E-6191-FEB1-F9FA-D5AD80AC3506}">Pumps</Name><EventId><Name Id="#x1D">Dry</Name><Severity>Error</Severity></EventId>'
          '<EventId><Name Id="x">Odd</Name></EventId></DataType></DataTypes></TcModuleClass>\n')
    write(f"{app}/PlcTask.TcTTO", TASK)
    plcproj(f"{app}/App.plcproj", "App", ["Alarms.TcPOU", "MAIN.TcPOU", "Suite.TcPOU", "Faster.TcPOU", "PlcTask.TcTTO"], [("Ramps", "R"), ("TcUnit", "TcUnit")])
    write("sln/app/App.tsproj", '<?xml version="1.0"?>\n<TcSmProject><Project><Plc><Project File="App.xti"/></Plc></Project></TcSmProject>\n')
    write("sln/app/_Config/PLC/App.xti", '<?xml version="1.0"?>\n<TcSmItem><Project PrjFilePath="..\\..\\App\\App.plcproj"/></TcSmItem>\n')
    write("sln/app/App.sln", 'Project("{B1}") = "App", "App.tsproj", "{09}"\r\nEndProject\r\n')
    assert "ok  sln\n" in run("check", "sln")
    assert "ok  sln/app/App.sln\n" in run("check", "sln/app/App.sln", "--include-dir", "sln/lib")
    alone = run("check", "sln/app/App.sln", code=2)
    assert "3 of 7 POUs" in alone, alone
    assert "libraries that are not here: Ramps" in alone, alone
    check_classes_of_system()
    run("new", "both", "--from", "sln")
    text = (work / "both.yaml").read_text()
    assert 'sources: ["sln/app/App/App.plcproj", "sln/lib/Lib/Lib.plcproj"]' in text, text
    write("both.yaml", text + "expect:\n  - {at: end, MAIN.sum: 610}\n  - {at: end, MAIN.dry: 29}\n")
    run("run", "both.yaml", "--quiet")
    listed = '["sln/app/App/App.plcproj", "sln/lib/Lib/Lib.plcproj"]'
    write("turned.yaml", text.replace(listed, '["sln/lib/Lib/Lib.plcproj", "sln/app/App/App.plcproj"]'))
    run("check", "turned.yaml")
    assert run("test", "sln", "--list").strip() == "sln/app/App/App.plcproj: MAIN.suite: counts"
    for named in (["sln"], ["sln/app/App.sln", "--source", "sln/lib"], ["sln/app/App/App.plcproj", "--source", "sln/lib"]):
        assert "1 of 1" in run("test", *named), named
    two = run("new", "two", "--from", "sln/lib", code=0)
    assert "two.yaml" in two
    check_library_beside()


def check_library_beside():
    """A project's own library is found beside it in the folder of their solution."""
    twincat("pair/Lib", "POU", "Ramp", "FUNCTION_BLOCK Ramp\nVAR_OUTPUT n : INT; END_VAR", "n := n + 3;")
    plcproj("pair/Lib/Lib.plcproj", "Ramps", ["Ramp.TcPOU"])
    twincat("pair/App", "POU", "MAIN", "PROGRAM MAIN\nVAR a : Ramp; sum : INT; END_VAR", "a(); sum := a.n;")
    write("pair/App/PlcTask.TcTTO", TASK)
    plcproj("pair/App/App.plcproj", "App", ["MAIN.TcPOU", "PlcTask.TcTTO"], [("Ramps", "R")])
    write("pair/Pair.sln", 'Project("{B1}") = "App", "App.tsproj", "{09}"\r\nEndProject\r\n')
    run("new", "beside", "--from", "pair/App/App.plcproj")
    text = (work / "beside.yaml").read_text()
    assert 'sources: ["pair/App/App.plcproj", "pair/Lib/Lib.plcproj"]' in text, text
    write("beside.yaml", text + "expect:\n  - {at: end, MAIN.sum: 303}\n")
    run("run", "beside.yaml", "--quiet")


def check_named_programs():
    """A PROGRAM is its one instance, which any block names, also one that it holds; what no task runs is not run."""
    twincat("named", "POU", "MAIN", "PROGRAM MAIN\nVAR seed : INT := 5; cell : Cell; twice : ARRAY[1..2] OF Cell; got, copied : INT;\n"
            "far : LREAL := 1.5; near : REAL; shade : Shade; END_VAR",
            "Tc2_System.MEMMOVE(ADR(copied), ADR(seed), SIZEOF(seed)); near := far; IF seed = 5 OR seed = 105 THEN shade := copied; END_IF;\ncell(); twice[2](); Side(); got := Side.count + cell.seen + twice[2].seen; seed := seed + 1;")
    twincat("named", "POU", "Cell", "FUNCTION_BLOCK Cell\nVAR_OUTPUT seen : INT; END_VAR",
            "seen := MAIN.seed + 10 * Lists.other.seen + GVL_left(1, );",
            )
    twincat("named", "POU", "GVL_left", "FUNCTION GVL_left : INT\nVAR_INPUT a : INT; END_VAR\nVAR t : TON; END_VAR",
            "t(IN := TRUE, PT := T#0s); RETURN(a = 0); GVL_left := SEL(t.Q, 0, a);")
    twincat("named", "POU", "Side", "PROGRAM Side\nVAR count : INT; END_VAR", "count := count + 1; sum := Lists.speed + More.speed;")
    twincat("named", "GVL", "Lists", "VAR_GLOBAL\n cells : ARRAY[0..3] OF Cell;\n other : Cell;\n plain : INT := 3;\n speed : INT := 4;\nEND_VAR")
    twincat("named", "GVL", "More", "VAR_GLOBAL\n speed : INT := 20;\n sum : INT;\nEND_VAR")
    twincat("named", "DUT", "Shade", "TYPE Shade : (dark := 5, light := 105, more := 10#106, none := 4000); END_TYPE")
    write("named/PlcTask.TcTTO", TASK)
    assert "ok  named\n" in run("check", "named")
    run("new", "named", "--from", "named")
    text = (work / "named.yaml").read_text()
    assert "Side:" not in text, text
    write("named.yaml", text + "expect:\n  - {at: 5 ms, MAIN.got: 13}\n  - {at: end, MAIN.got: 313}\n  - {at: end, MAIN.seed: 106}\n"
          "  - {at: 5 ms, MAIN.shade: dark}\n  - {at: end, globals.sum: 24}\n  - {at: end, MAIN.shade: light}\n")
    run("run", "named.yaml", "--quiet")
    run("run", "named.yaml", "--quiet", "--no-native")
    twincat("named", "POU", "Side", "PROGRAM Side\nVAR count : INT; END_VAR", "count := count + speed; sum := More.speed;")
    said = run("check", "named", code=2)
    assert "error[L0909]: 'speed' stands in several lists" in said and "More.TcGVL" in said and "Lists.TcGVL" in said, said


def check_qualified_names():
    """What has the attribute 'qualified_only' takes no name from another list, nor an enumeration's value from a variable."""
    only = "{attribute 'qualified_only'}\n"
    twincat("only", "GVL", "GVL", only + "VAR_GLOBAL\n Speed : INT := 7;\nEND_VAR")
    twincat("only", "GVL", "Others", "VAR_GLOBAL\n Speed : INT := 9;\n Ready : INT := 5;\nEND_VAR")
    twincat("only", "DUT", "E_State", only + "TYPE E_State : (Init, Ready, Speed := 100); END_TYPE")
    twincat("only", "DUT", "E_Other", only + "TYPE E_Other : (Ready := 50); END_TYPE")
    twincat("only", "POU", "FB_Names", "FUNCTION_BLOCK FB_Names\nVAR plain, listed, own, state : INT; END_VAR",
            "plain := Speed; listed := GVL.Speed; own := Ready; state := E_State.Ready + E_Other.Ready;")
    write("only/names_test.st", "TEST 'names'\nVAR f : FB_Names; END_VAR\nf();\nASSERT_EQ(f.plain, 9);\nASSERT_EQ(f.listed, 7);\n"
          "ASSERT_EQ(f.own, 5);\nASSERT_EQ(f.state, 51);\nEND_TEST\n")
    assert "1 of 1 passed" in run("test", "only")
    attributes = ('<addData><data name="http://www.3s-software.com/plcopenxml/attributes" handleUnknown="implementation"><Attributes>'
                  '<Attribute Name="qualified_only" Value=""/><Attribute Name="strict" Value=""/></Attributes></data></addData>')
    values = lambda *names: "".join(f'<value name="{name}"/>' for name in names)
    write("named_values/p.xml",
          '<?xml version="1.0" encoding="utf-8"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0200"><types><dataTypes>'
          f'<dataType name="E_State"><baseType><enum><values>{values("Init", "Ready")}</values></enum></baseType>{attributes}</dataType>'
          '</dataTypes><pous><pou name="FB_Names" pouType="functionBlock"><interface><localVars><variable name="own"><type><INT/></type></variable>'
          '<variable name="state"><type><INT/></type></variable></localVars></interface><body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">'
          'own := Ready; state := E_State.Ready;</xhtml></ST></body></pou></pous></types><instances><configurations/></instances>'
          '<addData><data name="http://www.3s-software.com/plcopenxml/globalvars" handleUnknown="implementation"><globalVars name="GVL">'
          '<variable name="Ready"><type><INT/></type><initialValue><simpleValue value="7"/></initialValue></variable></globalVars></data></addData></project>\n')
    write("named_values/names_test.st", "TEST 'names'\nVAR f : FB_Names; END_VAR\nf();\nASSERT_EQ(f.own, 7);\nASSERT_EQ(f.state, 1);\nEND_TEST\n")
    said = run("test", "named_values")
    assert "1 of 1 passed" in said, said


def check_openplc_editor():
    """The folder of a project, or its project.json: tasks, ladders with their places, and nothing of what the editor builds."""
    shutil.copytree(pathlib.Path(__file__).parent / "cases" / "openplc_editor_4", work / "editor4")
    (work / "editor4/program.yaml").unlink()
    write("editor4/build/Simulator/src/program.st", "PROGRAM main\nEND_PROGRAM\n")
    assert "ok" in run("check", "--strict", "editor4/")
    assert "ok" in run("check", "--strict", "editor4/project.json")
    run("new", "lamp", "--from", "editor4/")
    made = (work / "lamp.yaml").read_text()
    assert "task0: {every: 20 ms" in made and "main: {type: main, task: task0}" in made, made
    run("run", "lamp.yaml", "--include-dir", "editor4/")
    ladder = work / "editor4/pous/programs/main.ld"
    text = ladder.read_text()
    ladder.write_text(text.replace('"name": "held"', '"name": "hled"'))
    line = text[:text.index('"name": "held"')].count("\n") + 1
    said = run("check", "editor4/", code=2)
    assert f"main.ld:{line}:" in said and "'hled'" in said, said
    ladder.write_text(text.replace('"variant": "set"', '"variant": "sett"'))
    assert "'sett' is no kind of coil" in run("check", "editor4/", code=2)
    ladder.write_text(text[:text.index("{")])
    assert "has no rungs" in run("check", "editor4/", code=2)
    ladder.write_text(text)
    native = "FUNCTION_BLOCK {0}\nVAR_OUTPUT\n\tpressed : bool;\nEND_VAR\n{1}\n"
    write("editor4/pous/function-blocks/Button.cpp", native.format("Button", "/* C */\n#include <Arduino.h>\nvoid setup() { pinMode(18, INPUT); }\nvoid loop() {}"))
    write("editor4/pous/function-blocks/Cloud.py", native.format("Cloud", "def block_loop():\n    pressed = True"))
    write("editor4/pous/programs/asks.st", "PROGRAM asks\nVAR\n\tbutton : Button;\n\tcloud : Cloud;\n\tis_down : BOOL;\nEND_VAR\nbutton(pressed => is_down);\ncloud();\nEND_PROGRAM\n")
    said = run("check", "editor4/")
    for name, language in (("Button.cpp:1:16", "'Button' is written in C++"), ("Cloud.py:1:16", "'Cloud' is written in Python")):
        assert f"{name}: warning" in said and f"{language}, so this does nothing" in said, said
    write("editor4/pous/functions/drawn.fbd", "FUNCTION drawn : INT\n\n{\n}\nEND_FUNCTION\n")
    assert "drawn.fbd:1:1: error" in run("check", "editor4/", code=2)


def check_openplc_files():
    """One file with RESOURCE .. ON PLC has all of its folder read as OpenPLC's: words count words, INT_TO_TIME seconds."""
    write("split/configuration.st", "CONFIGURATION Line\n  RESOURCE Res0 ON PLC\n    TASK task0(INTERVAL := T#20ms, PRIORITY := 0);\n"
          "    PROGRAM instance0 WITH task0 : Counts;\n  END_RESOURCE\nEND_CONFIGURATION\n")
    write("split/globals.st", "VAR_GLOBAL\n  first AT %QW0 : INT;\n  second AT %QW1 : INT;\nEND_VAR\n")
    write("split/counts.st", "PROGRAM Counts\nVAR_EXTERNAL first, second : INT; END_VAR\nVAR waited : TIME; END_VAR\n"
          "first := 258;\nsecond := 772;\nwaited := INT_TO_TIME(5);\nEND_PROGRAM\n")
    assert "L0926" not in run("check", "split")
    run("new", "split", "--from", "split")
    made = (work / "split.yaml").read_text()
    (work / "split.yaml").write_text(re.sub(r"signals: \[.*?\]", "signals: ['%QW0', '%QW1', Counts.waited]", made))
    run("run", "split.yaml", "--trace", "split.csv")
    values = (work / "split.csv").read_text().splitlines()[-1].split(",")[-3:]
    assert values == ["258", "772", "5000000000"], values


def check_coils_in_series():
    """Of MatIEC's editors each has what comes to the first one, however many there are."""
    coils = '<leftPowerRail localId="0"/>' + "".join(
        f'<coil localId="{i + 1}"><connectionPointIn><connection refLocalId="{i}"/></connectionPointIn><variable>a</variable></coil>'
        for i in range(2000))
    write("series.xml", drawn(coils))
    run("check", "series.xml")


def check_lost_bases():
    """What a base that is not here would have is told by no message but the one of the library."""
    twincat("lost", "POU", "Sensor", "FUNCTION_BLOCK Sensor EXTENDS FB_Strange\nVAR own : INT; END_VAR", "own := 1;")
    twincat("lost", "DUT", "Data", "TYPE Data EXTENDS ST_Strange : STRUCT own : INT; END_STRUCT END_TYPE")
    twincat("lost", "POU", "MAIN", "PROGRAM MAIN\nVAR sensor : Sensor := (limit := 3); data : Data; END_VAR", "sensor(fault := 2, OUT => data.far); data.own := data.other;")
    plcproj("lost/Lost.plcproj", "Lost", ["Sensor.TcPOU", "Data.TcDUT", "MAIN.TcPOU"], [("Tc9_Strange", "Tc9_Strange")])
    said = run("check", "lost", code=2)
    assert said.count("error[") == 1 and "FB_Strange" in said and "ST_Strange" in said, said


def check_left_over():
    """Mistakes in what no task uses are warnings, and the rest runs; axes that blocks keep for themselves are blocks of the program."""
    twincat("rest", "POU", "MAIN", "PROGRAM MAIN\nVAR station : Station; END_VAR", "station(); GVL.spare();")
    twincat("rest", "POU", "Station", "FUNCTION_BLOCK Station\nVAR feeds : ARRAY[1..2] OF Feed; END_VAR", "feeds[1](go := TRUE); feeds[2]();")
    twincat("rest", "POU", "Feed", "FUNCTION_BLOCK Feed\nVAR_INPUT go : BOOL; END_VAR\nVAR_OUTPUT axis : AXIS_REF; END_VAR\n"
            "VAR power : MC_Power; move : MC_MoveAbsolute; top : MC_ReadParameter; END_VAR",
            "power(Axis := axis, Enable := TRUE, Enable_Positive := TRUE, Enable_Negative := TRUE);"
            "move(Axis := axis, Execute := go AND power.Status, Position := 5.0, Velocity := 50.0);"
            "top(Axis := axis, Enable := TRUE, ParameterNumber := MC_AxisParameter.CommandedPosition, ReadMode := READMODE_CYCLIC);")
    twincat("rest", "POU", "Station_OLD", "FUNCTION_BLOCK Station_OLD\nVAR feed : Feed; END_VAR", "feed.gone := TRUE; missing();")
    twincat("rest", "GVL", "GVL", "VAR_GLOBAL\n spare : Feed;\nEND_VAR")
    twincat("rest", "POU", "Drawn", "FUNCTION_BLOCK Drawn\nVAR_OUTPUT n : INT; END_VAR")
    drawn_text = (work / "rest/Drawn.TcPOU").read_text().replace("<ST><![CDATA[]]></ST>", "<UML/>")
    write("rest/Drawn.TcPOU", drawn_text)
    write("rest/PlcTask.TcTTO", TASK)
    files = ["MAIN.TcPOU", "Station.TcPOU", "Feed.TcPOU", "Station_OLD.TcPOU", "Drawn.TcPOU", "GVL.TcGVL", "PlcTask.TcTTO"]
    plcproj("rest/Rest.plcproj", "Rest", files, [("Tc9_Strange", "Tc9_Strange")])
    said = run("check", "rest")
    assert "ok  rest\n" in said and "Station_OLD.TcPOU" in said and "in what nothing here uses" in said, said
    assert "the body of 'Drawn' is drawn (UML), and only Structured Text, LD, FBD, SFC and CFC are read, in what nothing here uses" in said, said
    run("new", "rest", "--from", "rest")
    text = (work / "rest.yaml").read_text()
    assert '"station.feeds[1].axis": MAIN_station_feeds_1__axis' in text and "spare.axis: globals_spare_axis" in text, text
    write("rest.yaml", text + "expect:\n  - {at: end, MAIN_station_feeds_1__axis.position: 5 mm, within: 1e-9 mm}\n"
          "  - {at: end, MAIN_station_feeds_2__axis.position: 0 mm}\n  - {at: end, 'MAIN.station.feeds[1].top.Value': 5}\n")
    run("run", "rest.yaml", "--quiet")
    twincat("rest", "POU", "MAIN", "PROGRAM MAIN\nVAR station : Station; old : Station_OLD; END_VAR", "station(); old();")
    assert "has no 'gone'" in run("check", "rest", code=2)
    twincat("rest", "POU", "MAIN", "PROGRAM MAIN\nVAR drawn : Drawn; END_VAR", "drawn();")
    said = run("check", "rest", code=2)
    assert said.count("error[") == 1 and "'Drawn' is drawn" in said, said
    twincat("rest", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nVAR drawn : Drawn; END_VAR",
            "TEST('counts'); drawn(); AssertEquals_INT(0, drawn.n, 'n'); TEST_FINISHED();")
    twincat("rest", "POU", "MAIN", "PROGRAM MAIN\nVAR suite : Suite; END_VAR", "TcUnit.RUN();")
    plcproj("rest/Rest.plcproj", "Rest", [*files, "Suite.TcPOU"], [("TcUnit", "TcUnit")])
    assert "'Drawn' is drawn" in run("test", "rest", code=1)


POWER = "Enable := TRUE, Enable_Positive := TRUE, Enable_Negative := TRUE"


def moved(axis, power, move, distance):
    """Switches an axis on and moves it."""
    return (f"{power}(Axis := {axis}, {POWER});\n"
            f"{move}(Axis := {axis}, Execute := {power}.Status, Distance := {distance}, Velocity := 100.0);\n")


def check_axes_of_lists():
    """Axes of one name in two lists are two."""
    for name in ("Feed", "Cut", "Saw"):
        axis = "Blade" if name == "Saw" else "Axis"
        twincat("lists", "GVL", f"GVL_{name}", "{attribute 'qualified_only'}\nVAR_GLOBAL\n " + axis + " : AXIS_REF;\nEND_VAR")
    twincat("lists", "POU", "MAIN", "PROGRAM MAIN\nVAR p, q, r : MC_Power; a, b, d : MC_MoveRelative; x, y : LREAL; END_VAR",
            moved("GVL_Feed.Axis", "p", "a", 10.0) + moved("GVL_Cut.Axis", "q", "b", -20.0) + moved("GVL_Saw.Blade", "r", "d", 5.0) +
            "x := GVL_Feed.Axis.NcToPlc.ActPos; y := GVL_Cut.Axis.NcToPlc.ActPos;")
    write("lists/PlcTask.TcTTO", TASK)
    plcproj("lists/Lists.plcproj", "Lists", ["GVL_Feed.TcGVL", "GVL_Cut.TcGVL", "GVL_Saw.TcGVL", "MAIN.TcPOU", "PlcTask.TcTTO"])
    run("new", "lists", "--from", "lists")
    text = (work / "lists.yaml").read_text()
    for axis in ("GVL_Feed_Axis", "GVL_Cut_Axis", "Blade"):
        assert re.search(rf"^  {axis}: {{type: axis, .*needs_power: true", text, re.M), text
    write("lists.yaml", text + "expect:\n  - {at: end, MAIN.x: 10, within: 1e-9}\n  - {at: end, MAIN.y: -20, within: 1e-9}\n"
          "  - {at: end, Blade.position: 5 mm, within: 1e-9 mm}\n")
    run("run", "lists.yaml", "--quiet")
    twincat("lists", "POU", "MAIN", "PROGRAM MAIN\nVAR p, q, r : MC_Power; END_VAR",
            "p(Axis := Axis); q(Axis := GVL_Feed.Axis); r(Axis := GVL_Cut.Axis);")
    assert "'Axis' stands in several lists" in run("check", "lists", code=2)


def check_axes_of_groups():
    """A group of a device tree has axes, and a slave is not stopped by limits that nobody has given."""
    write("grouped.st", "PROGRAM PLC_PRG\nVAR p : SMC_GroupPower; e : MC_GroupEnable; m : MC_MoveLinearAbsolute := (Velocity := 400, "
          "Acceleration := 4000, Deceleration := 4000, Jerk := 100000, Position := (c := (X := 30, Y := 40))); END_VAR\n"
          "p(AxisGroup := Robot, Enable := TRUE, bRegulatorOn := TRUE, bDriveStart := TRUE);\n"
          "e(AxisGroup := Robot, Execute := p.Status);\nm(AxisGroup := Robot, Execute := e.Done);\nEND_PROGRAM\n")
    run("new", "grouped", "--from", "grouped.st")
    text = (work / "grouped.yaml").read_text()
    assert "Robot_z_member: {type: MC_AddAxisToGroup, task: main, AxesGroup: Robot, Axis: Robot_z, IdentInGroup: 3, Execute: true}" in text, text
    write("grouped.yaml", text + "expect:\n  - {at: end, Robot_x.position: 30 mm}\n  - {at: end, Robot_y.position: 40 mm}\n"
          "  - {at: 600 ms, PLC_PRG.m.Done: true}\n")
    run("run", "grouped.yaml", "--quiet")


def check_axes_of_siemens():
    """Axes of Siemens need homing as well as power, until who knows the encoder takes that out."""
    write("homed.scl", "FUNCTION_BLOCK \"P\"\nVAR w : MC_POWER; a : MC_MOVEABSOLUTE; END_VAR\nBEGIN\n#w(Axis := \"Feed\", Enable := TRUE);\n"
          "#a(Axis := \"Feed\", Execute := #w.Status, Position := 5.0, Velocity := 10.0);\nEND_FUNCTION_BLOCK\n")
    run("new", "homed", "--from", "homed.scl")
    text = (work / "homed.yaml").read_text()
    assert "Feed: {type: axis, task: main, needs_power: true, needs_homing: true}" in text, text
    write("homed.yaml", text + "expect:\n  - {at: end, p.a.Error: true}\n")
    run("run", "homed.yaml", "--quiet")
    write("beside/lib/own.st", "NAMESPACE Own\nFUNCTION Twice : INT\nVAR_INPUT a : INT; END_VAR\nTwice := 2 * a;\nEND_FUNCTION\nEND_NAMESPACE\n")
    write("beside/tests/own_test.st", "TEST 'twice'\n ASSERT_EQ(Own.Twice(2), 4);\nEND_TEST\n")
    folder = str(work / "beside") + "/"
    assert f"--source {folder} looks there, too" in run("test", str(work / "beside/tests"), code=1)
    assert "looks there" not in run("test", str(work / "beside/tests"), "--source", str(work / "beside"))


def check_called_programs():
    """Axes in a PROGRAM that MAIN calls, and in instances in it; what is called is not scanned by its task as well."""
    twincat("called", "POU", "MAIN", "PROGRAM MAIN\nVAR p : MC_Power; END_VAR", "Axes();")
    twincat("called", "POU", "Axes", "PROGRAM Axes\nVAR own : AXIS_REF; p : MC_Power; a : MC_MoveRelative; "
            "cells : ARRAY[1..2] OF Cell; calls : INT; END_VAR",
            moved("own", "p", "a", 3.0) + "cells[1](way := 4.0); cells[2](way := 8.0); calls := calls + 1;")
    twincat("called", "POU", "Cell", "FUNCTION_BLOCK Cell\nVAR_INPUT way : LREAL; END_VAR\n"
            "VAR axis : AXIS_REF; p : MC_Power; a : MC_MoveRelative; END_VAR", moved("axis", "p", "a", "way"))
    twincat("called", "POU", "Other", "PROGRAM Other\nVAR n : INT; END_VAR", "n := n + 1;")
    write("called/PlcTask.TcTTO", TASK)
    plcproj("called/Called.plcproj", "Called", ["Axes.TcPOU", "Cell.TcPOU", "MAIN.TcPOU", "Other.TcPOU", "PlcTask.TcTTO"])
    run("new", "called", "--from", "called")
    text = (work / "called.yaml").read_text()
    assert 'Axes: {type: Axes, task: PlcTask, called: true, own: Axes_own, "cells[1].axis": Axes_cells_1__axis' in text, text
    assert "Other:" not in text, text
    write("called.yaml", text + "expect:\n  - {at: end, Axes_own.position: 3 mm, within: 1e-9 mm}\n  - {at: end, Axes.calls: 101}\n"
          "  - {at: end, Axes_cells_2__axis.position: 8 mm, within: 1e-9 mm}\n")
    run("run", "called.yaml", "--quiet")
    write("called.yaml", text.replace("MAIN: {type: MAIN, task: PlcTask}", "MAIN: {type: MAIN, task: PlcTask, called: true}"))
    said = run("check", "called.yaml", code=2)
    assert "error[L0213]: 'MAIN' (MAIN) is 'called', and no block's sources name it" in said, said


def check_axes_of_suites():
    """Each AXIS_REF that a suite, what it tests or a list keeps has an axis."""
    twincat("suites", "GVL", "GVL", "{attribute 'qualified_only'}\nVAR_GLOBAL\n all : ARRAY[1..2] OF AXIS_REF;\n whole : Machine;\nEND_VAR")
    twincat("suites", "DUT", "Machine", "TYPE Machine : STRUCT axis : AXIS_REF; END_STRUCT END_TYPE")
    twincat("suites", "POU", "Inner", "FUNCTION_BLOCK Inner\nVAR axis : AXIS_REF; p : MC_Power; a : MC_MoveRelative; END_VAR\n"
            "VAR_OUTPUT done : BOOL; END_VAR", moved("axis", "p", "a", 7.0) + "done := a.Done AND axis.NcToPlc.ActPos > 6.99;")
    axes = ["GVL.all[1]", "GVL.all[2]", "GVL.whole.axis", "own", "MAIN.of_main", "Called.of_called"]
    body = "inner();\n" + "".join(moved(axis, f"p[{i}]", f"a[{i}]", 1.5 * i + 1) for i, axis in enumerate(axes)) + "done := inner.done;\n"
    body += "".join(f"done := done AND a[{i}].Done AND ABS({axis}.NcToPlc.ActPos - {1.5 * i + 1}) < 0.01;\n" for i, axis in enumerate(axes))
    twincat("suites", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nVAR own : AXIS_REF; inner : Inner; done : BOOL;\n"
            f"p : ARRAY[0..{len(axes) - 1}] OF MC_Power; a : ARRAY[0..{len(axes) - 1}] OF MC_MoveRelative; END_VAR",
            "TEST('moves all of them');\n" + body + "IF done THEN TEST_FINISHED(); END_IF")
    twincat("suites", "POU", "MAIN", "PROGRAM MAIN\nVAR suite : Suite; of_main : AXIS_REF; END_VAR", "TcUnit.RUN();")
    twincat("suites", "POU", "Called", "PROGRAM Called\nVAR of_called : AXIS_REF; END_VAR")
    write("suites/PlcTask.TcTTO", TASK)
    plcproj("suites/Suites.plcproj", "Suites", ["GVL.TcGVL", "Machine.TcDUT", "Inner.TcPOU", "Suite.TcPOU", "Called.TcPOU", "MAIN.TcPOU", "PlcTask.TcTTO"],
            [("TcUnit", "TcUnit")])
    assert "1 of 1 passed" in run("test", "suites")
    assert "1 of 1 passed" in run("test", "suites", "--no-native")
    twincat("suites", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite", "m();",
            method("METHOD m\nVAR lost : AXIS_REF; END_VAR\nVAR_INST p : MC_Power; END_VAR",
                   f"TEST('waits'); p(Axis := lost, {POWER}); IF p.Status THEN TEST_FINISHED(); END_IF"))
    said = run("test", "suites", code=1)
    assert "TEST_FINISHED is missing; 'lost' in line" in said and "has no axis, as it is of a call: declare it in VAR of 'Suite'" in said, said


def check_suites_of_programs():
    """Suites stand in any program that the one with RUN calls, or that a task runs beside it; their tests are told of the task."""
    twincat("apart", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nVAR_INPUT ready : BOOL; END_VAR\nVAR n, first : UDINT; END_VAR",
            "TEST('counts'); n := n + 1; IF n = 1 THEN first := _TaskInfo[GETCURTASKINDEXEX()].CycleCount; END_IF\n"
            "AssertEquals_UDINT(100000, _TaskInfo[GETCURTASKINDEXEX()].CycleTime, 'in 100 ns');\n"
            "IF n = 11 THEN AssertEquals_UDINT(10, _TaskInfo[GETCURTASKINDEXEX()].CycleCount - first, 'cycles'); AssertTrue(ready, 'ready');\n"
            "TEST_FINISHED(); END_IF")
    twincat("apart", "POU", "Group", "FUNCTION_BLOCK Group\nVAR suites : ARRAY[1..2] OF Suite := [(ready := TRUE), (ready := TRUE)]; END_VAR")
    twincat("apart", "POU", "Called", "PROGRAM Called\nVAR group : Group; END_VAR")
    twincat("apart", "POU", "Beside", "PROGRAM Beside\nVAR suite : Suite; END_VAR", "suite.ready := TRUE;")
    twincat("apart", "POU", "Else", "PROGRAM Else\nVAR n : INT; END_VAR", "this is not understood")
    twincat("apart", "POU", "MAIN", "PROGRAM MAIN", "Called();\nTcUnit.RUN();")
    write("apart/PlcTask.TcTTO", TASK)
    write("apart/Other.TcTTO", TASK.replace("PlcTask", "Other").replace("<Name>MAIN</Name></PouCall>", "<Name>Beside</Name></PouCall><PouCall><Name>Else</Name></PouCall>"))
    plcproj("apart/Apart.plcproj", "Apart", ["Suite.TcPOU", "Group.TcPOU", "Called.TcPOU", "Beside.TcPOU", "Else.TcPOU", "MAIN.TcPOU", "PlcTask.TcTTO", "Other.TcTTO"],
            [("TcUnit", "TcUnit")])
    assert "3 of 3 passed" in run("test", "apart")
    listed = run("test", "apart", "--list")
    printed = re.search(r"(\S+: Called\.group\.suites\[2\]: counts)", run("test", "apart"))[1]
    assert "1 of 1 passed" in run("test", "apart", "--filter", re.escape(printed))
    assert all(f": {name}: counts\n" in listed for name in ("Called.group.suites[1]", "Called.group.suites[2]", "Beside.suite")), listed


def check_failed_suites_of_a_run():
    """Whoever runs or debugs suites as a program is told what `lineshaft test` tells: the user's line, what was expected, in which test."""
    write("suites/suite.st", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nTEST('adds');\nAssertEquals_INT(Expected := 5, Actual := 2 + 2, Message := 'sum');\n"
          "TEST_FINISHED();\nEND_FUNCTION_BLOCK\nPROGRAM Main\nVAR suite : Suite; END_VAR\nTcUnit.RUN();\nEND_PROGRAM\n")
    write("suites/run.yaml", "lineshaft: 1\ntasks: {main: {every: 10 ms}}\nsources: [suite.st]\nblocks: {m: {type: Main, task: main}}\nrun: {for: 100 ms}\n")
    told = run("run", "suites/run.yaml", code=3)
    for part in "suites/suite.st:3:", "expected 5, found 4; sum", "in the test 'adds'", "(assertion)":
        assert part in told, (part, told)
    assert "at blocks/libraries" not in told, told


def check_vendored_tcunit():
    """TcUnit's own sources stand beside the project that is tested by it: the library of that name runs the suites."""
    twincat("vendored/TcUnit", "POU", "FB_TestSuite", "FUNCTION_BLOCK FB_TestSuite\nVAR own : FB_OfFramework; END_VAR")
    twincat("vendored/TcUnit", "POU", "TEST", "FUNCTION TEST : BOOL\nVAR_INPUT name : STRING; END_VAR")
    plcproj("vendored/TcUnit/TcUnit.plcproj", "TcUnit", ["FB_TestSuite.TcPOU", "TEST.TcPOU"])
    twincat("vendored/own", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite",
            "TEST('adds'); AssertEquals_INT(4, 2 + 2, 'sum'); TEST_FINISHED();")
    twincat("vendored/own", "POU", "MAIN", "PROGRAM MAIN\nVAR suite : Suite; END_VAR", "TcUnit.RUN();")
    plcproj("vendored/own/Own.plcproj", "Own", ["Suite.TcPOU", "MAIN.TcPOU"], [("TcUnit", "TcUnit")])
    assert "1 of 1 passed" in run("test", "vendored")
    assert "1 of 1 passed" in run("test", "vendored/own/Own.plcproj", "--source", "vendored/TcUnit")


def check_suites_of_lists():
    """A list of globals that no program names has suites, too; what they use may be a block with VAR_GENERIC of another file; RUN has any letters."""
    twincat("listed", "POU", "Stack", "FUNCTION_BLOCK Stack\nVAR_GENERIC CONSTANT length : INT := 5; END_VAR\nVAR_OUTPUT size : INT; END_VAR\n"
            "VAR a : ARRAY[1..length] OF INT; END_VAR", "size := UPPER_BOUND(a, 1);")
    twincat("listed", "POU", "Suite", "FUNCTION_BLOCK Suite EXTENDS TcUnit.FB_TestSuite\nVAR small : Stack<3>; large : Stack<10>; END_VAR",
            "TEST('has its size'); small(); large(); AssertEquals_INT(3, small.size, ''); AssertEquals_INT(10, large.size, ''); TEST_FINISHED();")
    twincat("listed", "GVL", "Suites", "{attribute 'qualified_only'}\nVAR_GLOBAL suite : Suite; END_VAR")
    twincat("listed", "POU", "MAIN", "PROGRAM MAIN", "TcUnit.Run();")
    plcproj("listed/Listed.plcproj", "Listed", ["Stack.TcPOU", "Suite.TcPOU", "Suites.TcGVL", "MAIN.TcPOU"], [("TcUnit", "TcUnit")])
    said = run("test", "listed")
    assert "Suites.suite: has its size" in said and "1 of 1 passed" in said, said


def check_axes_that_are_referred_to():
    """A pointer or a reference to an axis of a list, or to what a method was given, is to that axis from then on."""
    twincat("referred", "GVL", "GVL", "VAR_GLOBAL\n one, two : AXIS_REF;\nEND_VAR")
    members = "".join(method(*each).replace('Name="m"', f'Name="{name}"') for name, each in {
        "Take": ("METHOD Take\nVAR_IN_OUT axis : AXIS_REF; END_VAR", "Keep(axis := axis);"),
        "Keep": ("METHOD Keep\nVAR_IN_OUT axis : AXIS_REF; END_VAR", "kept REF= axis; pointed := ADR(axis);")}.items())
    twincat("referred", "POU", "Drive", "FUNCTION_BLOCK Drive\nVAR_INPUT given : REFERENCE TO AXIS_REF; END_VAR\n"
            "VAR kept : REFERENCE TO AXIS_REF; pointed : POINTER TO AXIS_REF; p, q, r : MC_Power; a, b, d : MC_MoveRelative; END_VAR",
            "IF __ISVALIDREF(given) THEN\n" + moved("given", "p", "a", 10.0) + "END_IF\nIF __ISVALIDREF(kept) THEN\n" +
            moved("kept", "q", "b", 20.0) + "END_IF\nIF pointed <> 0 AND b.Done THEN\n" + moved("pointed^", "r", "d", 5.0) + "END_IF", members)
    twincat("referred", "POU", "MAIN", "PROGRAM MAIN\nVAR own : AXIS_REF; of_list, of_pointer, of_own, of_two : Drive; "
            "pointer : POINTER TO AXIS_REF; taken, same : BOOL; END_VAR",
            "IF NOT taken THEN of_own.Take(axis := own); of_two.Take(axis := GVL.two); taken := TRUE; END_IF\n"
            "of_list(given := one); pointer := ADR(GVL.two); IF of_two.d.Done THEN of_pointer(given := pointer^); END_IF of_own(); of_two();\n"
            "same := of_two.pointed = ADR(GVL.two) AND of_own.pointed = ADR(own);")
    write("referred/PlcTask.TcTTO", TASK)
    plcproj("referred/Referred.plcproj", "Referred", ["GVL.TcGVL", "Drive.TcPOU", "MAIN.TcPOU", "PlcTask.TcTTO"])
    run("new", "referred", "--from", "referred")
    text = (work / "referred.yaml").read_text()
    write("referred.yaml", text.replace("run: {for: 1 s}", "run: {for: 3 s}") + "expect:\n  - {at: end, one.position: 10 mm, within: 1e-9 mm}\n"
          "  - {at: end, two.position: 35 mm, within: 1e-9 mm}\n  - {at: end, MAIN_own.position: 25 mm, within: 1e-9 mm}\n"
          "  - {at: end, MAIN.same: true}\n")
    run("run", "referred.yaml", "--quiet")
    run("run", "referred.yaml", "--quiet", "--no-native")


def check_unions_of_codesys():
    """A UNION of CODESYS stands beside its units, as one of its additions."""
    union = ('<union name="Both"><variable name="whole"><type><DINT/></type></variable><variable name="parts"><type><array>'
             '<dimension lower="1" upper="4"/><baseType><BYTE/></baseType></array></type></variable></union>')
    unit = ('<pou name="P" pouType="program"><interface><localVars><variable name="both"><type><derived name="Both"/></type></variable>'
            '<variable name="low"><type><BYTE/></type></variable></localVars></interface>'
            f'{st("both.whole := 16#01020304; low := both.parts[1];")}</pou>')
    data = "".join(f'<data name="{CODESYS}{kind}" handleUnknown="implementation">{text}</data>'
                   for kind, text in (("union", union), ("pou", unit)))
    write("union.xml", '<?xml version="1.0" encoding="utf-8"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0200"><types><dataTypes/><pous/></types>'
          f'{addition("application", f"<resource name=@Application@><addData>{data}</addData></resource>".replace("@", chr(34)))}</project>\n')
    assert "ok  union.xml" in run("check", "union.xml")
    run("new", "union", "--from", "union.xml")
    write("union.yaml", (work / "union.yaml").read_text() + "expect:\n  - {at: end, P.low: 4}\n")
    run("run", "union.yaml", "--quiet")


def check_encrypted():
    write("shut/Shut.plcproj", b"TcEncryptedFile~s\0\xf5dhJ")
    told = run("check", "shut", code=2)
    assert "Shut.plcproj:1:1" in told and "is encrypted by TwinCAT" in told, told


def check_foreign_names():
    """A source with names of libraries that are not here is none without a mistake."""
    twincat("strange", "POU", "A", "FUNCTION_BLOCK A\nVAR x : FB_Strange; END_VAR", "x();")
    twincat("strange", "POU", "B", "FUNCTION_BLOCK B\nVAR x : INT; END_VAR", "x := 1;")
    plcproj("strange/P.plcproj", "P", ["A.TcPOU", "B.TcPOU"], [("Tc9_Strange", "Tc9_Strange")])
    page = run("check", "strange", code=2)
    assert "strange: 1 of 2 POUs, types and lists have no mistake" in page and "FB_Strange (strange/A.TcPOU:3)" in page, page


def check_hostile():
    contacts = 20000
    chain = '<leftPowerRail localId="0"/>' + "".join(
        f'<contact localId="{i + 1}"><connectionPointIn><connection refLocalId="{i}"/></connectionPointIn><variable>a</variable></contact>'
        for i in range(contacts)) + (f'<coil localId="{contacts + 1}"><connectionPointIn><connection refLocalId="{contacts}"/>'
                                     "</connectionPointIn><variable>b</variable></coil>")
    doubling = '<inVariable localId="0"><expression>unknown.x</expression></inVariable>' + "".join(
        f'<block localId="{i + 1}" typeName="Strange"><inputVariables>' + "".join(
            f'<variable formalParameter="{pin}"><connectionPointIn><connection refLocalId="{i}"/></connectionPointIn></variable>' for pin in "ab")
        + '</inputVariables><outputVariables><variable formalParameter="OUT"><connectionPointOut/></variable></outputVariables></block>'
        for i in range(60)) + ('<outVariable localId="70"><connectionPointIn><connection refLocalId="60"/></connectionPointIn>'
                               "<expression>b</expression></outVariable>")
    around = ('<connector localId="1" name="c"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></connector>'
              '<continuation localId="2" name="c"/><coil localId="3"><connectionPointIn><connection refLocalId="2"/></connectionPointIn>'
              "<variable>b</variable></coil>")
    branches = "".join(f'<selectionDivergence localId="{i}"><connectionPointIn><connection refLocalId="{(i + 1) % 50}"/><connection '
                       f'refLocalId="{(i + 2) % 50}"/></connectionPointIn></selectionDivergence>' for i in range(50)) + (
        '<transition localId="60"><connectionPointIn><connection refLocalId="0"/></connectionPointIn></transition>')
    growing = "".join(f'<!ENTITY e{i + 1} "{"&e%d;" % i * 10}">' for i in range(12))
    start = drawn(RUNG)
    cases = {
        "entities": start.replace("?>\n", f'?>\n<!DOCTYPE project [<!ENTITY e0 "ha">{growing}]>\n', 1).replace(">b<", ">&e12;<"),
        "file": start.replace("?>\n", '?>\n<!DOCTYPE project [<!ENTITY f SYSTEM "/etc/passwd">]>\n', 1).replace(">b<", ">&f;<"),
        "deep tags": start.replace("<LD>", "<LD>" + "<a>" * 400_000),
        "deep types": start.replace("<BOOL/>", "<array><baseType>" * 100_000 + "<BOOL/>" + "</baseType></array>" * 100_000, 1),
        "large": start + " " * (17 << 20),
        "chain": drawn(chain), "doubling": drawn(doubling, "FBD"), "around": drawn(around, "FBD"), "branches": drawn(branches, "SFC"),
        "jumps": drawn('<jump localId="1" label="L"/><label localId="2" label="\n// *) L"/>', "FBD"),
        "text in a name": start.replace('name="a"', 'name="a : BOOL; END_VAR (*"'),
    }
    for name, text in cases.items():
        path = write("hostile.xml", text)
        with open(work / "said", "w+b") as said:
            process = subprocess.Popen([lineshaft, "check", path], stdout=subprocess.DEVNULL, stderr=said)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            message = said.read().decode()
        seconds = usage.ru_utime + usage.ru_stime
        print(f"  {name}: exit {process.returncode}, {seconds:.2f} s, {usage.ru_maxrss // 1024} MB: {message.splitlines()[0][-90:] if message else ''}")
        assert process.returncode == 2, (name, process.returncode, message)
        place = r"hostile\.xml' has more than" if name == "large" else r"hostile\.xml:\d+:\d+: error\[L\d+\]"  # refused unread
        assert re.search(place, message), (name, message)
        assert seconds <= MOST_SECONDS, (name, seconds)
        assert usage.ru_maxrss <= MOST_KILOBYTES, (name, usage.ru_maxrss)


with tempfile.TemporaryDirectory() as temporary:
    work = pathlib.Path(temporary)
    check_new_from()
    check_new_traces()
    check_inherited()
    check_page()
    check_configuration()
    check_exported_tasks()
    check_tasks_of_codesys()
    check_codesys_export()
    check_unread_bodies()
    check_configured_programs()
    check_texts_of_any_name()
    check_order_of_programs()
    check_coil_in_mid_rung()
    check_programs_without_tasks()
    check_tasks_of_plcopen()
    check_chart_flags()
    check_older_forms()
    check_binary_libraries()
    check_addresses()
    check_memory_of_br()
    check_instruction_lists()
    check_editors_of_matiec()
    check_prefix()
    check_yaml_folder()
    check_names_of_types()
    check_dialects()
    check_neighbours()
    check_standard_xml()
    check_foreign_files()
    check_nothing()
    check_automation_studio()
    check_programs_with_packages()
    check_packages()
    check_private_packages()
    check_projects_beside()
    check_typst()
    check_later_constants()
    check_task_classes()
    check_headers()
    check_mapp()
    check_mapp_motion()
    check_mapp_references()
    check_organization_blocks()
    check_memory_bytes()
    check_softmotion()
    check_local_types()
    check_unused_local_types()
    check_numbers_of_br()
    check_types_by_capitals()
    check_actions_of_libraries()
    check_awl()
    check_apax()
    check_packages_beside()
    check_solution()
    check_named_programs()
    check_qualified_names()
    check_openplc_editor()
    check_openplc_files()
    check_coils_in_series()
    check_lost_bases()
    check_left_over()
    check_axes_of_lists()
    check_axes_of_groups()
    check_axes_of_siemens()
    check_called_programs()
    check_axes_of_suites()
    check_suites_of_programs()
    check_failed_suites_of_a_run()
    check_vendored_tcunit()
    check_suites_of_lists()
    check_axes_that_are_referred_to()
    check_unions_of_codesys()
    check_encrypted()
    check_foreign_names()
    check_hostile()
print("projects of others at the prompt: fine")
