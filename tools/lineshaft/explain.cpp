#include <algorithm>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "tools/lineshaft/codes.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

/// A file of topics/.
struct Topic {
    std::string_view name;
    std::string_view text;  ///< its first line is the title

    std::string_view title() const { return text.substr(0, text.find('\n')); }
};

constexpr Topic topics[] = {
#include "tools/lineshaft/topics.inc"
};

/// The paragraph under that name in the topic that tells of faults; empty: there is none.
std::string_view fault_text(std::string_view name) {
    const auto faults = std::ranges::find(topics, "faults", &Topic::name);
    const std::size_t at = faults->text.find(fmt::format("\n\n{}\n  ", name));
    if (at == std::string_view::npos) return {};
    const std::string_view from = faults->text.substr(at + 2);
    const std::string_view text = from.substr(0, from.find("\n\n"));
    return text.substr(0, text.find_last_not_of('\n') + 1);
}

void print_list() {
    for (const CodeText& text : diagnostic_codes()) fmt::print("{}  {}\n", text.code, text.title);
    fmt::print("\n");
    for (const Topic& topic : topics) fmt::print("{:15}  {}\n", topic.name, topic.title());
}

}  // namespace

void add_explain(CLI::App& app, Exit& result) {
    auto what = std::make_shared<std::string>();
    CLI::App* sub = app.add_subcommand(
        "explain",
        "Print the paragraph behind a message's code, or what there is to know of a topic");
    sub->add_option("what", *what,
                    "A code such as L0203, a topic such as tests, or a fault such as no_end; codes "
                    "and topics without it");
    sub->callback([what, &result] {
        if (what->empty()) return print_list();
        if (const CodeText* text = find_code(*what)) {
            fmt::print("{}: {}\n\n{}\n", text->code, text->title, text->paragraph);
            return;
        }
        if (const auto topic = std::ranges::find(topics, *what, &Topic::name);
            topic != std::end(topics)) {
            fmt::print("{}: {}", topic->name, topic->text);
            return;
        }
        if (const std::string_view text = fault_text(*what); !text.empty()) {
            fmt::print("{}\n", text);
            return;
        }
        std::vector<std::string> names;
        for (const Topic& topic : topics) names.emplace_back(topic.name);
        spdlog::error("there is no code and no topic '{}'; {}", *what,
                      nearest(*what, names).empty() ? "'lineshaft explain' lists them"
                                                    : suggest(*what, names));
        result = Exit::wrong;
    });
}

}  // namespace lineshaft
