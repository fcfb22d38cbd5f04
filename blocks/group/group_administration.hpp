#pragma once

#include "blocks/group/group_command.hpp"

namespace lineshaft {

/// MC_AddAxisToGroup.
struct AddAxisToGroup : GroupCommandBlock {
    std::int64_t axis = nowhere;

    static constexpr std::string_view type = "MC_AddAxisToGroup";
    static constexpr std::string_view doc = "puts an axis into a group";
    static std::span<const Field> fields();
    constexpr AddAxisToGroup() { pins.command = GroupCommand::add_axis; }
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupStop: holds the group in GroupStopping while Execute is true.
struct GroupStop : GroupCommandBlock {
    static constexpr std::string_view type = "MC_GroupStop";
    static constexpr std::string_view doc =
        "stops a group on its path, and holds it while Execute "
        "is true";
    static std::span<const Field> fields();
    constexpr GroupStop() { pins.command = GroupCommand::stop; }
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupSetOverride: sent when Enable comes, and at each change of a factor while it is true.
/// The factor stays when it falls. Of several the last one that spoke counts, and is Enabled alone.
struct GroupSetOverride : GroupCommandBlock {
    static constexpr std::string_view type = "MC_GroupSetOverride";
    static constexpr std::string_view doc = "makes a group slower, also on the path under way";
    static std::span<const Field> fields();
    constexpr GroupSetOverride() { pins.command = GroupCommand::set_override; }
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupPower: MC_Power of all axes of a group, whatever state it is in.
struct GroupPower : GroupCommandBlock {
    bool status = false;

    static constexpr std::string_view type = "MC_GroupPower";
    static constexpr std::string_view doc = "switches the power of all axes of a group on and off";
    static std::span<const Field> fields();
    constexpr GroupPower() { pins.command = GroupCommand::power; }
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupInterrupt. Beyond the standard: FreesGroup lets the group take other moves once it
/// stands, as SoftMotion's continueData does.
struct GroupInterrupt : GroupCommandBlock {
    bool frees_group = false;

    static constexpr std::string_view type = "MC_GroupInterrupt";
    static constexpr std::string_view doc = "stops a group on its path, which it keeps";
    static std::span<const Field> fields();
    constexpr GroupInterrupt() { pins.command = GroupCommand::interrupt; }
    void scan(const Scan& now, const Context& context);
};

namespace group_kinds {

std::span<const Field> remove_axis_fields();
std::span<const Field> plain_fields();
std::span<const Field> standing_fields();
std::span<const Field> transform_fields();

inline constexpr GroupCommandKind remove_axis{GroupCommand::remove_axis, "MC_RemoveAxisFromGroup",
                                              "takes an axis out of a group", remove_axis_fields};
inline constexpr GroupCommandKind ungroup{GroupCommand::ungroup, "MC_UngroupAllAxes",
                                          "takes all axes out of a group", plain_fields};
inline constexpr GroupCommandKind enable{GroupCommand::enable, "MC_GroupEnable",
                                         "lets a group take moves", plain_fields};
inline constexpr GroupCommandKind disable{GroupCommand::disable, "MC_GroupDisable",
                                          "lets a group take no moves any more", plain_fields};
inline constexpr GroupCommandKind reset{GroupCommand::reset, "MC_GroupReset",
                                        "ends the error of a group and of its axes", plain_fields};
inline constexpr GroupCommandKind halt{GroupCommand::halt, "MC_GroupHalt",
                                       "stops a group on its path", standing_fields};
inline constexpr GroupCommandKind go_on{GroupCommand::go_on, "MC_GroupContinue",
                                        "lets an interrupted group go on", plain_fields};

inline constexpr GroupCommandKind set_transform{
    GroupCommand::set_transform, "MC_SetCartesianTransform",
    "says where the product's coordinates stand in the machine's", transform_fields};

}  // namespace group_kinds

using RemoveAxisFromGroup = PlainGroupCommand<group_kinds::remove_axis>;
using UngroupAllAxes = PlainGroupCommand<group_kinds::ungroup>;
using GroupEnable = PlainGroupCommand<group_kinds::enable>;
using GroupDisable = PlainGroupCommand<group_kinds::disable>;
using GroupReset = PlainGroupCommand<group_kinds::reset>;
using GroupHalt = PlainGroupCommand<group_kinds::halt>;
using SetCartesianTransform = PlainGroupCommand<group_kinds::set_transform>;
using GroupContinue = PlainGroupCommand<group_kinds::go_on>;

}  // namespace lineshaft
