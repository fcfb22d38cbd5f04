#include "runtime/program/schema.hpp"

#include <fmt/core.h>

#include "blocks/catalog.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/forms.hpp"

namespace lineshaft {

void add_schema(CLI::App& app, Exit&) {
    CLI::App* sub =
        app.add_subcommand("schema", "Print the JSON schema of program and study files");
    sub->callback([] { fmt::print("{}\n", file_schema(standard_blocks(), files).dump(2)); });
}

}  // namespace lineshaft
