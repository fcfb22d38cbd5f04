#include "runtime/program/program_form.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/templates.hpp"

// clang-format off: tables are laid out by hand

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

// Tasks

void read_jitter(const Reader& read, const Node& node, TaskPlan& task) {
    task.jitter = read.time_or_share(node, task.every).value_or(task.jitter);
}

void read_cost_jitter(const Reader& read, const Node& node, TaskPlan& task) {
    task.cost_jitter = read.time_or_share(node, task.cost).value_or(task.cost_jitter);
}

/// Parts of it may come from the controller's file: then the name is the place.
void check_times(const Reader& read, const Node& body, const TaskPlan& task) {
    const auto fail = [&](std::initializer_list<const char*> keys, std::string_view what) {
        Node place;
        place.mark = task.mark;
        for (const char* key : keys)
            if (const Node* node = body.find(key); node && place.text.empty()) place = *node;
        read.fail("L0305", place, fmt::format(fmt::runtime(what), task.name));
    };
    if (task.every > 0 && task.jitter >= task.every)
        fail({"jitter", "every"}, "the jitter of task '{}' is not below its interval");
    if (task.cost_jitter > task.cost)
        fail({"cost_jitter", "cost"}, "the cost_jitter of task '{}' is above its cost");
    if (task.every > 0 && task.cost - task.cost_jitter > task.every)
        fail({"cost", "every"},
             "the cost of task '{}' is above its interval: it never ends in time");
}

/// What starts the task is said once; what is said last replaces what its controller says.
void check_task(const Reader& read, const Node& body, TaskPlan& task) {
    const bool on = body.find("on"), overrun = body.find("on_overrun"), every = body.find("every");
    if (on || overrun) task.every = task.offset = task.jitter = 0;
    if (every || (overrun && !on)) task.on.clear();
    if (every || on) task.on_overrun.clear();
    const bool said = on || overrun || every;
    if (said) task.unattached = false;
    if (!said && task.every == 0 && task.on.empty() && task.on_overrun.empty() && !task.unattached)
        read.diagnostics().add(
            "L0202", task.mark, fmt::format("task '{}' has no 'every' and no 'on'", task.name),
            "write its interval, such as every: 2 ms, or the event that starts it, such as "
            "on: inputs.start or on_overrun: main");
    check_times(read, body, task);
}

constexpr const char* no_interval = "an event task has no interval";

const Form& task_form() {
    static const Form form = form_of<TaskPlan>(
        {.name = "task",
         .what = "a task",
         .doc = "scans its blocks, cyclically or at events; in a program it may change a task of "
                "the controller",
         .keys =
             {key<&TaskPlan::every>("every", a_time.above_zero("a task's interval must be above 0"),
                                    "interval"),
              key<&TaskPlan::on>(
                  "on", one_or_list(a_signal, "'on' names no signal"),
                  "boolean signals: each rising edge starts a scan, a pulse output's at its exact "
                  "time; one that "
                  "comes while the task runs is remembered, a second one is a time error"),
              key<&TaskPlan::on_overrun>("on_overrun",
                                         one_or_list(a_task, "'on_overrun' names no task"),
                                         "tasks: each of their time errors starts a scan, as OB80"),
              key<&TaskPlan::offset>("offset", a_time, "start of the first scan").by_default("0 s"),
              key<&TaskPlan::priority>("priority", an_integer, "a larger number wins")
                  .by_default("1"),
              key<read_jitter>("jitter", a_time_or_share,
                               "each interval is drawn from every +- jitter, below the interval")
                  .by_default("0 s"),
              key<&TaskPlan::cost>(
                  "cost", a_time,
                  "execution time: outputs are published that much after the start, and a task of "
                  "higher priority interrupts")
                  .by_default("0 s"),
              key<read_cost_jitter>("cost_jitter", a_time_or_share,
                                    "each cost is drawn from cost +- cost_jitter, at most the cost")
                  .by_default("0 s"),
              key<&TaskPlan::maximum_cycle_time>(
                  "maximum_cycle_time", a_time.above_zero("a maximum cycle time must be above 0"),
                  "a scan that lasts longer, interruptions included, is a time error; 150 ms in "
                  "the cyclic task of "
                  "lowest priority unless said"),
              key<&TaskPlan::motion>("motion", a_boolean,
                                     "a time error stops the run with exit 3, as of MC_Servo")
                  .by_default("false")},
         .rules =
             {{not_with,
               "on",
               {"every", "offset", "jitter", "on_overrun"},
               {},
               no_interval,
               the_other},
              {not_with, "on_overrun", {"every", "offset", "jitter"}, {}, no_interval, the_other}},
         .check = by<check_task>});
    return form;
}

