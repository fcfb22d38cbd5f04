#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

void check_stimulus(const Reader&, const Node& item, StimulusPlan& stimulus) {
    stimulus.mark = item.mark;
}

void check_replay(const Reader&, const Node&, ReplayPlan& replay) {
    std::erase_if(replay.set, [](const auto& pair) { return pair.second.is_unknown_parameter(); });
}

/// One for each of its signals.
struct Forced {
    std::int64_t from = 0, until = never;
    Pairs set;
};

void check_force(const Reader& read, const Node& body, Forced& forced) {
    const Node* until = body.find("until");
    if (until && forced.until <= forced.from)
        read.fail(code::entries_do_not_go_together, *until,
                  "'until' is not after 'from': this never forces");
}

}  // namespace

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

}  // namespace lineshaft
