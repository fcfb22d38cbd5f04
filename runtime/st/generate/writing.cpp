#include "runtime/st/generate/writing.hpp"

#include <algorithm>
#include <bit>

namespace lineshaft::st {

void Writing::link() {
    const auto address = [&](std::uint64_t number) {
        return reinterpret_cast<std::uint64_t>(&code.instructions[number]);
    };
    for (Instruction& in : code.instructions) {
        if (info(in.op).operands[2] == 'j') in.c = address(in.c);
        if (in.op != Op::choose) continue;
        const IndexTable& table = code.tables[in.c];
        for (std::uint64_t k = table.first; k < table.first + table.count; ++k)
            code.numbers[k] =
                static_cast<std::int64_t>(address(static_cast<std::uint64_t>(code.numbers[k])));
    }
}

void Writing::put(Op op, Slot a, Slot b, Slot c, Slot d) {
    put({op, a, b, d, c});
}

void Writing::put(Instruction instruction) {
    note_use(instruction);
    code.instructions.push_back(instruction);
    code.places.push_back(place);
    if (fuses && next() - 1 > landed) fuse();
}

void Writing::leave() {
    if (routine->mark != 0) put(Op::move, routine->mark, constant_slot(0));
    put(Op::leave);
}

void Writing::jump(Op op, Slot a, Slot b, Jumps& to) {
    put(op, a, b, 0);
    to.push_back(next() - 1);
}

void Writing::land() {
    landed = next();
}

void Writing::land(Jumps& jumps) {
    if (jumps.empty()) return;
    for (const std::uint32_t at : jumps) code.instructions[at].c = next();
    jumps.clear();
    land();
}

Slot Writing::new_temporary(std::uint32_t slots) {
    const Slot slot = Region::temporary + temporaries;
    temporaries += slots;
    most_temporaries = std::max(most_temporaries, temporaries);
    for (Slot used = slot; used < slot + slots && !unwritten.empty(); ++used) unwritten.erase(used);
    return slot;
}

Slot Writing::constant_slot(std::uint64_t bits) {
    const auto [it, added] =
        constant_slots.emplace(bits, Region::constant + static_cast<Slot>(constants.size()));
    if (added) constants.push_back(bits);
    return it->second;
}

Slot Writing::constant_slot(const Type& type, const Constant& value) {
    if (type.is_real()) return constant_slot(std::bit_cast<std::uint64_t>(value.real));
    return constant_slot(static_cast<std::uint64_t>(value.integer));
}

std::uint32_t Writing::table(IndexTable made) {
    const auto [it, added] = tables.emplace(made, static_cast<std::uint32_t>(code.tables.size()));
    if (added) code.tables.push_back(made);
    return it->second;
}

Slot Writing::emit(Op op, Slot wanted, Slot b, Slot c) {
    const Slot to = result(wanted);
    put(op, to, b, c);
    return to;
}

std::uint32_t Writing::standard_number(const BlockType& kind) {
    const auto [it, added] =
        standard_numbers.emplace(&kind, static_cast<std::uint32_t>(code.standard.size()));
    if (added) code.standard.push_back(&kind);
    return it->second;
}

void Writing::begin_statement(Place at) {
    if (at.source && at.source->is_users()) {
        // A statement without an instruction of its own is none that can be stopped at.
        if (!code.statements.empty() && code.statements.back().instruction == next())
            code.statements.back().place = at;
        else
            code.statements.push_back({next(), false, at});
    }
    cover(CoverPoint::Kind::statement, at);
}

void Writing::join_statement() {
    if (code.statements.empty() || code.statements.back().instruction != next() - 1) return;
    code.statements.back().instruction = next() - 2;
    code.statements.back().is_inner = true;
}

void Writing::cover(CoverPoint::Kind kind, Place at, std::size_t branch) {
    if (!options.covered || at.source->kind != SourceKind::program) return;
    const bool is_function = kind == CoverPoint::Kind::function;
    put(Op::cover, static_cast<Slot>(code.points.size()));
    code.points.push_back({kind, at, static_cast<std::uint32_t>(branch),
                           is_function ? routine->name : std::string()});
}

}  // namespace lineshaft::st