void read_task(const Reader& read, const Node& name, const Node& body, bool in_controller,
               Program& program) {
    if (!read.identifier(name, "a task") || !read.expect_map(body, "a task")) return;
    auto task = std::ranges::find(program.tasks, name.text, &TaskPlan::name);
    if (task == program.tasks.end())
        task = program.tasks.insert(task, {.name = name.text, .mark = name.mark, .on = {}});
    task->unattached = in_controller;
    TaskPlan& plan = *task;
    const Mark first = std::exchange(plan.mark, name.mark);
    read_form(task_form(), read, body, plan, fmt::format("task '{}'", name.text));
    plan.mark = first;
}

void read_tasks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_task(read, name, body, false, program);
}
void read_controller_tasks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_task(read, name, body, true, program);
}

template <auto Read>
Key tasks_key(std::string_view doc) {
    return key<Read>(
        "tasks", named("a task", a_form(task_form)).filled("'tasks' has no task", task_help), doc);
}

// What instructions take

template <st::OpClass of>
void read_time(const Reader& read, const Node& node, st::InstructionTimes& times) {
    times[static_cast<std::size_t>(of)] = read.time(node).value_or(0);
}

const Form& instruction_time_form() {
    using enum st::OpClass;
    static const Form form = form_of<st::InstructionTimes>(
        {.name = "instruction_time",
         .what = "'instruction_time'",
         .doc =
             "what an instruction of Structured Text takes. A scan's execution time is then what "
             "its task's cost says, and what the code that it executes takes",
         .keys = {key<read_time<boolean>>("bool", a_time, "AND, OR, NOT, shifts, bits of words")
                      .by_default("0 s"),
                  key<read_time<integer>>(
                      "integer", a_time,
                      "arithmetic and comparisons of whole numbers and times, an array's index")
                      .by_default("0 s"),
                  key<read_time<real>>("real", a_time, "arithmetic, comparisons and functions")
                      .by_default("0 s"),
                  key<read_time<text>>("text", a_time, "functions of a STRING").by_default("0 s"),
                  key<read_time<move>>("move", a_time, "an assignment, also of a structure")
                      .by_default("0 s"),
                  key<read_time<jump>>("jump", a_time, "to another place: IF, CASE, loops, RETURN")
                      .by_default("0 s"),
                  key<read_time<call>>("call", a_time, "of a function or a function block")
                      .by_default("0 s")},
         .rules = {{at_least_one,
                    {},
                    {"bool", "integer", "real", "text", "move", "jump", "call"},
                    "'instruction_time' says no time",
                    "write one, such as {real: 12 ns}, or leave it out"}}});
    return form;
}

void read_instruction_time(const Reader& read, const Node& node, Program& program) {
    if (read.expect_map(node, "'instruction_time'"))
        read_form(instruction_time_form(), read, node, program.instruction_times.emplace());
}

// Blocks

constexpr const char* block_help = "add blocks such as shaft: {type: axis, task: servo, ...}";

void read_block(const Reader& read, const Node& name, const Node& body, Program& program) {
    if (!read.identifier(name, "a block")) return;
    if (name.text == "inputs" || name.text == "outputs")
        return read.fail("L0210", name, fmt::format("a block cannot be called '{}'", name.text),
                         fmt::format("{0}.x names the program's own {0}", name.text));
    if (body.is_map() && body.find("use")) {  // of no template, which is told
        UsePlan use;
        read_form(use_form(), read, body, use, fmt::format("block '{}'", name.text));
        return;
    }
    BlockPlan& block = program.blocks.emplace_back();
    block.name = name;
    if (!read.expect_map(body, "a block")) return;
    read_form(block_form(), read, body, block, fmt::format("block '{}'", name.text), &name);
    for (const auto& port : body.entries)
        if (!block_form().find(port.first.text)) block.ports.push_back(port);
}

void read_blocks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_block(read, name, body, program);
}

// What comes from outside

void check_stimulus(const Reader&, const Node& item, StimulusPlan& stimulus) {
    stimulus.mark = item.mark;
}

const Form& stimulus_form() {
    static const Form form = form_of<StimulusPlan>(
        {.name = "stimulus",
         .what = "a stimulus",
         .doc = "sets inputs.* and inputs of blocks that no wire feeds, at a time or before a scan",
         .keys = {key<&StimulusPlan::at>("at", a_time, "when"),
                  key<&StimulusPlan::at>("scan", an_integer.at_least(0),
                                         "before this scan of the task, from 0"),
                  key<&StimulusPlan::task>("task", a_task, "whose scan it is"),
                  key<&StimulusPlan::set>("set", signals_to(a_value.as("a value")),
                                          "inputs and their new values"),
                  key<&StimulusPlan::cost>("cost", a_time, "execution time of that scan")},
         .rules = {{not_with,
                    "at",
                    {"scan", "task", "cost"},
                    "a stimulus has a time or a scan, not both",
                    "write {at: 1 s, set: {...}} or {scan: 100, task: servo, set: {...}}"},
                   {at_least_one, {}, {"at", "scan", "task", "cost"}},
                   {at_least_one, {}, {"set", "cost"}},
                   {only_with, "scan", {"task"}, "a stimulus of a scan has no '{2}'"},
                   {only_with, "task", {"scan"}, "a stimulus of a scan has no '{2}'"},
                   {only_with, "cost", {"scan", "at"}, "a stimulus of a scan has no '{2}'"},
                   {only_with, "cost", {"task", "at"}, "a stimulus of a scan has no '{2}'"}},
         .check = by<check_stimulus>});
    return form;
}

