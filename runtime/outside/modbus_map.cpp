#include "runtime/outside/modbus_map.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/model/address.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using enum RegisterType;

struct NamedType {
    std::string_view name;
    RegisterType type;
    int registers;
};
constexpr NamedType types[] = {{"int16", int16, 1},   {"uint16", uint16, 1}, {"int32", int32, 2},
                               {"uint32", uint32, 2}, {"int64", int64, 4},   {"uint64", uint64, 4},
                               {"real32", real32, 2}, {"real64", real64, 4}};

bool may_be_written(ModbusTable table) {
    return table == ModbusTable::coils || table == ModbusTable::holding_registers;
}

/// The smallest that has an enumeration's numbers; one register where these are not negative,
/// without a sign.
std::string_view usual_type(const ValueNames& names) {
    Wide least = 0, most = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        least = std::min(least, names.whole(names.number(i)));
        most = std::max(most, names.whole(names.number(i)));
    }
    const auto has = [&]<class T>(T) {
        return least >= std::numeric_limits<T>::min() && most <= std::numeric_limits<T>::max();
    };
    if (has(std::uint16_t{})) return "uint16";
    if (has(std::int16_t{})) return "int16";
    if (has(std::uint32_t{})) return "uint32";
    if (has(std::int32_t{})) return "int32";
    return names.has_sign() ? "int64" : "uint64";
}

std::string_view usual_type(const Signal& signal) {
    if (signal.type == Type::enumeration) return usual_type(signal.names);
    return signal.type == Type::real ? "real32" : is_integer(signal.type) ? "int32" : "uint16";
}

/// An address of the process image has a type of its size.
std::string_view usual_type(const Target& target) {
    const auto address = read_address(target.signal.name, AddressCount::words);
    if (!address || !is_integer(target.signal.type)) return usual_type(target.signal);
    const bool has_sign = target.field.minimum < 0;
    if (address->bits == 64) return has_sign ? "int64" : "uint64";
    if (address->bits == 32) return has_sign ? "int32" : "uint32";
    return has_sign ? "int16" : "uint16";
}

/// Empty: reported.
std::optional<double> scale_of(const Connecting& to, const RegisterPlan& plan,
                               const Signal& signal) {
    if (!plan.scale) return 1;
    const bool numeric = signal.type == Type::real || is_integer(signal.type);
    const auto scale = numeric ? to.read.real(*plan.scale, to.net.unit(signal.unit)) : std::nullopt;
    if (scale && *scale != 0) return scale;
    if (!numeric || scale)
        to.read.fail(code::register_does_not_fit, *plan.scale,
                     numeric ? "the scale is 0"
                             : fmt::format("'{}' is {} and has no scale", signal.name,
                                           kind(signal.type, signal.names)));
    return {};
}

std::int64_t whole_or_zero(double number) {
    constexpr double most = 1e15;  // such numbers and their neighbours are told apart
    return number == std::trunc(number) && std::abs(number) <= most
               ? static_cast<std::int64_t>(number)
               : 0;
}

void set_type(const Connecting& to, const RegisterPlan& plan, const Target& target,
              MappedSignal& mapped) {
    const Signal& signal = mapped.signal;
    if (has_bits(plan.table)) {
        if (signal.type != Type::boolean)
            to.read.fail(code::register_does_not_fit, plan.signal,
                         fmt::format("'{}' is {}, and a bit is a boolean", signal.name,
                                     kind(signal.type, signal.names)),
                         "put it into holding_registers or input_registers");
        if (plan.type || plan.scale)
            to.read.fail(code::register_does_not_fit, plan.type ? *plan.type : *plan.scale,
                         "a bit has no type and no scale");
        return;
    }
    const std::string_view name = plan.type ? plan.type->text : usual_type(target);
    const auto type = std::ranges::find(types, name, &NamedType::name);
    mapped.type = type->type;
    mapped.count = type->registers;
    set_scale(mapped, scale_of(to, plan, signal).value_or(1));
    constexpr int of_64_bits = 4;
    if (is_integer(signal.type) && mapped.count == of_64_bits && mapped.divisor == 0)
        to.read.fail(code::register_does_not_fit, *plan.scale,
                     fmt::format("whole numbers of 64 bits would lose digits by the scale {}",
                                 plan.scale->text),
                     "take a whole number or one over a whole number, such as 0.001, or another "
                     "type");
}

