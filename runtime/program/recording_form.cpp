#include "runtime/program/recording_form.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/input_file.hpp"

namespace lineshaft {

namespace {

constexpr YamlLimits recording_limits{.bytes = 256 << 20};
/// Limits of a recording that is not written as `serve` does it.
constexpr YamlLimits other_limits{
    .bytes = 256 << 20, .nodes = 1'000'000, .scalar_bytes = 256 << 20};

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
             key<&RecordingPlan::retained>("retained", a_value.as("retained values"),
                                           "text of the file of retained values that the machine "
                                           "began with, in one line"),
             key<read_entries>("entries", either({list_of(a_form(entry_form)), nothing}),
                               "in the order in which they came")
                 .must()}});
    return form;
}

// clang-format on

namespace {

/// As it is written.
bool is_entry_a_line(std::string_view lines) {
    for (; !lines.empty(); lines.remove_prefix(lines.find('\n') + 1))
        if (!lines.starts_with("- ")) return false;
    return true;
}

/// Piece by piece: the nodes of a text take fifty times its memory, an entry a quarter of that.
void read_lines(const std::string& path, std::string_view lines, int first_line, const Reader& read,
                RecordingPlan& plan) {
    constexpr std::size_t piece = 64 << 10;
    constexpr std::string_view key = "entries:\n";
    plan.entries.reserve(static_cast<std::size_t>(std::ranges::count(lines, '\n')));
    while (!lines.empty()) {
        if (interrupt_requested)
            return read.diagnostics().add(code::file_cannot_be_read, {},
                                          fmt::format("cannot read '{}': interrupted", path));
        const std::string_view part =
            lines.substr(0, lines.find('\n', std::min(piece, lines.size() - 1)) + 1);
        const auto file = std::make_shared<SourceFile>(
            SourceFile{path, std::string(key) + std::string(part), first_line - 1});
        if (const auto root = parse_yaml(file, read.diagnostics(), recording_limits))
            read_entries(read, *root->find("entries"), plan);
        first_line += static_cast<int>(std::ranges::count(part, '\n'));
        lines.remove_prefix(part.size());
    }
}

}  // namespace

std::optional<RecordingPlan> read_recording(const std::string& path, Diagnostics& out) {
    const auto whole = read_source(path, out, {}, recording_limits);
    if (!whole) return {};
    constexpr std::string_view key = "\nentries:\n";
    const std::size_t before = out.count();
    const std::string_view text(whole->text.data(), whole->text.rfind('\n') + 1);
    const std::size_t at = text.find(key);
    const std::size_t entries = at == text.npos ? text.size() : at + key.size();
    const bool by_lines = is_entry_a_line(text.substr(entries));
    SourceFile head{path, std::string(by_lines ? text.substr(0, entries) : text)};
    const Reader read(out);
    const auto file = std::make_shared<const SourceFile>(std::move(head));
    const auto root = parse_yaml(file, out, other_limits);
    if (!root || !check_kind(read, *root, "lineshaft_recording")) return {};
    RecordingPlan plan;
    plan.file = file;
    if (!read_form(recording_form(), read, *root, plan)) return {};
    if (by_lines) {
        const auto line = 1 + static_cast<int>(std::ranges::count(text.substr(0, entries), '\n'));
        read_lines(path, text.substr(entries), line, read, plan);
    }
    if (out.count() != before) return {};
    // What came behind the end did not count any more.
    const auto order = [](const RecordedPlan& e) { return std::pair(e.end, e.at); };
    if (!std::ranges::is_sorted(plan.entries, {}, order))
        std::ranges::stable_sort(plan.entries, {}, order);
    return plan;
}

}  // namespace lineshaft
