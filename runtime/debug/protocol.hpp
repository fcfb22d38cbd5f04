#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/debug/breakpoints.hpp"
#include "runtime/debug/data_breakpoints.hpp"
#include "runtime/debug/signal_conditions.hpp"
#include "runtime/messages/messages.hpp"

namespace lineshaft::debug {

/// What a request cannot have: the text is for the user.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What the answer to `initialize` says.
Json capabilities();

/// The protocol's Source: an absolute path, as editors ask for.
Json source_of(const std::string& path);

/// What a client sets, whose first line has the number 1 - `shift`.
std::vector<Wanted> wanted_in(const Json& arguments, int shift);

/// What became of a breakpoint, for a client whose first line has the number 1 - `shift`.
Json breakpoint_as_json(const Breakpoint& breakpoint, const std::string& path, int shift);

/// Whether a variable can have a data breakpoint: `id` is empty where it cannot.
Json data_as_json(const std::string& variable, const std::string& name, const std::string& id);

/// What a variable of Structured Text that is no signal is given by hand: refused where that cannot
/// be.
struct Written {
    std::string text;  ///< the value, as it is shown then
    std::function<void()> write;
};
Written write_by_hand(const Shown& shown, const std::string& value,
                      const std::vector<Frame>& frames, const DataBreakpoints& lasting);

/// Sets those that a client wants, and tells what became of each.
Json set_function_breakpoints(const Json& arguments, SignalConditions& signals);
Json set_data_breakpoints(const Json& arguments, DataBreakpoints& data);

}  // namespace lineshaft::debug
