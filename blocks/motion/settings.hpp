#pragma once

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// MC_SetPosition (3.17): the axis does not move, its position gets another name. `mcQueued` waits
/// as a buffered command does.
struct SetPosition : CommandBlock {
    bool relative = false;

    static constexpr std::string_view type = "MC_SetPosition";
    static constexpr std::string_view doc =
        "gives the place of an axis another position; it moves nothing, and a motion under way "
        "keeps its way";
    static std::span<const Field> fields();
    constexpr SetPosition() { pins.command = Command::set_position; }
    void scan(const Scan& now, const Context& context);
};

/// MC_WriteParameter (3.20.1).
struct WriteParameter : CommandBlock {
    static constexpr std::string_view type = "MC_WriteParameter";
    static constexpr std::string_view doc = "sets a parameter of an axis, by PLCopen's number";
    static std::span<const Field> fields();
    constexpr WriteParameter() { pins.command = Command::write_parameter; }
    void scan(const Scan& now, const Context& context) { run(now, context); }
};

/// MC_WriteBoolParameter (3.20.2): those that are BOOL alone.
struct WriteBoolParameter : CommandBlock {
    bool value = false;

    static constexpr std::string_view type = "MC_WriteBoolParameter";
    static constexpr std::string_view doc = "switches a parameter of an axis, by PLCopen's number";
    static std::span<const Field> fields();
    constexpr WriteBoolParameter() { pins.command = Command::write_bool_parameter; }
    void scan(const Scan& now, const Context& context);
};

/// MC_SetOverride (3.18): sent when Enable comes, and at each change of a factor while it is true.
/// The factors stay when it falls. Of several the last one that spoke counts, and is Enabled alone.
struct SetOverride : CommandBlock {
    static constexpr std::string_view type = "MC_SetOverride";
    static constexpr std::string_view doc =
        "makes all motions of an axis slower or faster, also those under way";
    static std::span<const Field> fields();
    constexpr SetOverride() { pins.command = Command::set_override; }
    void scan(const Scan& now, const Context& context);
};

/// MC_Home (3.2). `mcDirect`: the position is Position at once. `mcToPosition`: the axis moves to
/// Position. `mcOnSignal`: it moves in Direction until Signal rises; there Position is, and it
/// stops. A Signal that is true from the beginning must fall first. `mcRelative`: Position is added
/// at once. `mcOther` stands for modes of other controllers, and is refused. A buffered one waits
/// for what is at work, as far as that leaves the axis standing, and ends what is superimposed.
struct Home : CommandBlock {
    HomingMode mode = HomingMode::direct;
    bool signal = false, last_signal = false, signalled = false;

    static constexpr std::string_view type = "MC_Home";
    static constexpr std::string_view doc = "makes the position of an axis known";
    static std::span<const Field> fields();
    constexpr Home() {
        pins.command = Command::home;
        pins.reference = Referencing::known;
    }
    void scan(const Scan& now, const Context& context);

  private:
    void look(const Scan& now, const Context& context);
};

}  // namespace lineshaft
