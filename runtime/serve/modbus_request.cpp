#include "runtime/serve/modbus_request.hpp"

namespace lineshaft {

namespace {

using enum ModbusException;
using enum ModbusTable;

constexpr int most_bits_read = 2000, most_bits_written = 1968, most_registers_read = 125,
              most_registers_written = 123, most_registers_exchanged = 121;

/// The bytes of a request, of which those that are taken are gone.
class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

    bool has(std::size_t size) const { return bytes_.size() == size; }
    bool has_more_than(std::size_t size) const { return bytes_.size() > size; }
    std::uint8_t byte() {
        const auto first = static_cast<std::uint8_t>(bytes_.front());
        bytes_.remove_prefix(1);
        return first;
    }
    std::uint16_t word() {
        const int high = byte();
        return static_cast<std::uint16_t>(high << 8 | byte());
    }
    ModbusArea area(ModbusTable table) {
        const int address = word();
        return {table, address, word()};
    }

  private:
    std::string_view bytes_;
};

bool is_count(int number, int most) {
    return number >= 1 && number <= most;
}

ModbusException parse_read(Bytes& bytes, ModbusTable table, int most, ModbusRequest& request) {
    if (!bytes.has(4)) return illegal_value;
    request.read = bytes.area(table);
    return is_count(request.read->count, most) ? none : illegal_value;
}

ModbusException parse_single(Bytes& bytes, ModbusTable table, ModbusRequest& request) {
    constexpr int on = 0xFF00;
    if (!bytes.has(4)) return illegal_value;
    ModbusArea area = bytes.area(table);
    const int value = area.count;
    area.count = 1;
    request.written = area;
    if (table == holding_registers)
        request.values.push_back(static_cast<std::uint16_t>(value));
    else
        request.values.push_back(value == on);
    return table == holding_registers || value == 0 || value == on ? none : illegal_value;
}

/// Address, count, number of bytes, bits from the lowest on.
ModbusException parse_coils(Bytes& bytes, ModbusRequest& request) {
    if (!bytes.has_more_than(5)) return illegal_value;
    const ModbusArea area = bytes.area(coils);
    const std::size_t size = bytes.byte();
    if (!is_count(area.count, most_bits_written) ||
        size != (static_cast<std::size_t>(area.count) + 7) / 8 || !bytes.has(size))
        return illegal_value;
    int byte = 0;
    for (int i = 0; i < area.count; ++i) {
        if (i % 8 == 0) byte = bytes.byte();
        request.values.push_back(byte >> i % 8 & 1);
    }
    request.written = area;
    return none;
}

/// The same with registers.
ModbusException parse_registers(Bytes& bytes, int most, ModbusRequest& request) {
    if (!bytes.has_more_than(5)) return illegal_value;
    const ModbusArea area = bytes.area(holding_registers);
    const std::size_t size = bytes.byte();
    if (!is_count(area.count, most) || size != 2 * static_cast<std::size_t>(area.count) ||
        !bytes.has(size))
        return illegal_value;
    for (int i = 0; i < area.count; ++i) request.values.push_back(bytes.word());
    request.written = area;
    return none;
}

ModbusException parse_mask(Bytes& bytes, ModbusRequest& request) {
    if (!bytes.has(6)) return illegal_value;
    request.written = {holding_registers, bytes.word(), 1};
    request.and_mask = bytes.word();
    request.or_mask = bytes.word();
    return none;
}

ModbusException parse_exchange(Bytes& bytes, ModbusRequest& request) {
    if (!bytes.has_more_than(9)) return illegal_value;
    request.read = bytes.area(holding_registers);
    return is_count(request.read->count, most_registers_read)
               ? parse_registers(bytes, most_registers_exchanged, request)
               : illegal_value;
}

}  // namespace

bool writes(std::uint8_t function) {
    switch (function) {
        case write_single_coil:
        case write_single_register:
        case write_multiple_coils:
        case write_multiple_registers:
        case mask_write_register:
        case read_write_registers:
            return true;
        default:
            return false;
    }
}

ModbusException parse(std::string_view text, ModbusRequest& request) {
    Bytes bytes(text);
    request.function = bytes.byte();
    switch (request.function) {
        case read_coils:
            return parse_read(bytes, coils, most_bits_read, request);
        case read_discrete_inputs:
            return parse_read(bytes, discrete_inputs, most_bits_read, request);
        case read_holding_registers:
            return parse_read(bytes, holding_registers, most_registers_read, request);
        case read_input_registers:
            return parse_read(bytes, input_registers, most_registers_read, request);
        case write_single_coil:
            return parse_single(bytes, coils, request);
        case write_single_register:
            return parse_single(bytes, holding_registers, request);
        case write_multiple_coils:
            return parse_coils(bytes, request);
        case write_multiple_registers:
            return parse_registers(bytes, most_registers_written, request);
        case mask_write_register:
            return parse_mask(bytes, request);
        case read_write_registers:
            return parse_exchange(bytes, request);
        default:
            return illegal_function;
    }
}

}  // namespace lineshaft