void check_replay(const Reader&, const Node&, ReplayPlan& replay) {
    std::erase_if(replay.set, [](const auto& pair) { return pair.second.is_unknown_parameter(); });
}

const Form& replay_form() {
    static const Form form = form_of<ReplayPlan>(
        {.name = "replay",
         .what = "a replay",
         .doc = "plays columns of a trace, or of any CSV with a column 'time', into inputs. A unit "
                "in a title or "
                "the sidecar is converted. An input keeps its value before the first row, after "
                "the last, and where "
                "a cell is empty. The values take 16 bytes each, at most 256 MiB",
         .keys = {key<&ReplayPlan::file>("file", a_value.as("the name of a file"),
                                         "CSV, relative to this file")
                      .must(),
                  key<&ReplayPlan::set>(
                      "set",
                      signals_to(a_value.as("a column's name"))
                          .filled("'set' has no input", "write set: {inputs.x: COLUMN}"),
                      "inputs and the columns played into them")
                      .must("set: {inputs.x: COLUMN}"),
                  key<&ReplayPlan::at>("at", a_time, "time of the run at the file's time 0")
                      .by_default("0 s"),
                  key<&ReplayPlan::interpolated>(
                      "between", one_of("a way from row to row", {"held", "interpolated"}),
                      "a value is held until the next row, or a real is on the line to it")
                      .by_default("held")},
         .check = by<check_replay>});
    return form;
}

void read_stimuli(const Reader& read, const Node& node, Program& program) {
    for (const Node& item : node.items)
        if (!read.expect_map(item, "a stimulus"))
            continue;
        else if (item.find("file"))
            read_form(replay_form(), read, item, program.replays.emplace_back());
        else
            read_form(stimulus_form(), read, item, program.stimuli.emplace_back());
    std::ranges::stable_sort(program.stimuli, {}, &StimulusPlan::at);
}

/// One for each of its signals.
struct Forced {
    std::int64_t from = 0, until = never;
    Pairs set;
};

void check_force(const Reader& read, const Node& body, Forced& forced) {
    const Node* until = body.find("until");
    if (until && forced.until <= forced.from)
        read.fail("L0213", *until, "'until' is not after 'from': this never forces");
}

const Form& force_form() {
    static const Form form = form_of<Forced>(
        {.name = "force",
         .what = "a force",
         .doc = "keeps inputs, wired or not, and outputs at values whatever the program writes; "
                "--force "
                "slave.ratio=2@1s..2s says the same",
         .keys = {key<&Forced::from>("from", a_time, "when it begins").by_default("0 s"),
                  key<&Forced::until>("until", a_time,
                                      "then the program's own values again; never unless said"),
                  key<&Forced::set>("set", signals_to(a_value.as("a value")),
                                    "signals and their values meanwhile")
                      .must()},
         .check = by<check_force>});
    return form;
}

void read_forces(const Reader& read, const Node& node, Program& program) {
    for (const Node& item : node.items) {
        Forced forced;
        read_form(force_form(), read, item, forced);
        for (const auto& [signal, value] : forced.set)
            program.forces.push_back({item.mark, forced.from, forced.until, signal, value});
    }
}

// Traces

constexpr const char* trigger_help =
    "write immediate, or {signal: a.b} with edge: rising, edge: falling, above: VALUE, below: "
    "VALUE, inside: [LOW, HIGH] or equals: VALUE";

constexpr const char* one_condition = "a trigger has a signal and one condition";

void check_trigger(const Reader&, const Node& body, TriggerPlan& trigger) {
    struct Condition {
        const char* key;
        TriggerKind kind;
    };
    static constexpr Condition conditions[] = {{"edge", TriggerKind::rising},
                                               {"above", TriggerKind::above},
                                               {"below", TriggerKind::below},
                                               {"inside", TriggerKind::inside},
                                               {"equals", TriggerKind::equals}};
    for (const auto& [name, kind] : conditions)
        if (body.find(name)) trigger.kind = kind;
    const Node* edge = body.find("edge");
    if (edge && edge->text == "falling") trigger.kind = TriggerKind::falling;
}

