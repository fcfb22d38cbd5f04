#include "runtime/st/code/code.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

namespace lineshaft::st {

namespace {

bool is_jump(const Code& code, const CodeRoutine& routine, std::uint64_t address) {
    const std::uint64_t to = code.place_of(address);
    return to >= routine.entry && to < routine.end;
}

/// What is wrong with an operand; empty if nothing is.
std::string operand_error(const Code& code, const CodeRoutine& routine, char kind,
                          std::uint64_t x) {
    const auto beyond = [&](std::size_t end) { return x >= end; };
    switch (kind) {
        case 'w':
        case 'r':
        case 's':
            return beyond(routine.frame) ? "a slot outside of the frame" : "";
        case 'd':
            return x + 1 >= routine.frame ? "one slot of two" : "";
        case 't':
            return x + 2 >= routine.frame ? "a reference that is not whole" : "";
        case 'j':
            return is_jump(code, routine, x) ? "" : "a jump out of the routine";
        case 'f':
            return beyond(code.routines.size()) ? "a routine that is not there" : "";
        case 'x':
            return beyond(code.tables.size()) ? "a table that is not there" : "";
        default:
            return "";
    }
}

/// Those of its table; empty if they are not there.
std::span<const std::int64_t> numbers_of(const Code& code, const Instruction& in) {
    const auto& [lower, count, stride, first] = code.tables[in.c];
    if (first > code.numbers.size() || count > code.numbers.size() - first) return {};
    return std::span(code.numbers).subspan(first, count);
}

bool jumps_out(const Code& code, const CodeRoutine& routine, const Instruction& in) {
    const auto targets = numbers_of(code, in);
    return targets.empty() || std::ranges::any_of(targets, [&](std::int64_t x) {
               return !is_jump(code, routine, static_cast<std::uint64_t>(x));
           });
}

std::string instruction_error(const Code& code, const CodeRoutine& routine, const Instruction& in) {
    constexpr const char* beyond = "a copy beyond the frame";
    const std::string_view kinds = info(in.op).operands;
    const std::uint64_t operands[] = {in.a, in.b, in.c, in.d};
    for (std::size_t i = 0; i < 4; ++i)
        if (std::string error = operand_error(code, routine, kinds[i], operands[i]); !error.empty())
            return error;
    const std::uint64_t last_to = std::uint64_t{in.a} + in.c,
                        last_from = std::uint64_t{in.b} + in.c;
    switch (in.op) {
        case Op::copy:
            return last_to > routine.frame || last_from > routine.frame ? beyond : "";
        case Op::copy_from:
            return last_to > routine.frame ? beyond : "";
        case Op::copy_to:
            return last_from > routine.frame ? beyond : "";
        case Op::initialise:
            return last_to > routine.frame || last_from > code.images.size()
                       ? "an image that is not there"
                       : "";
        case Op::call_block:
        case Op::call_block_at:
            return in.b >= code.standard.size() ? "a kind of block that is not there" : "";
        case Op::set_global:
        case Op::set_global_number:
            return in.b >= code.globals ? "a data block that is not there" : "";
        case Op::attempt:
            return in.c >= code.methods ? "a kind that is not there" : "";
        case Op::find_routine:
            return in.c >= code.methods        ? "a method that is not there"
                   : in.a + 1 >= routine.frame ? "one slot of two"
                                               : "";
        case Op::cover:
            return in.a >= code.points.size() ? "a point that is not there" : "";
        case Op::bytes_of_slots:
        case Op::reach:
            return in.c >= code.shapes.size() ? "a shape that is not there" : "";
        case Op::load_through:
        case Op::store_through:
        case Op::load_text_through:
        case Op::store_text_through:
        case Op::copy_from_through:
        case Op::copy_to_through:
            return in.c >> 32 >= code.shapes.size() ? "a shape that is not there" : "";
        case Op::look_up:
            return numbers_of(code, in).empty() ? "a list of numbers that is not there" : "";
        case Op::choose:
            return jumps_out(code, routine, in) ? "a jump out of the routine" : "";
        case Op::load_element:
        case Op::store_element: {
            const IndexTable& table = code.tables[in.d];
            const std::uint64_t last = in.b + (table.count - 1) * table.stride;
            return table.count > routine.frame || last >= routine.frame
                       ? "an array beyond the frame"
                       : "";
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
        for (const Handler& handler : code.handlers)
            if (handler.first >= routine.entry && handler.first < routine.end &&
                (handler.end > routine.end || handler.entry < handler.first ||
                 handler.entry >= routine.end))
                return fmt::format("routine {} has no such __CATCH", routine.name);
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
            const bool jumps = info(in.op).operands[2] == 'j';
            const std::uint64_t c = jumps ? code.place_of(in.c) : in.c;
            out += fmt::format("{:5}  {} {} {} {} {}\n", i, info(in.op).name, in.a, in.b, c, in.d);
        }
    }
    return out;
}

}  // namespace lineshaft::st
