#pragma once

#include "runtime/debug/values.hpp"

namespace lineshaft::debug {

/// A member of a UNION, in a copy that has slots as all else: its bytes are those of the others.
Seat member_of_union(const Seat& whole, const st::Variable& member);

/// A variable at an address, in a copy likewise; `at` null: no source names an address.
Seat seat_in_image(const st::Variable& variable, const Frame& frame);

}  // namespace lineshaft::debug