const Form& trigger_form() {
    static const Form form = form_of<TriggerPlan>(
        {.name = "trigger",
         .what = "'trigger'",
         .doc = "when a measurement begins: when the condition begins to hold, or holds in the "
                "first scan. It is "
                "time 0, and looked at after every scan of the trace's task",
         .keys = {key<&TriggerPlan::signal>("signal", a_signal, "of any task"),
                  key("edge", one_of("an edge", {"rising", "falling"}), "of a boolean"),
                  key<&TriggerPlan::values>("above", a_value, "of a number"),
                  key<&TriggerPlan::values>("below", a_value, "of a number"),
                  key<&TriggerPlan::values>(
                      "inside",
                      list_of(a_value.as("a bound"))
                          .within(2, 2, "'inside' has two bounds", "write inside: [LOW, HIGH]"),
                      "of a number: the lower and the upper bound"),
                  key<&TriggerPlan::values>("equals", a_value, "of any type")},
         .rules = {{at_least_one, {}, {"signal"}, one_condition, trigger_help, the_map, "L0213"},
                   {exactly_one,
                    {},
                    {"edge", "above", "below", "inside", "equals"},
                    one_condition,
                    trigger_help,
                    the_map,
                    "L0213"}},
         .check = by<check_trigger>});
    return form;
}

void read_trigger(const Reader& read, const Node& node, TracePlan& trace) {
    if (node.is_map())
        read_form(trigger_form(), read, node, trace.trigger);
    else
        read.fail("L0306", node, fmt::format("'{}' is not a trigger", node.text), trigger_help);
}

void read_pre_trigger(const Reader& read, const Node& node, TracePlan& trace);

constexpr const char* triggered = "'{1}' is for a trace with a trigger";
constexpr const char* start_only = "the start of the run has nothing before it, and comes once";

const Form& trace_form() {
    static const Form form = form_of<TracePlan>(
        {.name = "trace",
         .what = "'trace'",
         .doc = "a recording of signals, one row a scan. Rows before a trigger are kept in memory, "
                "8 bytes a signal "
                "and 16 more, at most 256 MiB for all traces",
         .keys =
             {key<&TracePlan::task>("task", a_task, "whose scans are recorded").must(),
              key<&TracePlan::every>(
                  "every",
                  an_integer.at_least(
                      1, {},
                      "'every' counts scans: 1 records every scan of the task, 10 every tenth"),
                  "records every n-th scan")
                  .by_default("1"),
              key<&TracePlan::signals>("signals",
                                       list_of(a_signal)
                                           .filled("'signals' has no signal")
                                           .unique("'{}' is in this trace already"),
                                       "columns")
                  .must(),
              key<read_trigger>("trigger", a_form(trigger_form), "when a measurement begins")
                  .or_word("immediate"),
              key<read_pre_trigger>("pre_trigger", an_integer.at_least(0),
                                    "rows kept from before the trigger")
                  .by_default("0"),
              key<&TracePlan::samples>("samples", an_integer.at_least(1),
                                       "rows from the trigger on, at most"),
              key<&TracePlan::duration>("for", a_time.above_zero("a trace must be longer than 0 s"),
                                        "time from the trigger on, at most"),
              key<&TracePlan::repeat>(
                  "repeat", an_integer.within(1, 1000),
                  "measurements at most; of several, each in a file of its own: out.change.1.csv")
                  .by_default("1")},
         .rules = {{only_with, "pre_trigger", {"trigger"}, triggered, start_only, the_key, "L0213"},
                   {only_with, "repeat", {"trigger"}, triggered, start_only, the_key, "L0213"},
                   {only_with,
                    "repeat",
                    {"samples", "for"},
                    "a repeated trace says how long a measurement lasts",
                    "add samples: 1000 or for: 0.5 s",
                    the_key}}});
    return form;
}

/// The ring's size in memory is checked where the signals are known.
void read_pre_trigger(const Reader& read, const Node& node, TracePlan& trace) {
    trace.ring = node;
    put(read, *trace_form().find("pre_trigger"), node, trace.pre_trigger);
}

void read_trace(const Reader& read, const Node& node, Program& program) {
    read_form(trace_form(), read, node, program.traces.emplace_back());
}

void read_traces(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) {
        if (!read.identifier(name, "a trace")) continue;
        if (name.text == "events") {
            read.fail("L0210", name, "a trace cannot be called 'events'",
                      "NAME.events.csv has the events of the run");
            continue;
        }
        TracePlan& trace = program.traces.emplace_back();
        trace.name = name;
        read_form(trace_form(), read, body, trace, fmt::format("trace '{}'", name.text));
    }
}

// Modbus

struct Mapped {
    Node signal;
    std::optional<Node> type, scale, write;
    bool little = false, low_first = false;
};

