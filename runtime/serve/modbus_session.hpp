#pragma once

#include <string>
#include <string_view>

#include "runtime/serve/clients.hpp"
#include "runtime/serve/modbus.hpp"

namespace lineshaft {

/// One connection of Modbus/TCP: bytes in, bytes out. A frame is as long as its header says,
/// whatever stands in it, so that what follows it is the next request, always.
class ModbusSession {
  public:
    ModbusSession(ModbusDesk& desk, ModbusPeer peer) : desk_(desk), peer_(std::move(peer)) {}

    /// The answers to the requests that end with these bytes, each with the transaction and the
    /// unit of its request. A frame of another protocol is passed over.
    std::string take(std::string_view bytes);

    /// A length that no frame has came: where the next one begins is unknown. Nothing more is read.
    bool is_lost() const { return is_lost_; }

  private:
    std::string answer(std::string_view frame);

    ModbusDesk& desk_;
    ModbusPeer peer_;
    bool is_lost_ = false;
    std::string kept_;  ///< of a frame that has not ended
};

/// Answers all requests of a client, until it goes or what it sends is lost. Five minutes without a
/// request are its end, and five seconds in which it takes no answer. One of another machine may
/// only read.
void converse(ModbusDesk& desk, Client& client, World& world);

}  // namespace lineshaft
