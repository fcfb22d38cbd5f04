#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "runtime/serve/modbus.hpp"

namespace lineshaft::test {

/// A small program that is served without a port, in this thread: paused, so that its time moves
/// by steps only. What `inputs.fixed` is and what its map has for reading only, nobody may set.
class ServedMachine {
  public:
    ServedMachine();

    Api api() { return {live, desk, loaded}; }
    ModbusDesk modbus(bool allow_write) { return {live, desk, loaded.linked.modbus, allow_write}; }

    /// Everything that a client could change.
    std::string state() const;

    /// One instant further, without forces: what came counts now, and nothing piles up.
    void go_on();

    std::atomic<bool> interrupt = false;
    Loaded loaded;
    Executive executive;
    Live live;
    Desk desk;
};

/// Sends bytes to what answers a socket, and then no more. Returns what is answered.
std::string answer_of(const std::uint8_t* data, std::size_t size, auto&& converse);

}  // namespace lineshaft::test
