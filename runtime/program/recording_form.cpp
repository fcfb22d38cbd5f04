#include "runtime/program/recording_form.hpp"

#include <algorithm>

namespace lineshaft {

namespace {

constexpr YamlLimits recording_limits{.bytes = 256 << 20, .nodes = 20'000'000};

// clang-format off: tables are laid out by hand

void check_entry(const Reader&, const Node& item, RecordedPlan& entry) {
    entry.mark = item.mark;
}

const Form& entry_form() {
    static const Form form = form_of<RecordedPlan>(
        {.name = "recorded",
         .what = "an entry of a recording",
         .doc = "what came from outside at one time",
         .keys = {key<&RecordedPlan::at>("at", a_time, "before every scan of this time").must(),
                  key<&RecordedPlan::set>("set", signals_to(a_value.as("a value")),
                                          "inputs and their new values"),
                  key<&RecordedPlan::force>("force", signals_to(a_value.as("a value")),
                                            "signals, and the values that they keep from then on"),
                  key<&RecordedPlan::lift_force>("release", list_of(a_signal),
                                                 "signals that are not forced any more"),
                  key<&RecordedPlan::end>("end", a_boolean, "the machine was served until then")
                      .by_default("false")},
         .rules = {{Rule::Kind::at_least_one, {}, {"set", "force", "release", "end"}}},
         .check = by<check_entry>});
    return form;
}

void read_entries(const Reader& read, const Node& node, RecordingPlan& recording) {
    if (node.is_empty() || !read.expect_sequence(node, "'entries'")) return;
    for (const Node& item : node.items)
        if (RecordedPlan entry; read_form(entry_form(), read, item, entry))
            recording.entries.push_back(std::move(entry));
}

}  // namespace

const Form& recording_form() {
    static const Form form = form_of<RecordingPlan>(
        {.name = "recording",
         .what = "a recording",
         .doc = "what came from outside while 'lineshaft serve' ran a program; 'run --recording' "
                "plays it back, to the "
                "same bytes. It ends where its last entry is",
         .keys = {
             key("lineshaft_recording", a_version, "version of this form").must(),
             key<&RecordingPlan::program>("program", a_value.as("the program"), "name of its file"),
             key<&RecordingPlan::meaning>(
                 "meaning", a_value.as("the program's meaning"),
                 "16 hexadecimal digits: tells whether the program is another one now"),
             key<read_entries>("entries", either({list_of(a_form(entry_form)), nothing}),
                               "in the order in which they came")
                 .must()}});
    return form;
}

// clang-format on

std::optional<RecordingPlan> read_recording(const std::string& path, Diagnostics& out) {
    const auto whole = read_source(path, out, {}, recording_limits);
    if (!whole) return {};
    SourceFile lines{whole->path, whole->text.substr(0, whole->text.rfind('\n') + 1)};
    const Reader read(out);
    const auto root =
        parse_yaml(std::make_shared<SourceFile>(std::move(lines)), out, recording_limits);
    if (!root || !check_kind(read, *root, "lineshaft_recording")) return {};
    RecordingPlan plan;
    if (!read_form(recording_form(), read, *root, plan)) return {};
    // What came behind the end did not count any more.
    std::ranges::stable_sort(plan.entries, {},
                             [](const RecordedPlan& e) { return std::pair(e.end, e.at); });
    return plan;
}

}  // namespace lineshaft
