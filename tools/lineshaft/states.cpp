#include <fmt/core.h>

#include "blocks/axis/axis_states.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* notes =
    "'-': the command is refused, with an error of the block alone.\n"
    "A buffered command waits for the end of the motion; its row counts then.\n"
    "MC_Reset leads to disabled where the power is off, and waits until the axis stands.\n"
    "Without a command: a motion that ends at rest leads to standstill; MC_Stop does when it is\n"
    "done and its Execute false; an error of the axis leads from any state to error_stop.\n";

}  // namespace

void add_states(CLI::App& app, Exit&) {
    CLI::App* sub = app.add_subcommand(
        "states", "Print what each command does to an axis, by the axis' state (PLCopen)");
    sub->callback([] {
        fmt::print("{:26}", "");
        for (const std::string_view state : axis_state_names) fmt::print(" {:19}", state);
        fmt::print("\n");
        for (const StateRow& row : state_table()) {
            fmt::print("{:26}", row.name);
            for (const auto& next : row.next)
                fmt::print(" {:19}",
                           next ? axis_state_names[static_cast<std::size_t>(*next)] : "-");
            fmt::print("\n");
        }
        fmt::print("\n{}", notes);
    });
}

}  // namespace lineshaft
