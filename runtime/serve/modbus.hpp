#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/serve/audit.hpp"
#include "runtime/serve/desk.hpp"
#include "runtime/serve/live.hpp"

namespace lineshaft {

/// Exceptions by the MODBUS Application Protocol Specification V1.1b3, chapter 7.
enum class ModbusException : std::uint8_t {
    none = 0,
    illegal_function = 1,
    illegal_address = 2,
    illegal_value = 3,
    device_failure = 4,
    busy = 6,
};

/// Coils or registers that follow each other in a table.
struct ModbusArea {
    ModbusTable table;
    int address = 0, count = 0;
};

/// What a request says, as its function's own lengths and limits allow it.
struct ModbusRequest;

/// Who asks.
struct ModbusPeer {
    std::string address;  ///< number of its machine
    bool may_write = false;
};

/// What a program's map makes of requests. For any thread.
class ModbusDesk {
  public:
    /// `audit` may be null.
    ModbusDesk(Live& live, Desk& desk, const ModbusMap& map, bool allow_write,
               Audit* audit = nullptr)
        : live_(live), desk_(desk), map_(map), allow_write_(allow_write), audit_(audit) {}

    /// The answer to a request, both from the function code on. An exception's code is 1 for a
    /// function that is not there, and for writing that is not allowed; 2 where the map has a
    /// hole, half of a value or what is only read; 3 for a length, a count or a value that cannot
    /// be; 4 when what was written is not kept; 6 when the machine has too much to do. Reading and
    /// writing of one request are one moment of the machine: nothing of others comes in between,
    /// and of what is refused nothing is written. Requests to write are noted.
    std::string answer(std::string_view request, const ModbusPeer& peer);

  private:
    using Signals = std::span<const MappedSignal>;

    ModbusException carry_out(const ModbusRequest& request, std::string& data, std::int64_t& at);
    ModbusException find_read(const ModbusRequest& request, Signals& found) const;
    ModbusException find_written(const ModbusArea& area, Signals& found) const;
    ModbusException changes(Signals signals, std::span<const std::uint16_t> words,
                            std::vector<Change>& changes);
    ModbusException mask(const ModbusRequest& request, Signals signals, std::int64_t& at);
    ModbusException keep(const Applied& applied, std::int64_t& at);
    Value value(const MappedSignal& mapped) const;
    std::vector<std::uint16_t> words(Signals signals, const ModbusArea& area) const;

    Live& live_;
    Desk& desk_;
    const ModbusMap& map_;
    bool allow_write_;
    Audit* audit_;
};

}  // namespace lineshaft
