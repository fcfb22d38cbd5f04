#include "runtime/serve/modbus.hpp"

#include <algorithm>

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "runtime/serve/registers.hpp"

namespace lineshaft {

namespace {

constexpr int illegal_function = MODBUS_EXCEPTION_ILLEGAL_FUNCTION,
              illegal_address = MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS,
              illegal_value = MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE,
              busy = MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY;

constexpr std::uint8_t known_functions[] = {MODBUS_FC_READ_COILS,
                                            MODBUS_FC_READ_DISCRETE_INPUTS,
                                            MODBUS_FC_READ_HOLDING_REGISTERS,
                                            MODBUS_FC_READ_INPUT_REGISTERS,
                                            MODBUS_FC_WRITE_SINGLE_COIL,
                                            MODBUS_FC_WRITE_SINGLE_REGISTER,
                                            MODBUS_FC_WRITE_MULTIPLE_COILS,
                                            MODBUS_FC_WRITE_MULTIPLE_REGISTERS,
                                            MODBUS_FC_MASK_WRITE_REGISTER,
                                            MODBUS_FC_WRITE_AND_READ_REGISTERS};

bool is_of_bits(ModbusTable table) {
    return table == ModbusTable::coils || table == ModbusTable::discrete_inputs;
}

std::uint8_t* bits_of(ModbusTables& tables, ModbusTable table) {
    return table == ModbusTable::coils ? tables.tab_bits : tables.tab_input_bits;
}

std::uint16_t* registers_of(ModbusTables& tables, ModbusTable table) {
    return table == ModbusTable::holding_registers ? tables.tab_registers
                                                   : tables.tab_input_registers;
}

}  // namespace

/// Function code and what follows it.
struct ModbusDesk::Request {
    std::span<const std::uint8_t> bytes;

