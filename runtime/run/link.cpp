#include "runtime/run/link.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "runtime/machine/lay_out.hpp"
#include "runtime/names/resolve.hpp"
#include "runtime/outside/outside.hpp"
#include "runtime/scan/expectations.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/used_sources.hpp"
#include "runtime/trace/report_setup.hpp"
#include "runtime/trace/trace_setup.hpp"

namespace lineshaft {

namespace {

/// `"%QW4"` anywhere in a program's file: nothing else there begins with '%'.
void find_addresses(const Node& node, std::vector<std::string>& found) {
    const bool is_new = std::ranges::find(found, node.text) == found.end();
    if (node.text.starts_with('%') && is_new) found.push_back(node.text);
    for (const Node& item : node.items) find_addresses(item, found);
    for (const auto& [key, value] : node.entries) {
        find_addresses(key, found);
        find_addresses(value, found);
    }
}

st::Options options_of(const Program& program) {
    st::Options options{.times = program.instruction_times,
                        .overflow_faults = program.overflow_faults};
    find_addresses(program.root, options.addresses);
    return options;
}

/// That its blocks have.
std::vector<std::string> types_of(const Program& program) {
    std::vector<std::string> types;
    for (const BlockPlan& block : program.blocks) types.push_back(block.type.text);
    return types;
}

/// Programs of a CONFIGURATION that are no blocks of the program, which has its own tasks.
void warn_of_left_programs(const Program& program, const st::Library& library, Diagnostics& out) {
    std::vector<std::string> types = types_of(program);
    for (const auto& [type, mark] : library.configured_programs()) {
        const auto block = std::ranges::find_if(
            types, [&, &type = type](const std::string& name) { return same_letters(name, type); });
        if (block == types.end())
            out.warn(code::not_supported, mark,
                     fmt::format("no block runs this program of the CONFIGURATION, a '{}'", type),
                     fmt::format("add name: {{type: {}, task: ...}}; 'lineshaft new --from' writes "
                                 "a program with all of them",
                                 type));
        else
            types.erase(block);
    }
}

/// What the program's Structured Text brings along; null if there is a mistake in it.
std::shared_ptr<const Catalog> kinds_of(const Program& program, const Catalog& catalog,
                                        Diagnostics& out) {
    if (!program.sources_known) return {};
    auto kinds = std::make_shared<Catalog>();
    if (program.texts.empty()) return kinds;
    Diagnostics found;
    const auto library =
        st::compile_used(program.texts, types_of(program), catalog, found, options_of(program));
    for (const Diagnostic& d : found.warnings()) out.warn(d.code, d.mark, d.message, d.help);
    for (const Diagnostic& d : found.list()) out.add(d.code, d.mark, d.message, d.help);
    if (!library) return {};
    warn_of_left_programs(program, *library, out);
    for (const BlockType& kind : library->kinds()) kinds->add(kind);
    return kinds;
}

/// Where a value stands that something in the program takes.
std::set<const std::byte*> places_read(Linked& linked) {
    std::set<const std::byte*> places;
    Machine& machine = linked.machine;
    for (const Wire& wire : linked.net.wires) places.insert(machine.published(wire.from));
    for (const OutputNode& output : linked.net.outputs)
        if (output.shows) places.insert(machine.published(output.shows->port));
    for (const Trigger& trigger : machine.triggers)
        places.insert(reinterpret_cast<const std::byte*>(trigger.signal));
    if (machine.until) places.insert(machine.until->slot);
    for (const TraceSetup& trace : linked.traces) {
        places.insert(trace.trigger.signal.slot);
        for (const Signal& signal : trace.signals) places.insert(signal.slot);
    }
    for (const Expectation& expectation : linked.expectations) {
        places.insert(expectation.signal.slot);
        if (expectation.cause) places.insert(expectation.cause->slot);
    }
    return places;
}

void warn_of_unused_inputs(const Program& program, Linked& linked, Diagnostics& out) {
    const auto read = places_read(linked);
    for (std::size_t i = 0; i < program.inputs.size(); ++i) {
        const Node& name = program.inputs[i].first;
        if (!read.contains(linked.machine.live({-1, static_cast<int>(i)})))
            out.warn(code::never_read, name.mark,
                     fmt::format("nothing uses the input '{}'", name.text),
                     fmt::format("wire inputs.{} where it is meant, or remove it", name.text));
    }
}

}  // namespace

std::shared_ptr<const Catalog> CompiledSources::kinds(const Program& program,
                                                      const Catalog& catalog) {
    const st::Options options = options_of(program);
    const std::vector<std::string> types = types_of(program);
    for (const Entry& entry : entries_)
        if (entry.texts == program.texts && entry.types == types && entry.options == options)
            return entry.kinds;
    Diagnostics untold;
    const auto kinds = kinds_of(program, catalog, untold);
    if (kinds) entries_.push_back({program.texts, types, options, kinds});
    return kinds;
}

Linked link(const Program& program, const Catalog& catalog, Diagnostics& out,
            std::shared_ptr<const Catalog> kinds) {
    Linked linked;
    if (!kinds) kinds = kinds_of(program, catalog, out);
    linked.net = resolve(program, catalog, std::move(kinds), out);
    linked.machine = lay_out(linked.net);
    Connecting to{program, linked.net, linked.machine, Reader(out)};
    connect_outside(to);
    linked.traces = connect_traces(to);
    linked.report = connect_report(to, linked.traces);
    linked.expectations = connect_expectations(to);
    linked.modbus = connect_modbus(to);
    warn_of_unused_inputs(program, linked, out);
    return linked;
}

}  // namespace lineshaft
