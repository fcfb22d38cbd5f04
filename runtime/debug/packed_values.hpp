#pragma once

#include "runtime/debug/values.hpp"
#include "runtime/st/code/bytes.hpp"

namespace lineshaft::debug {

/// A member of a UNION, in a copy that has slots as all else: its bytes are those of the others.
Seat member_of_union(const Seat& whole, const st::Variable& member);

/// What stands at an address, in a copy likewise; `at` null: nothing does.
Seat seat_in_image(const ImageAddress& address, const st::Type& type, const Frame& frame);

/// What begins at any byte of a variable, in a copy likewise; `at` null: nothing of that type.
Seat seat_in_bytes(const st::Bytes& from, const st::Type& type, const Frame& frame);

/// Gives the value, as slots have it, to what stands there, or is packed there, whenever it is
/// called.
std::function<void()> writing(const Seat& seat, std::vector<std::byte> value);

}  // namespace lineshaft::debug
