#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "tools/lineshaft/codes.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

void add_explain(CLI::App& app, Exit& result) {
    auto code = std::make_shared<std::string>();
    CLI::App* sub = app.add_subcommand("explain", "Print the paragraph behind a message's code");
    sub->add_option("code", *code, "A code such as L0203; all codes without it");
    sub->callback([code, &result] {
        if (code->empty()) {
            for (const CodeText& text : diagnostic_codes())
                fmt::print("{}  {}\n", text.code, text.title);
            return;
        }
        if (const CodeText* text = find_code(*code)) {
            fmt::print("{}: {}\n\n{}\n", text->code, text->title, text->paragraph);
            return;
        }
        spdlog::error("no message has the code '{}'; 'lineshaft explain' lists them", *code);
        result = Exit::wrong;
    });
}

}  // namespace lineshaft