    int word(std::size_t at) const { return bytes[at] << 8 | bytes[at + 1]; }
    bool has(std::size_t size) const { return bytes.size() >= size; }
};

int ModbusDesk::handle(std::span<const std::uint8_t> bytes, bool may_write, ModbusTables& tables) {
    using enum ModbusTable;
    const Request request{bytes};
    if (std::ranges::find(known_functions, bytes[0]) == std::end(known_functions))
        return illegal_function;
    if (!request.has(5)) return illegal_value;
    const int address = request.word(1), count = request.word(3);
    const auto check = [](int number, int most) { return number >= 1 && number <= most; };
    switch (bytes[0]) {
        case MODBUS_FC_READ_COILS:
        case MODBUS_FC_READ_DISCRETE_INPUTS:
            if (!check(count, MODBUS_MAX_READ_BITS)) return illegal_value;
            return read(bytes[0] == MODBUS_FC_READ_COILS ? coils : discrete_inputs, address, count,
                        tables);
        case MODBUS_FC_READ_HOLDING_REGISTERS:
        case MODBUS_FC_READ_INPUT_REGISTERS:
            if (!check(count, MODBUS_MAX_READ_REGISTERS)) return illegal_value;
            return read(
                bytes[0] == MODBUS_FC_READ_HOLDING_REGISTERS ? holding_registers : input_registers,
                address, count, tables);
        default:
            break;
    }
    if (!allow_write_ || !may_write) return illegal_function;
    switch (bytes[0]) {
        case MODBUS_FC_WRITE_SINGLE_COIL: {
            if (count != 0 && count != 0xFF00) return illegal_value;
            const auto value = static_cast<std::uint16_t>(count != 0);
            return write(coils, address, {&value, 1});
        }
        case MODBUS_FC_WRITE_SINGLE_REGISTER: {
            const auto value = static_cast<std::uint16_t>(count);
            return write(holding_registers, address, {&value, 1});
        }
        case MODBUS_FC_WRITE_MULTIPLE_COILS:
            return write_bits(request);
        case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
            return write_registers(request, 1);
        case MODBUS_FC_MASK_WRITE_REGISTER:
            return mask(request, tables);
        case MODBUS_FC_WRITE_AND_READ_REGISTERS: {
            if (!request.has(9) || !check(count, MODBUS_MAX_WR_READ_REGISTERS))
                return illegal_value;
            if (const int exception = write_registers(request, 5)) return exception;
            return read(holding_registers, address, count, tables);
        }
        default:
            return illegal_function;
    }
}

int ModbusDesk::read(ModbusTable table, int address, int count, ModbusTables& tables) {
    const auto signals = map_.find(table, address, count);
    if (signals.empty()) return illegal_address;
    const auto values = live_.mailbox().ask([signals] {
        std::vector<Value> now;
        for (const MappedSignal& mapped : signals) now.push_back(mapped.signal.value());
        return now;
    });
    if (!values) return busy;
    for (std::size_t i = 0; i < signals.size(); ++i) {
        const auto at = static_cast<std::size_t>(signals[i].address);
        if (is_of_bits(table))
            bits_of(tables, table)[at] = std::get<bool>((*values)[i]);
        else
            to_registers(
                signals[i], (*values)[i],
                {registers_of(tables, table) + at, static_cast<std::size_t>(signals[i].count)});
    }
    return 0;
}

int ModbusDesk::write(ModbusTable table, int address, std::span<const std::uint16_t> values) {
    const auto signals = map_.find(table, address, static_cast<int>(values.size()));
    if (signals.empty() || signals.front().address != address ||
        signals.back().end() != address + static_cast<int>(values.size()) ||
        !std::ranges::all_of(signals, &MappedSignal::is_writable))
        return illegal_address;
    std::vector<Wanted> wanted;
    for (const MappedSignal& mapped : signals) {
        const auto value = from_registers(
            mapped, values.subspan(static_cast<std::size_t>(mapped.address - address)));
        if (!value) return illegal_value;
        wanted.push_back({mapped.signal.name, mapped.signal.describe(*value)});
    }
    Diagnostics out;
    auto changes = desk_.changes(Change::Kind::set, wanted, out);
    if (!out.empty()) return illegal_value;
    const auto done = live_.mailbox().ask(
        [live = &live_, changes = std::move(changes)] { return live->apply(changes); });
    return done ? 0 : busy;
}

/// Address, count, number of bytes, bits from the lowest on.
int ModbusDesk::write_bits(const Request& request) {
    const int count = request.word(3);
    if (!request.has(6) || count < 1 || count > MODBUS_MAX_WRITE_BITS ||
        request.bytes[5] != (count + 7) / 8 || !request.has(6 + std::size_t{request.bytes[5]}))
        return illegal_value;
    std::vector<std::uint16_t> values;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        values.push_back(request.bytes[6 + i / 8] >> i % 8 & 1);
    return write(ModbusTable::coils, request.word(1), values);
}

/// The same with registers, from the byte `header` on.
int ModbusDesk::write_registers(const Request& request, std::size_t header) {
    const std::size_t data = header + 5;
    if (!request.has(data)) return illegal_value;
    const int address = request.word(header), count = request.word(header + 2);
    const std::size_t size = request.bytes[data - 1];
    if (count < 1 || count > MODBUS_MAX_WRITE_REGISTERS ||
        size != 2 * static_cast<std::size_t>(count) || !request.has(data + size))
        return illegal_value;
    std::vector<std::uint16_t> values;
    for (std::size_t at = data; at < data + size; at += 2)
        values.push_back(static_cast<std::uint16_t>(request.word(at)));
    return write(ModbusTable::holding_registers, address, values);
}

/// The bits of the first word are kept, those of the second one set where they are not.
int ModbusDesk::mask(const Request& request, ModbusTables& tables) {
    if (!request.has(7)) return illegal_value;
    const int address = request.word(1), kept = request.word(3), set = request.word(5);
    if (const int exception = read(ModbusTable::holding_registers, address, 1, tables))
        return exception;
    const int now = tables.tab_registers[address];
    const auto value = static_cast<std::uint16_t>((now & kept) | (set & ~kept));
    return write(ModbusTable::holding_registers, address, {&value, 1});
}

void ModbusDesk::converse(int socket, bool may_write, ModbusTables& tables) {
    constexpr std::uint32_t idle_s = 300;
    constexpr std::uint8_t first_exception = 0x80;  // no request, and its answer would be none
    modbus_t* const context = modbus_new_tcp("127.0.0.1", MODBUS_TCP_DEFAULT_PORT);
    modbus_set_socket(context, socket);
    modbus_set_indication_timeout(context, idle_s, 0);
    const auto header = static_cast<std::size_t>(modbus_get_header_length(context));
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> query;
    while (true) {
        const int size = modbus_receive(context, query.data());
        const bool is_modbus = size > static_cast<int>(header) && query[2] == 0 && query[3] == 0 &&
                               query[header] < first_exception;
        if (!is_modbus) break;
        const auto request = std::span(query).first(static_cast<std::size_t>(size)).subspan(header);
        const int exception = handle(request, may_write, tables);
        const int sent = exception == 0 ? modbus_reply(context, query.data(), size, &tables)
                                        : modbus_reply_exception(context, query.data(),
                                                                 static_cast<unsigned>(exception));
        if (sent < 0) break;
        if (exception == illegal_function) modbus_flush(context);
    }
    modbus_free(context);
}

ModbusServer::ModbusServer(ModbusDesk& desk, const Address& address) : desk_(desk) {
    modbus_t* const context =
        modbus_new_tcp_pi(address.host.c_str(), std::to_string(address.port).c_str());
    if (!context) return;
    listener_ = modbus_tcp_pi_listen(context, static_cast<int>(most_clients));
    modbus_free(context);
    if (!failed()) thread_ = std::thread([this] { work(); });
}

ModbusServer::~ModbusServer() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
    for (Client& client : clients_) ::shutdown(client.socket, SHUT_RDWR);
    for (Client& client : clients_) {
        client.thread.join();
        ::close(client.socket);
    }
    if (listener_ >= 0) ::close(listener_);
}

void ModbusServer::work() {
    constexpr int patience_ms = 100;
    while (!ends_) {
        pollfd waiting{.fd = listener_, .events = POLLIN, .revents = 0};
        if (::poll(&waiting, 1, patience_ms) > 0) admit();
        for (auto client = clients_.begin(); client != clients_.end();) {
            const auto gone = client++;
            if (!gone->gone) continue;
            gone->thread.join();
            ::close(gone->socket);
            clients_.erase(gone);
        }
    }
}

void ModbusServer::admit() {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    if (clients_.size() >= most_clients) {
        ::close(socket);
        return;
    }
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    Client& client = clients_.emplace_back(socket, Address{peer_of(socket)}.is_loopback());
    client.thread = std::thread([this, &client] { serve(client); });
}

void ModbusServer::serve(Client& client) {
    constexpr int addresses = 65536;
    ModbusTables* const tables = modbus_mapping_new(addresses, addresses, addresses, addresses);
    if (tables) desk_.converse(client.socket, client.is_near, *tables);
    modbus_mapping_free(tables);
    client.gone = true;
}

}  // namespace lineshaft
