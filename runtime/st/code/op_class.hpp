#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lineshaft::st {

/// What an instruction is priced as.
enum class OpClass : std::uint8_t { move, jump, call, boolean, integer, real, text, none };
inline constexpr std::size_t op_classes = 7;

/// What an executed instruction of each OpClass takes [ns].
using InstructionTimes = std::array<std::int64_t, op_classes>;

}  // namespace lineshaft::st
