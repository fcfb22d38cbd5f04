#pragma once

#include <array>

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// What PLCopen Part 1 v2.0, 3.21 to 3.23, calls MC_INPUT_REF and MC_OUTPUT_REF: 32 digital signals
/// each, numbered from 1. The standard leaves to the supplier what they are.
inline constexpr std::int64_t digital_signals = 32;

/// Inputs: each is wired, or set from outside.
struct DigitalInputs {
    std::array<bool, digital_signals> in{};

    static constexpr std::string_view type = "digital_inputs";
    static constexpr std::string_view doc = "32 digital inputs, for MC_ReadDigitalInput";
    static constexpr std::string_view handle = "MC_INPUT_REF";
    static std::span<const Field> fields();
    void scan(const Scan&) {}
};

/// Outputs: MC_WriteDigitalOutput sets them. What a task has written counts in the first scan after
/// that task has published it, as a command to an axis does.
struct DigitalOutputs {
    /// What was written to an output last, the number of that writing, and that of the last which
    /// counts.
    struct Write {
        bool waits = false, value = false;
        std::int64_t ticket = 0, taken = 0;
        std::int64_t task = 0, scan = 0;  ///< in which it was written
    };

    std::array<bool, digital_signals> out{};
    std::array<Write, digital_signals> writes{};

    static constexpr std::string_view type = "digital_outputs";
    static constexpr std::string_view doc = "32 digital outputs, for MC_WriteDigitalOutput";
    static constexpr std::string_view handle = "MC_OUTPUT_REF";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);

    /// Number of the writing.
    std::int64_t write(std::int64_t number, bool value, const Scan& now, const Context& context);
};

/// MC_ReadDigitalInput, MC_ReadDigitalOutput (3.21, 3.22).
struct ReadDigital {
    std::int64_t signals = nowhere, number = 1;
    bool enable = false;
    bool valid = false, busy = false, error = false, value = false;
    MotionError error_id = MotionError::none;

    /// Whether there is a signal to look at.
    bool look();
};

struct ReadDigitalInput : ReadDigital {
    static constexpr std::string_view type = "MC_ReadDigitalInput";
    static constexpr std::string_view doc = "tells a digital input by its number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

struct ReadDigitalOutput : ReadDigital {
    static constexpr std::string_view type = "MC_ReadDigitalOutput";
    static constexpr std::string_view doc = "tells a digital output by its number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_WriteDigitalOutput (3.23): once, at a rising edge of Execute. There is no axis whose queue it
/// could wait in: mcQueued is refused.
struct WriteDigitalOutput {
    std::int64_t signals = nowhere, number = 1;
    bool execute = false, value = false;
    BufferMode mode = BufferMode::aborting;
    bool done = false, busy = false, error = false;
    MotionError error_id = MotionError::none;

    bool last_execute = false, waits = false, told = false;
    std::int64_t written = 0, ticket = 0;  ///< the output, 0: none; the number of the writing

    static constexpr std::string_view type = "MC_WriteDigitalOutput";
    static constexpr std::string_view doc = "sets a digital output by its number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);

  private:
    void start(const Scan& now, const Context& context);
};

}  // namespace lineshaft
