#include "runtime/program/program_form.hpp"

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

template <auto Read>
Key tasks_key(std::string_view doc) {
    return key<Read>(
        "tasks", named("a task", a_form(task_form)).filled("'tasks' has no task", task_help), doc);
}

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

std::vector<std::string_view> names_of_dialects() {
    std::vector<std::string_view> names;
    for (const st::DialectName& dialect : st::dialect_names()) names.push_back(dialect.name);
    return names;
}

}  // namespace

Key slow_key() {
    return key("slow", a_boolean,
               "takes minutes: 'lineshaft test' runs it with --slow, or when it is named")
        .by_default("false");
}

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
                  "Structured Text (.st, .scl, .s7dcl, .udt, .db), projects of TwinCAT (.plcproj) "
                  "and their files (.TcPOU, .TcDUT, .TcGVL, .TcIO, .TcTLEO), PLCopen XML and "
                  "SimaticML (.xml), "
                  "CoDeSys "
                  "2.3 (.exp), "
                  "B&R (.typ, .var, .fun), or folders of them, relative "
                  "to this file: its programs and function blocks are types of blocks"),
              key<&Program::dialect>(
                  "dialect", one_of("a dialect of Structured Text", names_of_dialects()),
                  "how sources in .st are read; the ending of all other files says it. CODESYS and "
                  "TwinCAT round 2.5 to 3 and count TIME in whole ms, for instance, where the "
                  "standard has 2 and ns")
                  .by_default("iec"),
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
              key<&Program::io>(
                  "io", signals_to(a_value.as("a signal")),
                  "addresses of the process image and what they are wired to: an input %IX0.0 "
                  "takes a signal, an output %QW4 goes to an input of a block"),
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
                  key<&Program::notes>("notes", one_or_list(a_value.as("a note")),
                                       "said in reports of its programs' traces, before their own"),
                  tasks_key<read_controller_tasks>("its tasks").must(),
                  key<read_instruction_time>(
                      "instruction_time", a_form(instruction_time_form),
                      "what an instruction of Structured Text takes; no time unless said")}});
    return form;
}

}  // namespace lineshaft
