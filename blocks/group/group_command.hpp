#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blocks/group/axes_group.hpp"
#include "blocks/motion/command.hpp"

namespace lineshaft {

/// What all commands to a group with an Execute have in common; outputs as those of commands to an
/// axis.
struct GroupCommandBlock : CommandState {
    std::int64_t group = nowhere;
    GroupRequest pins;
    GroupJob job;

    static constexpr auto linked_part = &GroupCommandBlock::job;

    /// One scan: at a rising edge of Execute the job goes to the group; then the outputs.
    void run(const Scan& now, const Context& context);
    void start(const Scan& now, const Context& context);

    std::string why(const Context&, const NameOf&) const;
    MotionError check() const;
};

using GroupCommandKind = KindOf<GroupCommand>;

template <const GroupCommandKind& kind>
using PlainGroupCommand = PlainBlock<GroupCommandBlock, kind>;

/// Pins of commands to a group. Quantities are in the unit of `AxesGroup`, of rotary axes in deg.
namespace group_pin {

Field group();
/// `Position1` to `Position6`, by the axes' places in the group.
std::vector<Field> coordinates(std::string_view name, PathVector GroupRequest::*member,
                               std::size_t count, std::string_view doc);
std::vector<Field> dynamics();
std::vector<Field> blending();
/// CoordSystem.
std::vector<Field> coordinate_system();
/// What a command has that brakes.
std::vector<Field> braking();

/// AxesGroup and Execute, `inputs`, Done, and the other outputs of all.
std::vector<Field> table(std::initializer_list<std::vector<Field>> inputs,
                         std::string_view done = "the command has been carried out");

}  // namespace group_pin

}  // namespace lineshaft