const Form& register_form() {
    static const Form form = form_of<Mapped>(
        {.name = "register",
         .what = "a register",
         .doc = "a signal in a table of Modbus; 100: SIGNAL alone is one that is only read",
         .keys = {
             key<&Mapped::signal>("signal", a_signal, "what is read there, and written").must(),
             key<&Mapped::type>(
                 "type",
                 one_of("a type of registers", {"int16", "uint16", "int32", "uint32", "int64",
                                                "uint64", "real32", "real64"}),
                 "of its value, in one register, two or four; unless said real32 of a real, "
                 "int32 of an integer, uint16 of a boolean or an enumeration"),
             key<&Mapped::scale>("scale", a_value,
                                 "what one in the register is, such as 0.001 mm; the signal's "
                                 "unit unless said"),
             key<&Mapped::little>("order", one_of("an order of bytes", {"big", "little"}),
                                  "of the bytes in a register; Modbus has big")
                 .by_default("big"),
             key<&Mapped::low_first>("words",
                                     one_of("an order of words", {"high_first", "low_first"}),
                                     "of the registers of one value")
                 .by_default("high_first"),
             key<&Mapped::write>("write", a_boolean,
                                 "clients may write it, if serve has --allow-write; for coils "
                                 "and holding registers")
                 .by_default("false")}});
    return form;
}

Shape registers() {
    return numbered("an address", 0, 65535, either({a_form(register_form), a_signal}));
}

template <ModbusTable Table>
void read_registers(const Reader& read, const Node& node, Program& program) {
    if (!accept(read, registers(), node, "a table of Modbus")) return;
    for (const auto& [address, value] : node.entries) {
        Mapped mapped{.signal = value, .type = {}, .scale = {}, .write = {}};
        if (value.is_map()) read_form(register_form(), read, value, mapped);
        if (mapped.signal.is_empty())
            read.fail("L0202", value,
                      fmt::format("there is no signal at the address {}", address.text),
                      "name one, or leave the address out");
        else
            program.registers.push_back({Table, address, mapped.signal, mapped.type, mapped.scale,
                                         mapped.little, mapped.low_first, mapped.write});
    }
}

const Form& modbus_form() {
    using enum ModbusTable;
    static const Form form = form_of<Program>(
        {.name = "modbus",
         .what = "'modbus'",
         .doc = "which signals clients of Modbus/TCP find where, see 'lineshaft serve --modbus'. "
                "Addresses count from 0",
         .keys = {key<read_registers<coils>>("coils", registers(), "bits that may be written"),
                  key<read_registers<discrete_inputs>>("discrete_inputs", registers(),
                                                       "bits that are only read"),
                  key<read_registers<holding_registers>>(
                      "holding_registers", registers(), "registers of 16 bits that may be written"),
                  key<read_registers<input_registers>>(
                      "input_registers", registers(), "registers of 16 bits that are only read")}});
    return form;
}

void read_modbus(const Reader& read, const Node& node, Program& program) {
    read_form(modbus_form(), read, node, program);
}

// What must hold

constexpr const char* expectation_help =
    "write it as {at: end, axis.position: 20 mm, within: 1e-9 mm}";

const Form& expected_bounds() {
    static const Form form = form_of<ExpectPlan>(
        {.name = "expected_bounds",
         .what = "an expectation's bounds",
         .doc = "what an expected signal keeps within",
         .keys = {key<&ExpectPlan::at_least>("at_least", a_value, "lower bound"),
                  key<&ExpectPlan::at_most>("at_most", a_value, "upper bound")}});
    return form;
}

const Form& expectation_form();

using When = ExpectPlan::When;

template <When when>
void read_time_of(const Reader& read, const Node& node, ExpectPlan& plan) {
    plan.when = when;
    plan.from = read.time(node).value_or(0);
}

template <When when>
void read_signal_of(const Reader&, const Node& node, ExpectPlan& plan) {
    plan.when = when;
    plan.signal = node;
}

void read_between(const Reader& read, const Node& node, ExpectPlan& plan) {
    plan.when = When::always;
    plan.from = read.time(node.items[0]).value_or(0);
    plan.until = read.time(node.items[1]).value_or(never);
    if (plan.until < plan.from)
        read.fail("L0213", node.items[1], "'between' ends before it begins");
}

/// `within 2 s of inputs.start: move.Done`
void read_answer(const Reader& read, const Node& name, const Node& value, ExpectPlan& plan) {
    constexpr std::string_view begin = "within ", middle = " of ";
    const auto of = name.text.find(middle);
    const auto part = [&](std::size_t from, std::size_t to) {
        Node node = name;
        node.text = name.text.substr(from, to == name.text.npos ? to : to - from);
        node.mark.column += static_cast<int>(from);
        node.mark.length = static_cast<int>(node.text.size());
        return node;
    };
    plan.when = When::answered;
    plan.signal = value;
    if (of == name.text.npos)
        return read.fail("L0201", name, fmt::format("'{}' names no signal", name.text),
                         "write within 2 s of inputs.start: move.Done");
    plan.cause = part(of + middle.size(), name.text.npos);
    const auto limit = read.time(part(begin.size(), of));
    if (accept(read, a_signal, value, "what answers") && limit) plan.until = *limit;
}

