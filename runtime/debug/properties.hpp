#pragma once

#include "runtime/debug/values.hpp"

namespace lineshaft::debug {

/// What an interface is to, and of a reference to a base the block that is there; `at` null:
/// nothing.
Seat instance_at(const Seat& seat);

/// What GET of a PROPERTY gives, called on a copy of the machine's memory: nothing that it does
/// stays.
struct Got {
    Seat seat = {};
    std::string error = {};  ///< why it gives nothing
};
Got get(const Seat& instance, const st::Routine& getter);

/// The properties of a block that its source wants to be shown.
std::vector<Shown> properties_of(const Seat& instance);

}  // namespace lineshaft::debug
