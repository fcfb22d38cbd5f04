#include "runtime/machine/machine.hpp"

#include <algorithm>

namespace lineshaft {

const Signal* Machine::find(std::string_view name) const {
    const auto it = std::ranges::find(signals, name, &Signal::name);
    return it == signals.end() ? nullptr : &*it;
}

void Machine::impose(Force force) {
    for (Force& other : forces)
        if (other.live == force.live) other.until = std::min(other.until, force.from);
    forces.push_back(std::move(force));
}

void Machine::lift_force(const std::byte* place, std::int64_t at) {
    for (Force& force : forces)
        if (force.live == place && force.from <= at) force.until = std::min(force.until, at);
}

std::byte* Machine::live(Port port) {
    const auto field = static_cast<std::size_t>(port.field);
    if (port.instance < 0) return memory.data() + 8 * field;
    const BlockPlace& block = blocks[static_cast<std::size_t>(port.instance)];
    return block.live + block.type->fields[field].offset;
}

std::byte* Machine::published(Port port) {
    const auto field = static_cast<std::size_t>(port.field);
    if (port.instance < 0) return live(port);
    const BlockPlace& block = blocks[static_cast<std::size_t>(port.instance)];
    return block.published + block.type->fields[field].offset;
}

Signal Machine::placed(Signal signal) {
    signal.slot = published(signal.port);
    return signal;
}

Context Machine::context_of(const BlockType& type, int task) {
    return {.kind = type.context,
            .instances = instances.data(),
            .seen = seen[static_cast<std::size_t>(task)].data(),
            .types = types.data(),
            .memory = memory.data(),
            .task = task,
            .blocks = static_cast<int>(types.size())};
}

}  // namespace lineshaft
