#include "runtime/net/modbus_map.hpp"

#include <algorithm>

#include <fmt/format.h>

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

bool has_bits(ModbusTable table) {
    return table == ModbusTable::coils || table == ModbusTable::discrete_inputs;
}

bool may_be_written(ModbusTable table) {
    return table == ModbusTable::coils || table == ModbusTable::holding_registers;
}

std::string_view usual_type(Type type) {
    return type == Type::real ? "real32" : type == Type::integer ? "int32" : "uint16";
}

/// Empty: reported.
std::optional<double> scale_of(const Connecting& to, const RegisterPlan& plan,
                               const Signal& signal) {
    if (!plan.scale) return 1;
    const bool numeric = signal.type == Type::real || signal.type == Type::integer;
    const auto scale = numeric ? to.read.real(*plan.scale, to.net.unit(signal.unit)) : std::nullopt;
    if (scale && *scale != 0) return scale;
    if (!numeric || scale)
        to.read.fail("L0423", *plan.scale,
                     numeric ? "the scale is 0"
                             : fmt::format("'{}' is {} and has no scale", signal.name,
                                           kind(signal.type, signal.names)));
    return {};
}

void set_type(const Connecting& to, const RegisterPlan& plan, MappedSignal& mapped) {
    const Signal& signal = mapped.signal;
    if (has_bits(plan.table)) {
        if (signal.type != Type::boolean)
            to.read.fail("L0423", plan.signal,
                         fmt::format("'{}' is {}, and a bit is a boolean", signal.name,
                                     kind(signal.type, signal.names)),
                         "put it into holding_registers or input_registers");
        if (plan.type || plan.scale)
            to.read.fail("L0423", plan.type ? *plan.type : *plan.scale,
                         "a bit has no type and no scale");
        return;
    }
    const std::string_view name = plan.type ? plan.type->text : usual_type(signal.type);
    const auto type = std::ranges::find(types, name, &NamedType::name);
    mapped.type = type->type;
    mapped.count = type->registers;
    mapped.scale = scale_of(to, plan, signal).value_or(1);
}

/// Whether a client may write it, as far as the map says; reported if nobody can.
bool is_writable(const Connecting& to, const RegisterPlan& plan) {
    if (!plan.write || plan.write->text != "true") return false;
    if (!may_be_written(plan.table)) {
        to.read.fail("L0422", *plan.write, "clients cannot write this table",
                     "write coils or holding_registers, and leave 'write' out here");
        return false;
    }
    return find_settable(to, plan.signal).has_value();
}

void add(Connecting& to, const RegisterPlan& plan, std::vector<MappedSignal>& table) {
    const auto target = find_target(to, plan.signal);
    const auto address = to.read.integer(plan.address);
    if (!target || !address) return;
    MappedSignal mapped{.address = static_cast<int>(*address),
                        .little = plan.little,
                        .low_first = plan.low_first,
                        .is_writable = is_writable(to, plan),
                        .signal = target->signal};
    set_type(to, plan, mapped);
    constexpr int addresses = 65536;
    if (mapped.end() > addresses)
        return to.read.fail(
            "L0421", plan.address,
            fmt::format("{} registers from {} on end beyond 65535", mapped.count, mapped.address));
    const auto overlaps = [&](const MappedSignal& other) {
        return other.address < mapped.end() && mapped.address < other.end();
    };
    const auto other = std::ranges::find_if(table, overlaps);
    if (other != table.end())
        return to.read.fail("L0421", plan.address,
                            fmt::format("'{}' has the registers {} to {}, '{}' those from {} on",
                                        other->signal.name, other->address, other->end() - 1,
                                        mapped.signal.name, mapped.address),
                            fmt::format("the next that is free is {}", other->end()));
    table.push_back(std::move(mapped));
}

}  // namespace

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
        add(to, plan, map.tables[static_cast<std::size_t>(plan.table)]);
    for (auto& table : map.tables) std::ranges::sort(table, {}, &MappedSignal::address);
    return map;
}

}  // namespace lineshaft