/// The keys that are no others: the signal, or who answers.
void read_expected(const Reader& read, const Node& item, ExpectPlan& plan) {
    for (const auto& [name, value] : item.entries) {
        if (expectation_form().find(name.text)) continue;
        if (expectation_form().is_phrase(name.text)) {
            read_answer(read, name, value, plan);
            continue;
        }
        if (!plan.signal.text.empty()) {
            read.fail("L0201", name,
                      fmt::format("an expectation has one signal, '{}' is a second", name.text));
            continue;
        }
        plan.signal = name;
        if (value.is_map())
            read_form(expected_bounds(), read, value, plan);
        else if (accept(read, a_value.as("an expected value"), value, {}))
            plan.equals = value;
    }
}

void check_expectation(const Reader& read, const Node& item, ExpectPlan& plan) {
    plan.mark = item.mark;
    const auto has = [&](std::string_view key) { return item.find(key) != nullptr; };
    const auto& names = expectation_form().rules.back().others;
    if (std::ranges::count_if(names, [&](auto name) {
            return expectation_form().find_in(item, name) != nullptr;
        }) != 1)
        return;
    read_expected(read, item, plan);
    const bool bounded = plan.at_least || plan.at_most;
    const bool of_boolean = has("always") || has("never");
    if ((has("count") && !has("rising")) || (has("equals") && !of_boolean)) return;
    if (plan.signal.text.empty())
        return read.fail("L0202", item, "an expectation names no signal", expectation_help);
    if (plan.when == When::answered) {
        if (plan.equals || bounded)
            read.fail("L0213", item, "an answer is a signal that becomes true, without a value");
        return;
    }
    if (plan.when == When::counted && !plan.equals && !bounded)
        return read.fail("L0202", item, "an expectation has no count",
                         "write count: 3, at_least or at_most");
    if (!plan.equals && !bounded && !of_boolean)
        return read.fail("L0202", item, "an expectation has no value and no bound",
                         "write SIGNAL: VALUE, at_least or at_most");
    if (plan.within && !plan.equals)
        return read.fail(
            "L0202", *plan.within, "'within' is for a value, and there is none",
            of_boolean ? "write equals: VALUE beside it" : "write SIGNAL: VALUE beside it");
    if (plan.equals && bounded)
        read.fail("L0213", item, "an expectation has a value or bounds, not both",
                  "write two expectations");
}

const Form& expectation_form() {
    constexpr std::string_view answer = "within TIME of SIGNAL";
    constexpr std::string_view two = "write two expectations";
    const auto apart = [&](std::string_view key, std::vector<std::string_view> others) {
        return Rule{not_with, key, std::move(others),
                    "an expectation says '{1}' or '{2}', not both", two};
    };
    static const Form form = form_of<ExpectPlan>(Form{
        .name = "expectation",
        .what = "an expectation",
        .doc = "what must hold of one signal: at a time, in every scan, or as often as it should",
        .keys = {key<read_time_of<When::at>>("at", a_time,
                                             "when, after all that is due then; or the end")
                     .or_word("end"),
                 key<read_signal_of<When::always>>(
                     "always", a_signal,
                     "judged in every scan; true, unless a value or bounds are said"),
                 key<read_signal_of<When::excluded>>(
                     "never", a_signal,
                     "judged in every scan; never true, or never this value or within these "
                     "bounds"),
                 key<read_between>("between",
                                   list_of(a_time).within(2, 2, "'between' takes two times",
                                                          "write between: [1 s, 2 s]"),
                                   "from when to when it is judged, then and in every scan"),
                 key<read_signal_of<When::counted>>("rising", a_signal,
                                                    "a boolean whose rising edges are counted"),
                 key<&ExpectPlan::equals>("count", a_value, "with 'rising': how many"),
                 key<&ExpectPlan::equals>("equals", a_value, "with 'always' or 'never': the value"),
                 key<&ExpectPlan::within>("within", a_value,
                                          "distance from the value, or a percentage of it")},
        .rules = {apart("at", {"always", "never", "between", "rising", answer}),
                  apart("always", {"never", "between", "rising", answer}),
                  apart("never", {"between", "rising", answer}),
                  apart("between", {"rising", answer}),
                  apart("rising", {answer, "within", "equals"}),
                  {only_with, "count", {"rising"}, "'count' is for 'rising'"},
                  {only_with,
                   "equals",
                   {"always", "never"},
                   "'equals' is for 'always' and 'never'",
                   "write SIGNAL: VALUE"},
                  {at_least_one,
                   {},
                   {"at", "always", "never", "between", "rising", answer},
                   "an expectation does not say when it holds",
                   expectation_help}},
        .others = key("SIGNAL", either({a_form(expected_bounds), a_value}),
                      "with 'at' or 'between': its value, or its bounds"),
        .phrase = key(answer, a_signal,
                      "a boolean that is true within this time of each rising edge of another"),
        .check = by<check_expectation>}
                                                     .with(expected_bounds()));
    return form;
}

