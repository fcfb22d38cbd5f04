#pragma once

#include <optional>

#include "runtime/machine/machine.hpp"
#include "runtime/names/net.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// A machine while it is connected with what comes from outside of its blocks.
struct Connecting {
    const Program& program;
    const Net& net;
    Machine& machine;
    Reader read;
};

/// Each puts into the machine what the program says of it; what is wrong is reported.
void connect_outside(Connecting& to);                ///< all of these
void connect_events(Connecting& to);                 ///< outside_run.cpp: what starts event tasks
void connect_run(Connecting& to);                    ///< likewise: duration, seed, `until`
void connect_replays(Connecting& to);                ///< outside_replays.cpp
void connect_retained(Connecting& to);               ///< outside_retain.cpp
void check_constants(Connecting& to);                ///< outside_checks.cpp: what comes to nothing
void warn_of_what_comes_late(const Connecting& to);  ///< likewise

/// What a value from outside is written to.
struct Target {
    Signal signal;     ///< with the unit that it takes
    Field field = {};  ///< of a block, or made up for an input; its name is the node's text
    std::byte* live = nullptr;
    std::byte* published = nullptr;  ///< may be the live one

    bool is_of_block() const { return signal.port.instance >= 0; }
};

/// The readable signal, so an output before an input of the same name; of an output of the program
/// the signal that it shows.
std::optional<Target> find_target(const Connecting& to, const Node& node);
std::optional<Target> find_target(const Connecting& to, Node&& node) = delete;

/// What a stimulus may set: an input that no wire feeds.
std::optional<Target> find_settable(const Connecting& to, const Node& node);
std::optional<Target> find_settable(const Connecting& to, Node&& node) = delete;

/// A value for an input, or for a signal to keep, checked; reported if it cannot be. Their times
/// are still to be said.
std::optional<Stimulus> find_stimulus(const Connecting& to, const Node& signal, const Node& value);
std::optional<Force> find_force(const Connecting& to, const Node& signal, const Node& value);

/// The same in steps: what a force may keep, reported if it cannot be; the value that is meant;
/// and what is made of both. `name` and `text` are as they were written.
std::optional<Target> find_forceable(const Connecting& to, const Node& signal);
std::optional<Target> find_forceable(const Connecting& to, Node&& signal) = delete;
std::optional<Value> read_value(const Connecting& to, const Target& target, const Node& value);
Stimulus stimulus_of(const Target& target, const Value& value, std::string_view name,
                     std::string_view text);
Force force_of(const Machine& machine, const Target& target, const Value& value, std::string text);

}  // namespace lineshaft
