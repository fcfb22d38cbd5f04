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
                    "A code such as L0203, or a topic such as tests; all of them without it");
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
        spdlog::error("there is no code and no topic '{}'; 'lineshaft explain' lists them", *what);
        result = Exit::wrong;
    });
}

}  // namespace lineshaft
