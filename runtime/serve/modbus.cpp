#include "runtime/serve/modbus.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/serve/modbus_request.hpp"
#include "runtime/serve/registers.hpp"
#include "runtime/source/text_hash.hpp"

namespace lineshaft {

namespace {

using enum ModbusException;

/// The number of bytes, and the bits from the lowest on, or the registers.
std::string packed(std::span<const std::uint16_t> words, bool are_bits) {
    std::string bytes(1, '\0');
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!are_bits)
            bytes += {static_cast<char>(words[i] >> 8), static_cast<char>(words[i] & 0xFF)};
        else if (i % 8 == 0)
            bytes += static_cast<char>(words[i]);
        else
            bytes.back() = static_cast<char>(bytes.back() | words[i] << i % 8);
    }
    bytes[0] = static_cast<char>(bytes.size() - 1);
    return bytes;
}

}  // namespace

std::string ModbusDesk::answer(std::string_view bytes, const ModbusPeer& peer) {
    constexpr int failed = 0x80;
    ModbusRequest request;
    ModbusException exception = parse(bytes, request);
    std::string data(bytes.substr(1, request.function == mask_write_register ? 6 : 4));
    std::int64_t at = never;
    const bool is_write = writes(request.function);
    if (is_write && !(allow_write_ && peer.may_write)) exception = illegal_function;
    if (exception == none) exception = carry_out(request, data, at);
    if (audit_ && is_write)
        audit_->note(
            {peer.address, "Modbus", hexadecimal(std::as_bytes(std::span(bytes))),
             exception == none ? "done" : fmt::format("exception {}", static_cast<int>(exception)),
             at});
    if (exception == none) return std::string(bytes.substr(0, 1)) + data;
    return {static_cast<char>(request.function | failed), static_cast<char>(exception)};
}

ModbusException ModbusDesk::carry_out(const ModbusRequest& request, std::string& data,
                                      std::int64_t& at) {
    Signals read, written;
    std::vector<Change> changes;
    if (request.read)
        if (const auto exception = find_read(request, read); exception != none) return exception;
    if (request.written) {
        if (const auto exception = find_written(*request.written, written); exception != none)
            return exception;
        if (request.function == mask_write_register) return mask(request, written, at);
        if (const auto exception = this->changes(written, request.values, changes);
            exception != none)
            return exception;
    }
    if (!changes.empty() && !live_.recording_error().empty()) return device_failure;
    const auto found = live_.mailbox().ask([&] {
        const Applied applied = changes.empty() ? Applied{} : live_.apply(changes);
        return std::pair(applied,
                         request.read ? words(read, *request.read) : std::vector<std::uint16_t>());
    });
    if (!found) return busy;
    if (!changes.empty())
        if (const auto exception = keep(found->first, at); exception != none) return exception;
    if (request.read) data = packed(found->second, has_bits(request.read->table));
    return none;
}

ModbusException ModbusDesk::find_read(const ModbusRequest& request, Signals& found) const {
    found = map_.find(request.read->table, request.read->address, request.read->count);
    return found.empty() ? illegal_address : none;
}

ModbusException ModbusDesk::find_written(const ModbusArea& area, Signals& found) const {
    found = map_.find(area.table, area.address, area.count);
    const bool are_whole = !found.empty() && found.front().address == area.address &&
                           found.back().end() == area.address + area.count;
    return are_whole && std::ranges::all_of(found, &MappedSignal::is_writable) ? none
                                                                               : illegal_address;
}

ModbusException ModbusDesk::changes(Signals signals, std::span<const std::uint16_t> words,
                                    std::vector<Change>& changes) {
    std::vector<Wanted> wanted;
    for (const MappedSignal& mapped : signals) {
        const auto first = static_cast<std::size_t>(mapped.address - signals.front().address);
        const auto value = from_registers(mapped, words.subspan(first));
        if (!value) return illegal_value;
        wanted.push_back({mapped.signal.name, mapped.signal.describe(*value)});
    }
    Diagnostics out;
    changes = desk_.changes(Change::Kind::set, wanted, out);
    return out.empty() ? none : illegal_value;
}

/// The bits of the first mask are kept, those of the second one set where they are not. Made of
/// what stands there, and written if that still stands there: else made anew, as often as others
/// are quicker.
ModbusException ModbusDesk::mask(const ModbusRequest& request, Signals signals, std::int64_t& at) {
    constexpr int most_rounds = 100;
    const ModbusArea& area = *request.written;
    for (int round = 0; round < most_rounds; ++round) {
        if (!live_.recording_error().empty()) return device_failure;
        const auto before = live_.mailbox().ask([&] { return words(signals, area); });
        if (!before) return busy;
        const std::uint16_t now = before->front(), kept = request.and_mask,
                            after = static_cast<std::uint16_t>((now & kept) |
                                                               (request.or_mask & ~kept));
        std::vector<Change> changes;
        if (const auto exception = this->changes(signals, {&after, 1}, changes); exception != none)
            return exception;
        const auto applied = live_.mailbox().ask([&]() -> std::optional<Applied> {
            if (words(signals, area) != *before) return std::nullopt;
            return live_.apply(changes);
        });
        if (!applied) return busy;
        if (*applied) return keep(**applied, at);
    }
    return busy;
}

ModbusException ModbusDesk::keep(const Applied& applied, std::int64_t& at) {
    at = applied.at;
    return live_.keep(applied).empty() ? none : device_failure;
}

/// In the machine's thread: what was written last is there, though the machine may stand still.
Value ModbusDesk::value(const MappedSignal& mapped) const {
    const auto posted = mapped.set_to ? live_.posted(mapped.set_to) : std::nullopt;
    return posted ? *posted : mapped.signal.value();
}

std::vector<std::uint16_t> ModbusDesk::words(Signals signals, const ModbusArea& area) const {
    std::vector<std::uint16_t> all;
    for (const MappedSignal& mapped : signals) {
        const Value now = value(mapped);
        const std::size_t size = all.size();
        all.resize(size + static_cast<std::size_t>(mapped.count));
        if (has_bits(area.table))
            all.back() = std::get<bool>(now);
        else
            to_registers(mapped, now, std::span(all).subspan(size));
    }
    const auto first = all.begin() + (area.address - signals.front().address);
    return {first, first + area.count};
}

}  // namespace lineshaft
