#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/job.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Execute of a command, and its outputs by the rules of PLCopen Part 1 v2.0, 2.4.1: Busy, Done,
/// CommandAborted and Error exclude each other; Busy comes with the edge; what ends it stays while
/// Execute is true, one scan at least. A block that is started anew while it is at work shows the
/// new job alone. What has been reached is shown for one scan at least, also where a buffered
/// command has taken over since.
struct CommandState {
    bool execute = false;
    bool done = false, busy = false, active = false, command_aborted = false, error = false;
    bool reached = false;  ///< InVelocity, InGear, ...
    MotionError error_id = MotionError::none;

    bool last_execute = false;
    bool told = false;                        ///< the end has been shown
    bool reached_shown = false;               ///< `reached` has
    bool started = false;                     ///< at least once
    MotionError refusal = MotionError::none;  ///< of the pins: the job has not been sent

    /// What a start makes of it, with the refusal of the pins. True where the job is to be sent.
    bool begin(JobState& job, MotionError refused);
    /// Sets the outputs by what has been told of the job.
    void show(const JobState& job, const Context& context);
};

/// How far the job is, as far as the task that carries it out has published it.
Progress progress_of(const JobState& job, const Context& context);

/// What all commands to an axis with an Execute have in common: its edge, the pins, the job that
/// goes to the axis, and the outputs.
struct CommandBlock : CommandState {
    std::int64_t axis = nowhere;
    bool continuous_update = false;
    bool updating = false;  ///< ContinuousUpdate, from the edge on
    bool ends = false;      ///< what it has begun, and nothing else, brakes as by MC_Halt
    Request pins;
    Job job;

    static constexpr auto linked_part = &CommandBlock::job;

    /// One scan: send(), then show().
    void run(const Scan& now, const Context& context);

    /// Sends the pins at a rising edge of Execute, and with ContinuousUpdate what has changed: from
    /// an edge at which it is true on, until it goes false or the command has ended (2.4.6). So it
    /// does with Ends, as an MC_Halt.
    void send(const Scan& now, const Context& context);
    void show(const Context& context) { CommandState::show(job, context); }

    /// Whether the axis carries it out.
    bool is_at_work(const Context& context) const;
    Request updated() const;
    /// Puts the pins into the job and the job into the axis' inbox: as a new one, or as a change.
    void start(const Scan& now, const Context& context);
    void update(const Scan& now, const Context& context);

    std::string why(const Context& context, const NameOf& name_of) const;
    /// The way round of a master_loop: `'c' follows 'b', which follows 'a'`; or empty.
    std::string loop(const Context& context, const NameOf& name_of) const;

    MotionError check() const;

    /// How far a command has come that the axis does on top of its motion, or of its master's, and
    /// what it has covered since it ended.
    double covered(const Context& context, const Axis::Running Axis::*running) const;
};

/// A block with a table of pins and nothing else of its own.
template <class Commands>
struct KindOf {
    Commands command;
    std::string_view type, doc;
    std::span<const Field> (*fields)();
};

template <class Block, const auto& kind>
struct PlainBlock : Block {
    static constexpr std::string_view type = kind.type;
    static constexpr std::string_view doc = kind.doc;
    static std::span<const Field> fields() { return kind.fields(); }

    constexpr PlainBlock() { this->pins.command = kind.command; }
    void scan(const Scan& now, const Context& context) { this->run(now, context); }
};

using CommandKind = KindOf<Command>;

template <const CommandKind& kind>
using PlainCommand = PlainBlock<CommandBlock, kind>;

/// Pins of command blocks, to make a table of. Quantities are in the unit of `Axis`.
namespace pin {

Field axis();
Field execute();
Field continuous_update();
Field ends();
Field position(std::string_view doc);
Field distance();
Field velocity(std::string_view doc = "greatest; below 0: the axis' own");
Field end_velocity();
Field acceleration();
Field deceleration();
Field jerk();
Field direction(std::string_view doc = "of a modulo axis");
Field buffer_mode();
Field execution_mode();
Field done(std::string_view doc = "the command has been carried out");
Field reached(std::string_view name, std::string_view doc);

/// Axis and Execute, `inputs`, what comes first of the outputs, and the other outputs of all.
std::vector<Field> table(std::initializer_list<Field> inputs, const Field& first_output);

}  // namespace pin

}  // namespace lineshaft
