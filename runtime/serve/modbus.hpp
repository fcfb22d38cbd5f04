#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/serve/desk.hpp"
#include "runtime/serve/http.hpp"
#include "runtime/serve/live.hpp"

struct _modbus_mapping_t;

namespace lineshaft {

/// The four tables of one client, of 65536 addresses each, as libmodbus has them: what a request is
/// about is put there before libmodbus answers it.
using ModbusTables = ::_modbus_mapping_t;

/// What a program's map makes of requests. For any thread.
class ModbusDesk {
  public:
    ModbusDesk(Live& live, Desk& desk, const ModbusMap& map, bool allow_write)
        : live_(live), desk_(desk), map_(map), allow_write_(allow_write) {}

    /// What a request (function code and what follows it) wants: its values are put into `tables`,
    /// or into the machine. 0, or the exception code of the standard: 1 for another function, and
    /// for writing that is not allowed; 2 where the map has a hole, half of a value or what is only
    /// read; 3 for a value or a count that cannot be; 6 when the machine has too much to do.
    int handle(std::span<const std::uint8_t> request, bool may_write, ModbusTables& tables);

    /// Answers all requests of a client that come to a socket, until it goes or sends what cannot
    /// be understood.
    void converse(int socket, bool may_write, ModbusTables& tables);

  private:
    struct Request;
    int read(ModbusTable table, int address, int count, ModbusTables& tables);
    int write(ModbusTable table, int address, std::span<const std::uint16_t> values);
    int write_bits(const Request& request);
    int write_registers(const Request& request, std::size_t header);
    int mask(const Request& request, ModbusTables& tables);

    Live& live_;
    Desk& desk_;
    const ModbusMap& map_;
    bool allow_write_;
};

/// Modbus/TCP by libmodbus, a thread for each client: one that is slow, or sends half a request,
/// holds up nobody else. From the constructor on until it is destroyed. Clients of other machines
/// may only read.
class ModbusServer {
  public:
    static constexpr std::size_t most_clients = 16;

    ModbusServer(ModbusDesk& desk, const Address& address);
    ~ModbusServer();
    ModbusServer(const ModbusServer&) = delete;
    ModbusServer& operator=(const ModbusServer&) = delete;

    bool failed() const { return listener_ < 0; }

  private:
    struct Client {
        Client(int s, bool near) : socket(s), is_near(near) {}

        int socket;
        bool is_near;  ///< of this machine
        std::atomic<bool> gone = false;
        std::thread thread = {};
    };

    void work();
    void admit();
    void serve(Client& client);

    ModbusDesk& desk_;
    int listener_ = -1;
    std::atomic<bool> ends_ = false;
    std::list<Client> clients_;  ///< of work()'s thread
    std::thread thread_;
};

}  // namespace lineshaft