// The run, and all of it

void check_run(const Reader&, const Node& node, RunPlan& run) {
    run.mark = node.mark;
}

const Form& run_form() {
    static const Form form = form_of<RunPlan>(
        {.name = "run",
         .what = "'run'",
         .doc = "covers the time from 0 to its end, both included",
         .keys = {key<&RunPlan::duration>("for", a_time.above_zero("a run must be longer than 0 s"),
                                          "how long to run; "
                                          "with 'until' at most")
                      .must("say how long to run, such as for: 2 s; with 'until' it is the limit"),
                  key<&RunPlan::until>("until", a_signal, "a boolean signal that ends the run"),
                  key<&RunPlan::seed>("seed", an_integer.at_least(0), "of all random numbers")
                      .by_default("1"),
                  key<&RunPlan::continue_on_error>(
                      "on_error", one_of("a way to go on", {"stop", "continue"}),
                      "what a block that sets 'error' does: stop with exit 3, or go on")
                      .by_default("stop")},
         .check = by<check_run>});
    return form;
}

}  // namespace

Key slow_key() {
    return key("slow", a_boolean,
               "takes minutes: 'lineshaft test' runs it with --slow, or when it is named")
        .by_default("false");
}

const Form& block_form() {
    static const Form form = form_of<BlockPlan>(
        {.name = "block",
         .what = "a block",
         .doc = "a function block; its parameters and inputs are keys beside these, see 'lineshaft "
                "blocks TYPE'. An "
                "input is a constant or a wire: b.q, inputs.x, NOT b.q, or previous(b.q) from the "
                "block itself or "
                "one behind it",
         .keys = {key<&BlockPlan::type>("type", a_value.as("a type"),
                                        "one of those that 'lineshaft blocks' lists")
                      .must("'lineshaft blocks' lists the types"),
                  key<&BlockPlan::task>("task", a_task, "scans it, in the order of the file")
                      .must("say which task scans it"),
                  key<&BlockPlan::cost>("cost", a_time, "adds to its task's execution time")
                      .by_default("0 s"),
                  key<&BlockPlan::initial>(
                      "initial", named("an output", a_value),
                      "outputs and what they are before the first scan: what previous() then "
                      "gives")},
         .others = key("PORT", a_value, "a parameter or an input of the type")});
    return form;
}

const Form& use_form() {
    static const Form form = form_of<UsePlan>(
        {.name = "use",
         .what = "a use",
         .doc = "the blocks of a template: left: {use: station} makes left_gate of its block gate",
         .keys = {
             key<&UsePlan::use>("use", a_value.as("the name of a template"), "a template").must(),
             key<&UsePlan::set>("set", named("a parameter", a_value),
                                "values of the template's parameters")}});
    return form;
}

namespace {

/// Only checked: the blocks are read where they are used.
struct TemplatePlan {};

const Form& template_form() {
    static const Form form = form_of<TemplatePlan>(
        {.name = "template",
         .what = "a template",
         .doc = "blocks that stand in the program as often as it is used; those of its own are "
                "named as they are written here",
         .keys = {key("parameters", named("a parameter", either({nothing, a_value})),
                      "names and values that a use may set, and must where there is none; $NAME "
                      "stands for the value"),
                  key("blocks",
                      named("a block", a_block(block_form)).filled("the template has no block"),
                      "in the order of their scan")
                      .must()}});
    return form;
}

Shape drawn() {
    return list_of(either({a_signal, a_name})).unique("'{}' stands in this list already");
}

const Form& report_form() {
    static const Form form = form_of<ReportPlan>(
        {.name = "report",
         .what = "'report'",
         .doc =
             "the page that 'lineshaft report' makes of the program's traces, as it is when it is "
             "opened: whoever looks at it may arrange it in another way",
         .keys = {key<&ReportPlan::plots>(
                      "plots", list_of(drawn().filled("a plot has no signal")),
                      "signals and curves of each plot over time, from the top; what no plot names "
                      "follows, grouped by units"),
                  key<&ReportPlan::own_axis>("own_axis", drawn(),
                                             "signals and curves that have an axis of their own"),
                  key<&ReportPlan::hide>("hide", drawn(),
                                         "signals and curves that are not drawn until asked for"),
                  key<&ReportPlan::curves>(
                      "curves", named("a curve", a_value.as("a formula")),
                      "further curves: + - * /, parentheses, abs, sqrt, min, max, mean and "
                      "derivative(x), by time, over recorded signals"),
                  key<&ReportPlan::paths>(
                      "paths",
                      list_of(list_of(a_signal).within(2, 2)).filled("'paths' has no path"),
                      "pairs of signals, the second drawn over the first"),
                  key<&ReportPlan::circle>(
                      "circle", list_of(a_number).within(3, 3),
                      "x, y and radius of the circle that the paths are compared with; else one "
                      "that is found in them"),
                  key<&ReportPlan::condition>(
                      "while", a_signal,
                      "a boolean signal: a path is compared with the circle while it is true")},
         .rules = {{only_with,
                    "circle",
                    {"paths"},
                    "'circle' is for paths, and there are none",
                    "write paths: [[x.position, y.position]] beside it",
                    the_key},
                   {only_with,
                    "while",
                    {"paths"},
                    "'while' is for paths, and there are none",
                    "write paths: [[x.position, y.position]] beside it",
                    the_key}}});
    return form;
}

void read_report(const Reader& read, const Node& node, Program& program) {
    read_form(report_form(), read, node, program.report.emplace());
}

}  // namespace

