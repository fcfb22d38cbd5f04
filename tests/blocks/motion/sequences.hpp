#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blocks/motion/command.hpp"
#include "tests/blocks/motion/bench.hpp"

namespace lineshaft::test {

/// A pin is set before an instant.
struct PinChange {
    std::int64_t at = 0;  ///< [ms]
    std::size_t pin = 0;
    double value = 0;
};
using PinChanges = std::vector<PinChange>;

/// What is left of events that go wrong when none can be left out any more.
PinChanges shrunk(PinChanges events, const std::function<bool(const PinChanges&)>& goes_wrong);

/// A command block of each axis, and the pins that are set at random.
struct CommandDraw {
    const char *type, *pins;
};

/// Programs of axes with command blocks whose pins are set at random, and what must hold in each
/// scan and at the end. To be derived from; the pins' values stand in sequences.cpp.
class Sequences {
  public:
    struct Setup {
        int axes = 1;                           ///< x0, x1, ..., in the task `servo`
        std::span<const CommandDraw> commands;  ///< of each axis
        std::span<const char* const> tasks;     ///< of the commands, in turn
        bool modulo = false;                    ///< every second axis
        std::int64_t length = 400;              ///< of a sequence [ms]
        std::int64_t patience = 8000;           ///< until all is over, afterwards [ms]
        std::int64_t pause = 1;                 ///< between instants with events, at least [ms]
        std::size_t at_once = 6;                ///< events in an instant, at most
        CommandRules rules = CommandRules::plcopen;
    };

    explicit Sequences(const Setup& setup);
    virtual ~Sequences() = default;

    PinChanges draw(std::uint64_t seed) const;
    /// What goes wrong; empty for nothing.
    std::string run(const PinChanges& events);
    std::string text(const PinChanges& events) const;

  protected:
    virtual void begin() {}
    virtual std::string check() = 0;
    /// So long after the last event; sets pins, and says whether all is over.
    virtual bool ends(std::int64_t after) = 0;

    void set(std::size_t pin, double value);
    void set_all(std::string_view ending, std::string_view beginning, double value);
    const Axis& axis(std::size_t number) const { return *axis_[number]; }
    std::size_t axes() const { return axis_.size(); }

    struct NamedCommand {
        std::string name;
        std::string_view type;
        CommandBlock* block = nullptr;
    };
    const std::vector<NamedCommand>& commands() const { return commands_; }
    std::int64_t now() const { return bench_.now(); }  ///< [ms]

  private:
    struct Pin {
        std::string name;
        Type type;
        std::vector<double> values;  ///< drawn from
    };

    std::string program();
    void add_pins(const std::string& name, const CommandDraw& command);

    Setup setup_;
    std::vector<Pin> pins_;
    std::vector<std::size_t> powers_;
    std::vector<NamedCommand> commands_;
    MotionBench bench_;
    std::vector<std::byte*> places_;
    std::vector<const Axis*> axis_;
};

/// Draws `count` sequences and fails with the first that goes wrong, shrunk.
void check_sequences(Sequences& sequences, std::int64_t count, std::string_view what);

}  // namespace lineshaft::test
