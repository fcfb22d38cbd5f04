#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/outside/outside.hpp"

namespace lineshaft {

/// What a value is on its way through a table.
enum class RegisterType : std::uint8_t {
    bit,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    real32,
    real64
};

/// Others have registers.
constexpr bool has_bits(ModbusTable table) {
    return table == ModbusTable::coils || table == ModbusTable::discrete_inputs;
}

/// A signal in a table of Modbus.
struct MappedSignal {
    int address = 0, count = 1;  ///< of its first bit or register; of them
    RegisterType type = RegisterType::bit;
    bool little = false;     ///< the bytes of a register
    bool low_first = false;  ///< the registers of a value
    double scale = 1;        ///< what one in the register is, in the signal's unit
    /// The same as a fraction, of which one part is 1: so that whole numbers keep all their digits.
    /// 0 over 0 where it is none.
    std::int64_t multiplier = 1, divisor = 1;
    bool is_writable = false;
    Signal signal;
    const std::byte* set_to =
        nullptr;  ///< what is set from outside, where that is what is read, too

    int end() const { return address + count; }
};

/// By ModbusTable, each sorted by address.
struct ModbusMap {
    std::array<std::vector<MappedSignal>, 4> tables;

    /// Those that hold `count` bits or registers from `address` on; empty unless they hold all.
    std::span<const MappedSignal> find(ModbusTable table, int address, int count) const;
    bool empty() const;
};

/// Puts a scale into the signal, as a fraction where it is one: 1000, 0.001.
void set_scale(MappedSignal& mapped, double scale);

/// What `modbus:` says. L0421 for signals that overlap, L0422 for what cannot be written, L0423
/// for a type or a scale that does not fit the signal; reported to `to`.
ModbusMap connect_modbus(Connecting& to);

}  // namespace lineshaft
