#include "runtime/st/code.hpp"

#include <fmt/format.h>

namespace lineshaft::st {

namespace {

/// What is wrong with an operand; empty if nothing is.
std::string operand_error(const Code& code, const CodeRoutine& routine, char kind,
                          std::uint32_t x) {
    const auto beyond = [&](std::size_t end) { return x >= end; };
    switch (kind) {
        case 'w':
        case 'r':
        case 's':
            return beyond(routine.frame) ? "a slot outside of the frame" : "";
        case 'j':
            return x < routine.entry || x >= routine.end ? "a jump out of the routine" : "";
        case 'f':
            return beyond(code.routines.size()) ? "a routine that is not there" : "";
        case 'x':
            return beyond(code.tables.size()) ? "a table that is not there" : "";
        default:
            return "";
    }
}

std::string instruction_error(const Code& code, const CodeRoutine& routine, const Instruction& in) {
    const std::string_view kinds = info(in.op).operands;
    const std::uint32_t operands[] = {in.a, in.b, in.c};
    for (std::size_t i = 0; i < 3; ++i)
        if (std::string error = operand_error(code, routine, kinds[i], operands[i]); !error.empty())
            return error;
    const std::uint64_t last_to = std::uint64_t{in.a} + in.c,
                        last_from = std::uint64_t{in.b} + in.c;
    switch (in.op) {
        case Op::copy:
            return last_to > routine.frame || last_from > routine.frame ? "a copy beyond the frame"
                                                                        : "";
        case Op::copy_from:
            return last_to > routine.frame ? "a copy beyond the frame" : "";
        case Op::copy_to:
            return last_from > routine.frame ? "a copy beyond the frame" : "";
        case Op::initialise:
            return last_to > routine.frame || last_from > code.images.size()
                       ? "an image that is not there"
                       : "";
        case Op::call_block:
        case Op::call_block_at:
            return in.b >= code.standard.size() ? "a kind of block that is not there" : "";
        case Op::set_global:
            return in.b >= code.globals ? "a data block that is not there" : "";
        case Op::cover:
            return in.a >= code.points.size() ? "a point that is not there" : "";
        case Op::look_up: {
            const IndexTable& table = code.tables[in.c];
            const auto end = static_cast<std::uint64_t>(table.lower) + table.count;
            return end > code.numbers.size() ? "a list of numbers that is not there" : "";
        }
        default:
            return "";
    }
}

}  // namespace

std::string verify(const Code& code) {
    for (const CodeRoutine& routine : code.routines) {
        if (routine.end > code.instructions.size() || routine.entry >= routine.end)
            return fmt::format("routine {} is not there", routine.name);
        for (std::uint32_t i = routine.entry; i < routine.end; ++i) {
            const std::string error = instruction_error(code, routine, code.instructions[i]);
            if (!error.empty()) return fmt::format("instruction {} has {}", i, error);
        }
        const Op last = code.instructions[routine.end - 1].op;
        if (last != Op::leave) return fmt::format("routine {} does not end", routine.name);
    }
    return {};
}

std::string listing(const Code& code) {
    std::string out;
    for (const CodeRoutine& routine : code.routines) {
        out += fmt::format("{} ({} slots)\n", routine.name, routine.frame);
        for (std::uint32_t i = routine.entry; i < routine.end; ++i) {
            const Instruction& in = code.instructions[i];
            out += fmt::format("{:5}  {} {} {} {}\n", i, info(in.op).name, in.a, in.b, in.c);
        }
    }
    return out;
}

}  // namespace lineshaft::st
