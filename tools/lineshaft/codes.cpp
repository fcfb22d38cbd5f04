#include "tools/lineshaft/codes.hpp"

#include <algorithm>
#include <string>

namespace lineshaft {

namespace {

constexpr CodeText code_texts[] = {
    {"L0001", "a file cannot be read",
     R"(The file does not exist, is a folder, or may not be read. The name is taken from the
command line, or from the file that names it (a program's 'controller:', a study's
'program:'); such a name counts from the folder of the file it stands in, not from the
folder you are in. Check the spelling and the permissions. What a file names must be a
regular file; only the command line may name a pipe or a device.)"},
    {"L0002", "a file outside of the project",
     R"(A program reads files of its own project only, so that a program from a stranger
cannot show you the rest of your disk. The project is the nearest folder above the
program that holds a folder 'config', else the program's own folder. Move the file
into the project, or allow its folder:
    lineshaft run program.yaml --include-dir ../shared)"},

    {"L0101", "the file is not YAML",
     R"(The text cannot be taken apart into keys and values. What is wrong often stands just
before the place shown: a bracket or quote that was not closed, a colon without a
space after it, an entry that is indented further than its neighbours. Indent with
spaces; YAML does not allow tabs there.)"},
    {"L0102", "a key stands twice in one map",
     R"(Two entries of one map bear the same name. YAML tools differ in which of the two
counts, so here neither does. Remove one of them, or rename it: two blocks, or two
tasks, need two names.)"},
    {"L0103", "more than one document in the file",
     R"(A line '---' begins a further YAML document, and a program file holds exactly one.
Without this check everything after that line would be ignored in silence. Remove the
line, or put the second program into a file of its own.)"},
    {"L0104", "YAML's anchors, aliases, tags and merge keys are not used",
     R"(A value is written where it is used: '&name', '*name', '!tag' and the key '<<' are not
read. For a value that is needed in several places use a parameter:
    parameters: {speed: 10 mm/s}
    blocks:
      shaft: {type: axis, task: servo, default_velocity: $speed}
If you mean the character itself, put the text in quotes.)"},
    {"L0105", "the file is not a map",
     R"(A program, a study and a controller are maps: 'key: value' at the left margin,
beginning with 'lineshaft: 1', 'lineshaft_study: 1' or 'lineshaft_controller: 1'. The
file is empty, holds nothing but comments, or is a list or a plain text.)"},
    {"L0106", "the file is larger or deeper than allowed",
     R"(Files are read up to a size, a number of entries, a depth of nesting and a length of a
single text that no program comes near; the message names the limit. They keep a
damaged or hostile file from using up the memory. Cut the file down, or split a study
in two.)"},
    {"L0107", "a key is not a plain name",
     R"(A key is a single word such as 'shaft' or 'slave.velocity', not a list or a map. Often
a brace is missing or one too many: '{a: 1}: x' and '? [a, b]' have a map and a list
for a key.)"},
    {"L0108", "the file is not plain text",
     R"(Files are UTF-8 text. Other encodings (UTF-16, Latin-1), NUL bytes and control
characters are refused, because what cannot be seen cannot be checked. Save the file
as UTF-8 in your editor; if it came from a spreadsheet or another program, export it
as plain text.)"},

    {"L0109", "a character that only looks like the one that is meant",
     R"(What is copied from a document or a web page often has other characters than the
keyboard's: a no-break space for a blank, a minus sign or a dash for '-', typographic
quotes. They look alike on the screen, but neither YAML nor a number has them. Type the
character anew. Titles, notes and comments may hold any character.)"},

    {"L0201", "an unknown key",
     R"(A map has a fixed set of keys, and this is none of them. It is an error because a
misspelt key would otherwise be ignored, and the program would run with a default that
you did not want. The line below the mark has the nearest known key, or all of them.)"},
    {"L0202", "a needed entry is missing",
     R"(Some entries have no sensible default: 'blocks' and 'run' of a program, 'type' and
'task' of a block, 'every' of a task, 'at' and 'set' of a stimulus, 'program' and
'cases' of a study. The smallest program that runs:
    lineshaft: 1
    tasks: {servo: {every: 2 ms}}
    blocks: {shaft: {type: axis, task: servo}}
    run: {for: 1 s})"},
    {"L0203", "an unknown port, input or signal",
     R"(The block exists, but its type does not have this parameter, input or output. 'lineshaft
blocks TYPE' lists what a type has, with units and defaults. A wire, a trace and an
expectation name a value as block.port, as in 'shaft.velocity'; a wire starts at an
output. A study may compare any signal of its program.)"},
    {"L0204", "an unknown block",
     R"(A signal 'block.port' begins with the name that the block has under 'blocks:', not
with the name of its type. No block of this program is called so. The program's own
inputs are called 'inputs.name'.)"},
    {"L0205", "an unknown type of block",
     R"(The catalogue of function blocks does not have this type. 'lineshaft blocks' lists all types
with one sentence each. Types are written as listed: servo_drive, MC_MoveAbsolute.)"},
    {"L0206", "an unknown task",
     R"(A block, a trace or every(...) names a task that neither 'tasks:' nor the controller
file declares. A block must say which task scans it, since the task gives it its
interval:
    tasks:  {servo: {every: 2 ms, priority: 26}}
    blocks: {shaft: {type: axis, task: servo}})"},
    {"L0207", "an unknown parameter",
     R"('$name' stands for a value from 'parameters:', and there is none of that name. Declare
it with its default; --set and the cases of a study may then change it:
    parameters: {speed: 10 mm/s}
A text that really begins with '$' is put in quotes.)"},
    {"L0208", "an unknown signal",
     R"(A signal is written as block.port, or as inputs.name for an input of the program
itself; both parts are plain names. 'shaft' alone names a block, not a value. An input
must stand under 'inputs:' with the value that it has at the start:
    inputs: {start: false})"},
    {"L0209", "the wrong kind of value",
     R"(The entry is a map, a list or a single value where another of these three is expected, or
has no value at all. A map has 'key: value' entries, a list has '-' entries or
brackets:
    tasks: {servo: {every: 2 ms}}                      # a map
    trace: {task: servo, signals: [shaft.position]}    # signals: a list, also of one
    title: Ratio change                                # a single value)"},
    {"L0210", "not a usable name",
     R"(Names of blocks, tasks, inputs, parameters and cases have letters (a-z, A-Z), digits
and underscores, and do not begin with a digit: 'slave_x', not 'slave-x', '2nd' or
'Achse 1'. They appear in wires, trace columns and formulas, where other characters
have a meaning. A block cannot be called 'inputs', since inputs.x names the program's
own inputs.)"},
    {"L0211", "the file does not say what it is, or of which version",
     R"(A program begins with 'lineshaft: 1', a study with 'lineshaft_study: 1', a fit with
'lineshaft_fit: 1', a controller with 'lineshaft_controller: 1'. The number is the version of the file's form, so that
a later lineshaft can still tell what an old file means. This lineshaft reads version
1.)"},

    {"L0212", "something is named twice",
     R"(A trace records each signal once, since two columns of one name cannot be told apart;
the cases of a study have different names, since the claims' formulas go by them.
Remove one of the two, or rename it.)"},
    {"L0213", "entries that do not go together",
     R"(An expectation is judged at one time ('at'), in every scan ('always', 'never', 'between'), or
by how often something happens ('rising', 'within TIME of SIGNAL'), and compares with a value or with bounds; 'within' is the tolerance of a value that is a number, and
'at_least' is not above 'at_most', in a study neither. A study's grid has no name, since
its cases would share it. Write one expectation for each thing that must hold:
    expect:
      - {at: end, slave.velocity: 15 mm/s, within: 1e-9 mm/s}
      - {always: slave.velocity, at_least: 0 mm/s, at_most: 15.001 mm/s}
      - {within 2 s of feed.InVelocity: gear.InGear}
A task is cyclic ('every', 'offset', 'jitter') or started by the rising edges of boolean
signals ('on'), and then has no interval that every(...) could name:
    tasks:
      pto_done: {on: x.done, priority: 18, cost: 0.33 ms}
A stimulus has a time, a scan or a file. What a file plays into an input is interpolated
between its rows only where the input is a real.
A trace's trigger has a signal and one condition (edge, above, below, inside or equals);
'pre_trigger' and 'repeat' need a trigger other than the start of the run.)"},
    {"L0214", "a row of the wrong length",
     R"(A list of rows, such as a pulse output's profile, has as many numbers in each row as the
table has columns; 'lineshaft blocks pto' names them:
    profile: [[2 kHz, 10 kHz, 200], [10 kHz, 10 kHz, 3400], [10 kHz, 2 kHz, 400]])"},
    {"L0215", "the rows before a trigger take too much memory",
     R"(A trace with 'pre_trigger' keeps that many rows in memory while it waits; what all traces
of a program keep is known before the run starts, and is limited (the message says to how
much). A row takes 8 bytes for each signal and 16 more. Keep fewer rows or fewer signals,
or record every n-th scan only. What is recorded from the trigger on goes to the disk and
is not limited.)"},

    {"L0216", "rows of a list that do not go together",
     R"(Each row of the list is right for itself, but not after the others: the points of a cam stand
in the order of the master, whose position rises from each to the next, and there are two at
least. The message says which row it is. A point that comes twice is left out; a master that
runs backwards has its points in the other order.)"},
    {"L0217", "an expression where a value is expected",
     R"(A value may be a formula of numbers and parameters ($radius / 2 + 1 mm, cos(0.02)), which
is computed once, before the run. What an expression of signals does is
done by a block of IEC 61131-3 (and, or, not, gt, add, mul, ...), whose output is then
wired or named:
    blocks:
      far: {type: gt, task: servo, unit: mm, in1: shaft.position, in2: 5 mm}
    run: {for: 1 min, until: far.out}
On a wire 'NOT block.port', without quotes, negates a boolean. In an expectation bounds
are written at_least: 10 mm/s and at_most: 20 mm/s.)"},

    {"L0301", "not a number",
     R"(A number is expected: digits with an optional point and exponent, then an optional unit,
such as 20, -1.5, 5e4 mm/s^3 or 1_000. Whole numbers may have a base as in IEC
61131-3: 16#E0, 2#1010. Not accepted: a leading zero (010 would be eight in some tools
and ten in others), a decimal comma, infinity, nan, and a number in quotes.)"},
    {"L0302", "the unit is missing",
     R"(Where a value has a dimension, its unit stands with it: '20 mm', '10 mm/s', '2 ms'. A
bare number would leave open whether millimetres or metres are meant, and such a guess
is what moves an axis a thousand times too far. Any unit of the right dimension will
do; it is converted.)"},
    {"L0303", "the unit measures something else",
     R"(The value has a unit, but of another dimension than the port: a velocity in mm where
mm/s is expected, a length for an angle, or a unit where a plain number is expected. Units of
one dimension are converted (2 cm is 20 mm), others cannot be. 'lineshaft blocks TYPE'
shows the unit of each port.)"},
    {"L0304", "an unknown unit",
     R"(After the number stands something that is not a unit. Units are written as symbols,
combined with '*' and '/' and a power '^': mm, mm/s, mm/s^2, rad/s, rpm, kHz, ms, %. Upper
and lower case matter: mm, not MM. 'lineshaft units' lists them. A claim of a study is a plain number or in %.)"},
    {"L0305", "a number out of range",
     R"(The number is well written, but the value cannot be: outside of the limits of the port
(an acceleration must be above 0), beyond what 64 bits hold, a trace of every 0th
scan, a jitter not below the task's interval, a share above 100 %. 'lineshaft blocks
TYPE' shows the limits.)"},
    {"L0306", "not one of the allowed names",
     R"(The port takes one name out of a fixed list, such as the unit of an axis. Names
are written exactly as listed, without quotes and in lower case. 'lineshaft blocks
TYPE' shows each list.)"},
    {"L0307", "not a boolean",
     R"(A boolean is 'true' or 'false', in lower case and without quotes. YAML tools disagree
on yes, no, on, off, TRUE and 1, so these are not accepted.)"},
    {"L0308", "not a time",
     R"(A time is expected: a number with s, ms, us or ns, such as '2 ms'. Virtual time counts
whole nanoseconds, so a time may not be negative, nor a fraction of a nanosecond, nor
above 292 years; an interval may not be zero, since the task would never come to an
end.)"},
    {"L0309", "not a whole number",
     R"(A count, a seed or a priority is a whole number without point, exponent or unit: 3,
not 3.0 or 3 mm. Where a whole number has a unit (pulses), the value must come out
whole in that unit.)"},

    {"L0401", "a wire between different types",
     R"(An input takes a value of its own type: boolean, integer, real or a certain
enumeration. Only an integer may feed a real. Nothing else is converted in silence, as
in IEC 61131-3; the block 'lreal_to_lint' rounds a real to an integer, 'lreal_to_time'
makes seconds the time that a timer's 'pt' takes. 'until:' takes a boolean.
'lineshaft blocks TYPE' shows the type of each port.)"},
    {"L0402", "a wire between different dimensions",
     R"(The output is in a unit that the input cannot take: a position in mm does not fit a
velocity in mm/s. Units of one dimension are converted on the wire (rev to rad);
others are a mistake in the wiring, or a block's parameter for its unit is set
wrongly.)"},
    {"L0403", "a required parameter or input is not set",
     R"(The block cannot work without this value, so it has no default. Give it a constant, a
wire or a parameter of the program:
    drive:
      type: servo_drive
      task: servo
      set_position: shaft.position)"},
    {"L0404", "feedback without previous()",
     R"(Blocks of a task are scanned in the order of the file. The wire reads a block that is
scanned later in the same task (or the block itself), so this scan's value is not
there yet. If the last scan's value will do, as in a control loop, say so:
previous(drive.position). If not, move the block that is read further up. The message
shows the loop hop by hop where there is one.)"},
    {"L0405", "an output cannot be set",
     R"(Outputs are written by the block in each scan, so a constant or a stimulus for them
would be overwritten at once. Set an input of the block instead; to force a value, put
a program input (inputs.name) on the wire and change that by a stimulus. Parameters
are constant while the program runs: a stimulus cannot change them either.)"},
    {"L0406", "a wire into a parameter",
     R"(Parameters are fixed before the first scan, so a wire could never reach them. Give a
constant or a parameter of the program ($name). 'lineshaft blocks TYPE' says which
ports are inputs and so take wires.)"},
    {"L0407", "previous() where it is not needed",
     R"(The block that is read belongs to another task, or is an input of the program: the wire
carries what was published last in any case, and previous() would look like a delay
that is not there. Remove the word. Of a block that is scanned earlier in the same task
previous() is a delay by a scan; a warning says so, for this scan's value is at hand.)"},
    {"L0408", "NOT on something that is not a boolean",
     R"('NOT block.port' negates a boolean wire. The output or the input here is of another
type. For a comparison or a sign use a block that does it.)"},
    {"L0409", "a stimulus on an input that is wired",
     R"(The input is fed by a wire, which is copied in before every scan: what the stimulus
sets would be overwritten before it is seen. Remove the wire, or let the stimulus set
an input of the program (inputs.name) and wire that.)"},
    {"L0410", "a time error that cannot be handled",
     R"('on_overrun' lists the tasks whose time errors start this one, as OB80. A motion task
(motion: true, such as MC_Servo) may not overrun at all: the controller stops, as an
S7-1500 does. And a task that overruns cannot be its own help.
    tasks:
      time_error: {on_overrun: [main], priority: 22})"},
    {"L0411", "something that cannot be retained",
     R"('retain' lists what outlives a run: blocks, outputs of blocks, and inputs that are set from
outside. A parameter is the program's own constant; a wired input gets its value from the
wire in the first scan, so retain where the wire begins. A device, such as a pulse output,
is hardware and starts anew with the power: retain its outputs.)"},
    {"L0421", "registers of Modbus that overlap",
     R"(Two signals of a table have a register in common, or a signal ends beyond 65535. An int32,
uint32 or real32 takes two registers, one of 64 bits four; unless 'type' says otherwise a real
is a real32, an integer an int32. Give the second one the next address that is free:
    modbus:
      input_registers: {0: shaft.position, 2: slave.position})"},
    {"L0422", "a table of Modbus that is not written",
     R"(Clients write coils and holding registers; discrete inputs and input registers are only
read. Put the signal where it can be written:
    modbus:
      coils: {0: {signal: inputs.go, write: true}})"},
    {"L0423", "a type or a scale that does not fit a signal of Modbus",
     R"(A coil or a discrete input is a boolean; other signals go into registers. A scale is what
one in the register is, in a unit of the signal's dimension, and not 0:
    modbus:
      holding_registers: {100: {signal: shaft.position, type: int32, scale: 0.001 mm}})"},

    {"L0501", "a setting for a parameter that the program does not have",
     R"(--set and the cases of a study change what the program declares under 'parameters:',
nothing else. Check the name, or declare the parameter and use it:
    parameters: {radius: 20 mm}
    blocks:
      path: {type: path_circle, task: servo, radius: $radius, length: shaft.position})"},
    {"L0502", "--set without name=value",
     R"(A setting is a name, '=' and the value as it would stand in the program. Values with
blanks need quotes in the shell:
    lineshaft run program.yaml --set speed=5mm/s --set "radius=50 mm")"},
    {"L0503", "--trace for a program without a trace",
     R"(The program does not say what to record. List the task and the signals:
    trace:
      task: servo
      every: 1
      signals: [shaft.position, slave.velocity])"},
    {"L0504", "--pulses for a program without a pulse channel",
     R"(The program has no block that puts out pulses. 'pto' is one:
    x: {type: pto, task: main, start_rate: 1 kHz, count: 500, execute: inputs.go})"},
    {"L0505", "--force without signal=value@from..until",
     R"(A force keeps a signal at a value for an interval, whatever the program writes; after
it the program's own value is back. Without a time it begins at the start, or does not
end; without @ it is for the whole run:
    lineshaft run program.yaml --force gear.RatioNumerator=2@1s..2s --force inputs.go=true@..5s)"},
    {"L0506", "a checkpoint that cannot be resumed",
     R"(A checkpoint holds the memory of a run of one program with certain parameters and forces,
by one version of lineshaft, and the place in its trace. It is refused if any of these
differs, if it is not whole, or if the trace is not the one that was being written then.
Run the program from its start, or with the same file, --set, --force, --trace and
--pulses as before, for a served machine --record, too.)"},
    {"L0507", "a file of retained values that does not fit",
     R"(A retain file is JSON with a check of itself: {"lineshaft_retain": 2, "check": "...", "values":
{"counter.cv": 12}, "blocks": ...}. This one is something else, is damaged (and so is the copy
before it, FILE.bak), or has a value that the signal cannot have. What a block remembers, as
bytes, is of use only to a block of the same kind with the same parameters in the same version
of lineshaft. Remove the file, or begin with the initial values, which then overwrite it:
    lineshaft run program.yaml --retain-file line.retain --restart cold)"},
    {"L0508", "--retain-file for a program that retains nothing",
     R"(The program does not say what outlives a run. List the blocks and inputs:
    retain: [counter, inputs.recipe])"},
    {"L0509", "an output that is a file the command reads",
     R"(The output would replace what it is made from: --trace program.yaml would leave a table where
the program was. Two outputs of one name would replace each other. Name another file:
    lineshaft run program.yaml --trace program.csv)"},
    {"L0510", "an address that nobody can be served at",
     R"('--http' and '--modbus' take an address of this machine and a port, or off. Another program
may be there already, for instance another 'lineshaft serve'; ports below 1024 are for root.
127.0.0.1 is for this machine alone, 0.0.0.0 for all that reach it:
    lineshaft serve program.yaml --http 127.0.0.1:18090 --for 0.1s)"},
    {"L0511", "no real-time priority",
     R"('--realtime' runs the machine before all other programs and keeps its memory in place. That
takes root, the capabilities cap_sys_nice and cap_ipc_lock, or limits for rtprio and memlock in
/etc/security/limits.conf. Without it the machine runs as other programs do: the virtual times
are the same, the clock's are kept less well.)"},
    {"L0512", "a recording that cannot be written",
     R"(What clients write is recorded, so that a run of it can be played back. The file cannot be
made or written (the disk may be full), another 'lineshaft serve' writes it, or it is something else
than a recording, which stays: name another one by --record FILE.yaml. The same goes for the file
of --audit.)"},
    {"L0513", "a request that is not allowed",
     R"(A machine that is served is only looked at, unless --allow-write is said. Clients of other
machines need a token to write, too: the first line of the file of --token-file. A token that is sent and
is wrong is refused in any case. A browser's
request is refused when its page is not the machine's own.)"},
    {"L0514", "a file without a token",
     R"(The first line of the file of --token-file is what clients of other machines send to write:
'Authorization: Bearer TOKEN'. It has 16 characters or more; nobody else should read the file: chmod 600.)"},

    {"L0601", "a study of too many runs",
     R"(The cases, the values of a grid multiplied with each other, and 'repeat' make more
runs than a study may have (a million). Sweep fewer values at once, or split the study.)"},
    {"L0602", "a mistake in a formula",
     R"(A claim's formula has + - * / and parentheses, numbers, the functions abs, sqrt, min,
max, mean, and names: a case's name stands for its first compared signal,
'case.block.port' for a certain one. mean_relative_error and greatest_relative_error
are taken over all rows that have a paper's value.
    formula: 1 - early / immediate)"},
    {"L0603", "differences of different units without uncertainties",
     R"(A fit minimises the sum of the squares of all differences between what was measured and
what the program gives. A difference in mm and one in s cannot be added, so each is
divided by how exact its figure is:
    compare:
      slave.position: {paper: 29.7 mm, uncertainty: 0.1 mm}
      slave.velocity: {paper: 14.9 mm/s, uncertainty: 0.1 mm/s}
Where all figures are of one unit the uncertainty may be left out: then all weigh the
same.)"},
    {"L0604", "fewer figures than parameters",
     R"(As many parameters as there are measured figures can be looked for, not more: with
fewer figures many values fit equally well. Cells that are held out do not count, for
they only test what the others have found. Take a parameter out of 'parameters:' (its
value then comes from the program or from 'set:'), or compare more signals or cases.)"},
    {"L0605", "a measured trace that cannot be compared",
     R"(A fit takes the program's signals at the times that the trace's column 'time' gives, in
seconds from the start of the run. So these times are not negative and rise from row to
row. Rows where a compared column is empty are left out. If the
measurement begins later than the run, say by how much:
    trace: {file: measured.csv, offset: 10 ms})"},
    {"L0611", "chunks of a study are missing",
     R"(The result of a study in chunks is put together only when every chunk is there.
    lineshaft study PLAN.yaml --chunk 3/8 -o parts/part_3.csv      # and all the others
    lineshaft study PLAN.yaml --merge parts -o all.csv)"},
    {"L0612", "a chunk of another study",
     R"(A chunk's sidecar has a hash of the plan, the program, its controllers, the files that it
replays, the settings of the command line and the version of lineshaft. It differs from that of the plan to be merged, or
the chunks were made for different divisions (3/8 and 3/10). Compute the chunk again.)"},
    {"L0613", "a damaged chunk",
     R"(The rows of a chunk are not those that its sidecar (FILE-metadata.json) describes: the file
was cut off, edited, or copied without it. Compute the chunk again.)"},
    {"L0614", "results without a file",
     R"(--chunk, --merge and --resume are about a result file: say which with -o FILE.csv. Without one a
study shows its table on the terminal and keeps nothing.)"},

    {"L0701", "a CSV file without columns",
     R"(The first line of a CSV file names its columns, separated by commas (or semicolons, where
the decimal point is a comma); numbers begin in the second line. The file is empty, begins
with numbers, or a column has no name; or it is a program or a study, whose trace is meant:
    lineshaft run program.yaml --trace out.csv)"},
    {"L0702", "an unknown column",
     R"(The CSV file has no column of this name. Columns are named as in the first line of the
file, in a trace also as the signals are in the program: shaft.position. A unit in
brackets behind the name may be left out.)"},
    {"L0703", "two columns of one name",
     R"(Columns are found by their names, so two cannot bear the same one. Rename one of them in
the first line of the file.)"},
    {"L0704", "a row of another length than the header",
     R"(Every row of a CSV file has as many cells as the first line has names; a missing value
is an empty cell, and blank lines at the end are no rows. Often a decimal comma took a number
apart: then semicolons must stand between the cells.)"},
    {"L0705", "something else in a column of numbers",
     R"(The cells of the columns that are read are numbers; where there is no value the cell is
empty. Words such as nan, inf or true are not numbers. In a trace booleans are 0 and 1,
enumerations the number of the name, as the sidecar tells.)"},
    {"L0706", "a CSV file that is not whole",
     R"(The file is cut in its last row, or has not the rows that its sidecar
(NAME.csv-metadata.json) tells of, or one of the two is not as it was recorded. What a
broken run left behind is named NAME.csv.part. 'lineshaft verify NAME.csv' says more.)"},
    {"L0707", "a sidecar that cannot be understood",
     R"(Beside a trace NAME.csv stands NAME.csv-metadata.json with units, types and the
program's hash, as JSON (W3C CSVW). This file is something else. Record the trace again, or
remove the sidecar: then all columns are plain numbers.)"},
    {"L0708", "traces that cannot be compared",
     R"(Two traces are compared row by row, so both must come from the same program (with whatever
parameters, seed, controller and forces; comments do not count) and have the same columns in
the same order, with the same units, and the same interval between rows.
'lineshaft diff --any-program' compares traces of two programs, such as the one before and
after a change.)"},
    {"L0709", "a trace without a sidecar",
     R"(Whether a trace NAME.csv is whole is told by NAME.csv-metadata.json beside it, which has
its rows and the checksum of its bytes, and a checksum of itself. Copy the two together. A
sidecar of another tool, or of an early version, has none.)"},
    {"L0710", "a CSV file of too many rows",
     R"(What a program replays is kept in memory: 16 bytes a value, 256 MiB for all files and
columns. Replay fewer columns, thin the file out (a trace with 'every: 10' has a tenth of the
rows), or cut it to the part that matters.)"},
    {"L0721", "a trace without rows",
     R"(The file has a header, but no row: nothing was recorded. Perhaps the run ended before the
traced task's first scan, or before the trace's trigger. Or no row has a value in a column
that is replayed, or in each of the columns that are compared.)"},
    {"L0722", "a trace whose time does not rise",
     R"(The rows of a trace stand in the order of their column 'time', and each has a time. This
file has been sorted by something else, or put together from several traces.)"},
    {"L0723", "a sidecar of another trace",
     R"(The sidecar NAME.csv-metadata.json beside a trace describes its columns; this one
describes others. Copy a trace together with its own sidecar, or remove the sidecar.)"},
    {"L0724", "traces of different signals",
     R"(A picture lays several traces over each other signal by signal, so all of them must have
the same ones: they are runs of one program, perhaps with other --set values. Pick the
signals they share:
    lineshaft plot a.csv b.csv --signals shaft.position,slave.position -o both.svg
A page of 'lineshaft report' draws runs of different signals.)"},
    {"L0725", "traces of different interval",
     R"(The rows of the two traces lie at different distances in time, so that sample cannot be
compared with sample. Record both with the same task and 'every'.)"},
    {"L0726", "a file that is not the results of a study",
     R"(A .json file given to 'lineshaft report' is what a study printed:
    lineshaft study PLAN.yaml --json >results.json
    lineshaft report results.json -o results.html)"},

    {"L0801", "a stimulus or a force after the end of the run",
     R"(A warning. The run ends before this comes, so it does nothing. Let the run be longer, or
give the stimulus, the replay or the force a sooner time:
    run: {for: 4 s}
    stimulus:
      - {at: 3 s, set: {inputs.go: true}})"},
    {"L0802", "an expectation that is never looked at",
     R"(A warning. The run ends before the expectation's time, so it cannot hold; or it shall
hold always, after every scan of a task that never scanned. 'at: end' is the end of the run,
whenever that is:
    expect:
      - {at: end, gear.InGear: true})"},
    {"L0803", "a parameter or an input that nothing uses",
     R"(A warning. What is declared is changed by --set, by a study or by a stimulus, but no block
sees it. Often the place where it is meant still has a constant:
    inputs: {ratio: 1.5}
    blocks:
      gear: {type: MC_GearIn, task: servo, Master: shaft, Slave: slave, Execute: true,
             RatioNumerator: inputs.ratio})"},
    {"L0804", "a test that expects nothing",
     R"(A warning. 'lineshaft test' runs the program, and it passes whatever it does, since it has
no 'expect:'. Say what must hold:
    expect:
      - {at: end, slave.velocity: 15 mm/s, within: 1e-9 mm/s})"},
    {"L0805", "an output that is retained without its block",
     R"(A warning. A block remembers more than its outputs show: a counter the level that its input had,
a timer when it was started. 'retain: [counter.cv]' keeps the number alone, and a part that stands
in the light barrier is counted once more after the restart. Keep the whole block:
    retain: [counter])"},
    {"L0806", "a recording of another program",
     R"(A warning. The recording was made from a program, or with values of --set, that mean something
else than what is run now, so that something else may come of it. With the same program and
--set as 'lineshaft serve' had, the trace has the same bytes.)"},

    {"L0807", "a command that nothing begins",
     R"(A warning. A command begins at a rising edge of Execute, and nothing in the program sets it: no
wire, no value, no stimulus, force or replay, no register of Modbus. Wire it, or let it be true from
the first scan on:
    inputs: {start: false}
    blocks:
      feed: {type: MC_MoveVelocity, task: servo, Axis: shaft, Velocity: 10 mm/s, Execute: inputs.start})"},

    {"L0808", "a periodic cam whose end does not lead on to its beginning",
     R"(A warning. The cam begins anew at its end, and there its slope, the slave's velocity per that of
the master, is another one: the slave's velocity jumps each period. Or it ends at another position
of the slave than it begins with, and SlaveAbsolute says that the cam gives that position: it goes on
by the difference each period. A modulo axis may go on by whole turns. Close the cam:
    blocks:
      wave: {type: cam_table, task: servo, periodic: true, points: [[0 mm, 0 mm], [100 mm, 40 mm], [200 mm, 0 mm]]})"},

    {"L0901", "a character of no word",
     R"(The Structured Text has a character that begins no name, number, text or sign, or a comment
or text that does not end, or the file is no text at all. It is UTF-8, UTF-16 that begins with its
byte order mark, or Windows-1252. Comments are // to the end of the line, (* *) and /* */, which
nest. Texts stand in single quotes; names with other than letters, digits and '_' stand in
double quotes.)"},
    {"L0902", "something else is expected",
     R"(The Structured Text cannot be taken apart here: another word or sign is due. The place is
where the reader noticed; what is missing often belongs before it, such as the ';' that ends a
statement. ':=' assigns, '=' compares. IF, CASE, FOR, WHILE and REPEAT end with their own END_...;
in a chain of conditions write ELSIF, for ELSE IF opens a second IF.)"},
    {"L0903", "not supported",
     R"(This part of IEC 61131-3 or of a maker's language is not supported; the help says what to write
instead. Not supported are classes, interfaces, inheritance, namespaces, properties, pointers and
references, direct addresses (%IX0.0), sequential function charts and WSTRING.)"},
    {"L0904", "a name that is not declared",
     R"(No variable, type, block or function of this name is seen here. Names are found without regard
to capital letters. A block sees its own variables, its methods those of their block; all see
VAR_GLOBAL, data blocks, types, enumerations and functions of all sources of the program. From
outside, a block's VAR_TEMP and constants are not seen.)"},
    {"L0905", "a type that does not fit",
     R"(The value has another type than is due, and none that becomes it by itself. A condition is a
BOOL, an index and a CASE selector are whole numbers, an operator takes operands of its own kind.
Conversions are written as functions: INT_TO_REAL(n), or TO_REAL(n).)"},
    {"L0906", "a conversion that may lose",
     R"(Integers, bit strings and reals become larger types by themselves (INT to DINT, INT to REAL, DINT
to LREAL, REAL to LREAL, BYTE to WORD). The other way a value may not fit, so that it must be
written: LREAL_TO_REAL(x), DINT_TO_INT(n) (which wraps), REAL_TO_INT(x) (which rounds half to even,
and is a fault where no INT holds the value).)"},
    {"L0907", "wrong arguments",
     R"(A call gives an argument that is not there, gives one twice, leaves one out that is due, or
gives a value where a variable is due. Inputs are given with ':=', outputs are taken with '=>':
delay(IN := start, PT := T#20ms, Q => done)
By position, arguments stand in the order of their declaration. A VAR_IN_OUT must be given.)"},
    {"L0908", "a value out of range",
     R"(A constant does not fit: a number beyond its type, an index beyond its array, a division by zero,
a value that a CASE has already, more initial values than elements.)"},
    {"L0909", "a name declared twice",
     R"(Two declarations of one scope bear the same name. Names that differ in capital letters only are
the same name.)"},
    {"L0910", "not to be assigned",
     R"(Inputs, constants and values are not assigned. Of an instance only inputs are set from outside. An
input that a block wants to change is copied to a variable of VAR first, or declared as VAR_IN_OUT
where the caller's variable is meant.)"},
    {"L0911", "a block that calls or contains itself",
     R"(A PLC has a fixed amount of memory for each block, so that nothing may call itself, also not by way
of others, and no type may contain itself. The message lists the way around. Write a loop, with an
array for what has to be remembered.)"},
    {"L0912", "too deep or too large",
     R"(Expressions and statements nest at most 200 deep, a chain of operators has at most 2000 operands,
an array at most 16777216 elements, a block at most 512 MB.)"},
    {"L0913", "not a constant",
     R"(Bounds of arrays and subranges, lengths of STRING, values of enumerations, labels of CASE and
initial values are known when compiling: numbers, constants of VAR CONSTANT, and expressions of
these.)"},
    {"L0914", "a statement or declaration in a wrong place",
     R"(EXIT and CONTINUE stand in a loop. Only functions and methods have a result. A function keeps
nothing from call to call, so that it has no instances; it takes one as VAR_IN_OUT.)"},
    {"L0921", "a variable that is never used",
     R"(A warning: the variable is declared and nothing reads or writes it. Remove it, or use it: often a
name is misspelt elsewhere.)"},
    {"L0922", "a statement that is never reached",
     R"(A warning: the statement before it leaves the block or the loop. Remove it, or put the statement
before it into an IF.)"},
    {"L0923", "an argument that is not taken",
     R"(A warning: a controller's block has this input, and the one of PLCopen has not. It says something of
a real drive (StartMode, StopMode, bRegulatorOn, ...), which a simulated axis has not.)"},
};

}  // namespace

std::span<const CodeText> diagnostic_codes() {
    return code_texts;
}

const CodeText* find_code(std::string_view code) {
    std::string wanted(code);
    if (wanted.starts_with('l')) wanted.front() = 'L';
    const auto it = std::ranges::find(code_texts, wanted, &CodeText::code);
    return it == std::end(code_texts) ? nullptr : it;
}

}  // namespace lineshaft
