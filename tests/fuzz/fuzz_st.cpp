/// Any bytes as Structured Text: compiled and scanned, or refused with messages that have places.

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "blocks/catalog.hpp"
#include "runtime/st/check/check.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/st/syntax/parser.hpp"

using namespace lineshaft;

namespace {

constexpr std::uint64_t most_slots = 20'000;

std::uint64_t slots_of(const st::Type& type);

std::uint64_t slots_of(const st::Routine& routine) {
    std::uint64_t sum = 300;
    for (const st::Variable& variable : routine.variables)
        if (variable.type && variable.space != st::Space::reference)
            sum += slots_of(*variable.type);
    for (const auto& [name, method] : routine.methods) sum += slots_of(*method);
    return sum;
}

/// About what memory a value takes; 2^32 for all that is more.
std::uint64_t slots_of(const st::Type& type) {
    std::uint64_t slots = 1 + type.length / 8 + type.slots;
    if (type.kind == st::Type::Kind::array) {
        const auto count = static_cast<std::uint64_t>(type.upper - type.lower) + 1;
        slots = count * slots_of(*type.element);
    }
    if (type.kind == st::Type::Kind::structure)
        for (const st::Variable* member : type.members) slots += slots_of(*member->type);
    if (type.kind == st::Type::Kind::block) slots += slots_of(*type.routine);
    return std::min<std::uint64_t>(slots, std::uint64_t{1} << 32);
}

bool is_small(const st::Checked& checked) {
    std::uint64_t sum = 0;
    for (const st::Routine& routine : checked.routines) sum += slots_of(routine);
    for (const st::Global& global : checked.globals) sum += slots_of(*global.type);
    return sum < most_slots;
}

void look(const Diagnostics& out) {
    const std::string messages = out.render();
    for (const Diagnostic& d : out.list()) {
        if (d.mark.file && d.mark.line > 0 && d.mark.column > 0 && !d.message.empty()) continue;
        std::fprintf(stderr, "no place:\n%s", messages.c_str());
        std::abort();
    }
}

void scan(const st::Library& library) {
    std::vector<std::vector<std::uint64_t>> memory;
    std::vector<std::byte*> places;
    for (const BlockType& kind : library.kinds()) {
        memory.emplace_back(kind.size / 8);
        places.push_back(reinterpret_cast<std::byte*>(memory.back().data()));
        kind.construct(places.back());
    }
    for (std::size_t i = 0; i < places.size(); ++i)
        for (const Field& field : library.kinds()[i].fields)
            for (std::size_t k = 0; k < places.size(); ++k)
                if (field.direction == Direction::in_out && library.kinds()[k].name == field.refers)
                    store(Type::integer, places[i] + field.offset, static_cast<std::int64_t>(k));
    for (std::int64_t time = 0; time < 3; ++time)
        for (std::size_t i = 0; i < places.size(); ++i) {
            const BlockType& kind = library.kinds()[i];
            kind.scan_blocks(places[i], 1, {time, 1, time}, {kind.context, places.data()});
            if (kind.why && library.fault(kind, places[i]).fault != st::Fault::none)
                kind.why(places[i], {.kind = kind.context}, {});
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Catalog catalog = standard_blocks();
    const std::string text(reinterpret_cast<const char*>(data), size);
    constexpr const char* names[] = {"fuzz.st", "fuzz.EXP", "fuzz.scl"};  // each a dialect
    const auto file = std::make_shared<const SourceFile>(SourceFile{names[size % 3], text});
    Diagnostics out;
    st::Tree tree;
    st::parse(st::read_tokens(file, out), tree, out);
    if (out.empty()) {
        const st::Checked checked = st::check(tree, catalog, st::evaluate, out);
        if (out.empty() && !is_small(checked)) return 0;
    }
    look(out);
    if (!out.empty()) return 0;
    Diagnostics again;
    const auto library = st::compile({file}, catalog, again, {.fuel = 1000});
    look(again);
    if (library.has_value() != again.empty()) std::abort();
    if (library) scan(*library);
    return 0;
}