/// What a client writes, as far as the map says that it may; reported if nobody can.
std::optional<Target> find_written(const Connecting& to, const RegisterPlan& plan) {
    if (!plan.write || plan.write->text != "true") return {};
    if (!may_be_written(plan.table)) {
        to.read.fail(code::table_is_not_written, *plan.write, "clients cannot write this table",
                     "write coils or holding_registers, and leave 'write' out here");
        return {};
    }
    return find_settable(to, plan.signal);
}

/// Returns the address behind it; 0: reported.
int add(Connecting& to, const RegisterPlan& plan, std::vector<MappedSignal>& table) {
    const auto target = find_target(to, plan.signal);
    const auto address = to.read.integer(plan.address);
    if (!target || !address) return 0;
    const auto written = find_written(to, plan);
    MappedSignal mapped{.address = static_cast<int>(*address),
                        .little = plan.little,
                        .low_first = plan.low_first,
                        .is_writable = written.has_value(),
                        .signal = target->signal};
    if (!target->is_of_block() || (written && written->live == target->live))
        mapped.set_to = target->live;
    set_type(to, plan, *target, mapped);
    constexpr int addresses = 65536;
    if (mapped.end() > addresses)
        return to.read.fail(code::registers_overlap, plan.address,
                            fmt::format("{} registers from {} on end beyond 65535", mapped.count,
                                        mapped.address)),
               0;
    const auto overlaps = [&](const MappedSignal& other) {
        return other.address < mapped.end() && mapped.address < other.end();
    };
    const auto other = std::ranges::find_if(table, overlaps);
    if (other != table.end())
        return to.read.fail(code::registers_overlap, plan.address,
                            fmt::format("'{}' has the registers {} to {}, '{}' those from {} on",
                                        other->signal.name, other->address, other->end() - 1,
                                        mapped.signal.name, mapped.address),
                            fmt::format("the next that is free is {}", other->end())),
               0;
    const int end = mapped.end();
    table.push_back(std::move(mapped));
    return end;
}

/// `%MW0..%MW99`: one behind the other.
void add_range(Connecting& to, RegisterPlan plan, std::vector<MappedSignal>& table) {
    const auto addresses = addresses_of_range(plan.signal.text, to.net.count_of_addresses());
    if (addresses.size() < 2) return void(add(to, plan, table));
    for (const ImageAddress& address : addresses) {
        plan.signal.text = text_of(address, to.net.count_of_addresses());
        const int next = add(to, plan, table);
        if (next == 0) return;
        plan.address.text = std::to_string(next);
    }
}

}  // namespace

void set_scale(MappedSignal& mapped, double scale) {
    mapped.scale = scale;
    mapped.multiplier = whole_or_zero(scale);
    mapped.divisor = mapped.multiplier != 0 ? 1 : 0;
    if (mapped.divisor != 0) return;
    const double inverse = std::round(1 / scale);
    if (1 / inverse != scale) return;
    mapped.divisor = whole_or_zero(inverse);
    mapped.multiplier = mapped.divisor != 0 ? 1 : 0;
}

std::span<const MappedSignal> ModbusMap::find(ModbusTable table, int address, int count) const {
    const auto& all = tables[static_cast<std::size_t>(table)];
    const auto first = std::ranges::upper_bound(all, address, {}, &MappedSignal::end);
    auto last = first;
    for (int next = address; next < address + count; ++last) {
        if (last == all.end() || last->address > next) return {};
        next = last->end();
    }
    return {first, last};
}

bool ModbusMap::empty() const {
    return std::ranges::all_of(tables, [](const auto& table) { return table.empty(); });
}

ModbusMap connect_modbus(Connecting& to) {
    ModbusMap map;
    for (const RegisterPlan& plan : to.program.registers)
        add_range(to, plan, map.tables[static_cast<std::size_t>(plan.table)]);
    for (auto& table : map.tables) std::ranges::sort(table, {}, &MappedSignal::address);
    return map;
}

}  // namespace lineshaft
