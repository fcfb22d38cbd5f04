#include <fmt/core.h>

#include "blocks/axis/axis_states.hpp"
#include "blocks/group/group_states.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* notes =
    "'-': the command is refused, with an error of the block alone; '- (waits)': refused too with\n"
    "BufferMode mcAborting, while a buffered one waits.\n"
    "A buffered command waits for the end of what is at work; its row counts then. Of MC_Stop that "
    "is\n"
    "when it is done and its Execute false. A second MC_Stop is refused: it could only lengthen "
    "the\n"
    "stop or let go of it; the same one, begun anew, goes on to hold the axis and stands no "
    "later.\n"
    "MC_Reset leads to disabled where the power is off, and waits until the axis stands.\n"
    "Without a command: a motion that ends at rest leads to standstill; MC_Stop does when it is\n"
    "done and its Execute false; an error of the axis leads from any state to error_stop.\n";

constexpr const char* group_notes =
    "MC_GroupContinue in standby goes on with a path that MC_GroupInterrupt with FreesGroup has "
    "left.\n"
    "While a group moves its axes are in synchronized_motion and refuse commands of their own, "
    "MC_Stop\n"
    "and MC_Halt too, with axis_in_group, but for MC_Power and MC_Reset: MC_GroupStop, "
    "MC_GroupHalt or\n"
    "MC_GroupInterrupt stops them. In standby they take them. Without power or with an error of "
    "an axis\n"
    "the group is in error_stop, and the others brake on the path.\n";

std::string_view answer(const StateRow& row, std::size_t state) {
    if (row.next[state]) return axis_state_names[static_cast<std::size_t>(*row.next[state])];
    const bool waits =
        can_be_buffered(row.command) && can_be_followed(static_cast<AxisState>(state));
    return waits ? "- (waits)" : "-";
}

void print_axis_states() {
    fmt::print("{:26}", "");
    for (const std::string_view state : axis_state_names) fmt::print(" {:19}", state);
    fmt::print("\n");
    for (const StateRow& row : state_table()) {
        fmt::print("{:26}", row.name);
        for (std::size_t state = 0; state < axis_state_count; ++state)
            fmt::print(" {:19}", answer(row, state));
        fmt::print("\n");
    }
    fmt::print("\n{}", notes);
}

void print_group_states() {
    fmt::print("\nOf a group of axes (axes_group):\n\n{:26}", "");
    for (const std::string_view state : group_state_names) fmt::print(" {:19}", state);
    fmt::print("\n");
    for (const GroupStateRow& row : group_state_table()) {
        fmt::print("{:26}", row.name);
        for (const auto& next : row.next)
            fmt::print(" {:19}", next ? group_state_names[static_cast<std::size_t>(*next)] : "-");
        fmt::print("\n");
    }
    fmt::print("\n{}", group_notes);
}

}  // namespace

void add_states(CLI::App& app, Exit&) {
    CLI::App* sub = app.add_subcommand(
        "states", "Print what each command does to an axis or a group, by its state (PLCopen)");
    sub->callback([] {
        print_axis_states();
        print_group_states();
    });
}

}  // namespace lineshaft
