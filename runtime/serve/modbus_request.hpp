#pragma once

#include <optional>

#include "runtime/serve/modbus.hpp"

namespace lineshaft {

/// Function codes.
enum ModbusFunction : std::uint8_t {
    read_coils = 1,
    read_discrete_inputs = 2,
    read_holding_registers = 3,
    read_input_registers = 4,
    write_single_coil = 5,
    write_single_register = 6,
    write_multiple_coils = 15,
    write_multiple_registers = 16,
    mask_write_register = 22,
    read_write_registers = 23,
};

struct ModbusRequest {
    std::uint8_t function = 0;
    std::optional<ModbusArea> read, written;
    std::vector<std::uint16_t> values;             ///< that are written: 0 or 1 of a coil
    std::uint16_t and_mask = 0xFFFF, or_mask = 0;  ///< of mask_write_register
};

/// Whether a function changes something.
bool writes(std::uint8_t function);

/// Reads a request from its function code on: it must be as long as its function says, to the byte.
/// illegal_function where there is no such function here: 7, 8, 11, 12 and 17 are of serial lines,
/// the others of devices that have files, queues or an identification.
ModbusException parse(std::string_view bytes, ModbusRequest& request);

}  // namespace lineshaft