const Form& program_form() {
    static const Form form = form_of<Program>(
        {.name = "program",
         .what = "a program",
         .doc = "tasks, blocks in them, and what is recorded and expected of a run. A value may be "
                "$NAME, a "
                "parameter, or a formula: $speed * 2, $radius / 2 + 1 mm, cos(0.02)",
         .keys =
             {key("lineshaft", a_version, "version of this form").must(),
              key<&Program::title>("title", a_value.as("the title"),
                                   "shown in messages and reports"),
              key<&Program::notes>("notes", one_or_list(a_value.as("a note")),
                                   "said in reports of its traces"),
              slow_key(),
              key("parameters", named("a parameter", a_value),
                  "names and values; $NAME stands for the value, --set and studies change it"),
              key("controller", a_value, "a file with tasks, relative to this one"),
              tasks_key<read_tasks>("tasks, or changes to the controller's"),
              key<&Program::sources>(
                  "sources",
                  one_or_list(a_value.as("a file of 'sources'"), "'sources' has no file"),
                  "Structured Text (.st, .scl, .s7dcl, .udt, .db), files or folders, relative to "
                  "this file: "
                  "its programs and function blocks are types of blocks"),
              key<&Program::overflow_faults>("overflow",
                                             one_of("what an overflow does", {"wrap", "fault"}),
                                             "what an integer of Structured Text does beyond its "
                                             "type: wrap, or end the scan with an error")
                  .by_default("wrap"),
              key<read_blocks>(
                  "blocks",
                  named("a block", either({a_form(use_form), a_block(block_form)}))
                      .filled("'blocks' has no block", block_help),
                  "in the order of their scan; NAME: {use: TEMPLATE} is those of a template")
                  .must(block_help),
              key("templates", named("a template", a_form(template_form)),
                  "groups of blocks that 'blocks' may use more than once"),
              key<&Program::inputs>("inputs", named("an input", a_value),
                                    "names and values from outside, as they are at the start"),
              key<&Program::outputs>("outputs", named("an output", a_signal),
                                     "names for outside and the signals that they show"),
              key<&Program::retain>(
                  "retain", list_of(either({a_signal, a_name})).unique("'{}' is retained already"),
                  "blocks with all that they remember, and signals, that outlive a run in "
                  "--retain-file"),
              key<&Program::run>("run", a_form(run_form), "how long")
                  .must("say how long to run: run: {for: 2 s}"),
              key<read_stimuli>("stimulus",
                                list_of(either({a_form(stimulus_form), a_form(replay_form)})),
                                "changes of inputs while running, and files played into them"),
              key<read_forces>("force", list_of(a_form(force_form)),
                               "values that win over what the program writes"),
              key<read_trace>("trace", a_form(trace_form), "what --trace FILE.csv records"),
              key<read_traces>("traces",
                               named("a trace", a_form(trace_form)).filled("'traces' has no trace"),
                               "further traces, written to FILE.NAME.csv"),
              key<read_report>("report", a_form(report_form),
                               "how 'lineshaft report' arranges its traces"),
              key<read_modbus>("modbus", a_form(modbus_form),
                               "where clients of 'lineshaft serve' find signals"),
              key<&Program::expectations>("expect", list_of(a_form(expectation_form)),
                                          "what must hold; exit 1 if it does not")},
         .rules = {{at_least_one,
                    {},
                    {"tasks", "controller"},
                    "a program has no 'tasks' and no 'controller'",
                    task_help}}});
    return form;
}

const Form& controller_form() {
    static const Form form = form_of<Program>(
        {.name = "controller",
         .what = "a controller",
         .doc = "tasks that programs share. One of them that says neither 'every' nor 'on' waits "
                "for a program to "
                "say what starts it",
         .keys = {key("lineshaft_controller", a_version, "version of this form").must(),
                  key("title", a_value.as("the title"), "what it is"),
                  tasks_key<read_controller_tasks>("its tasks").must(),
                  key<read_instruction_time>(
                      "instruction_time", a_form(instruction_time_form),
                      "what an instruction of Structured Text takes; no time unless said")}});
    return form;
}

}  // namespace lineshaft
