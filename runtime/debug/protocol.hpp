#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/debug/breakpoints.hpp"
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

}  // namespace lineshaft::debug
