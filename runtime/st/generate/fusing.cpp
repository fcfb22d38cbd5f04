#include <stdexcept>

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

namespace {

/// `leave` if they have no fused form.
Op pair_of(Op first, Op second, bool is_right) {
    struct Family {
        Op add, pairs;
    };
    static constexpr Family families[] = {{Op::add_lreal, Op::add_add_lreal},
                                          {Op::add_real, Op::add_add_real},
                                          {Op::add_int, Op::add_add_int},
                                          {Op::add_dint, Op::add_add_dint},
                                          {Op::add_lint, Op::add_add_lint}};
    for (const auto& [add, pairs] : families) {
        const auto of_first = static_cast<unsigned>(first) - static_cast<unsigned>(add);
        const auto of_second = static_cast<unsigned>(second) - static_cast<unsigned>(add);
        if (of_first > 2 || of_second > 2) continue;
        const bool from = is_right && of_second == 1;
        return after(pairs, static_cast<int>(4 * of_first + (from ? 3 : of_second)));
    }
    return Op::leave;
}

/// `leave` if this is not `i := i + step` before the test of a WHILE.
Op count_of(const Instruction& first, const Instruction& second) {
    if (first.a != first.b || second.a != first.a || second.b == first.a) return Op::leave;
    if (second.op != Op::repeat_if_lt_signed && second.op != Op::repeat_if_le_signed)
        return Op::leave;
    const int by = second.op == Op::repeat_if_le_signed ? 1 : 0;
    if (first.op == Op::add_int) return after(Op::count_lt_int, by);
    if (first.op == Op::add_dint) return after(Op::count_lt_dint, by);
    return first.op == Op::add_lint ? after(Op::count_lt_lint, by) : Op::leave;
}

}  // namespace

void Writing::thread(std::uint32_t i) {
    Instruction& in = code.instructions[i];
    if (info(in.op).operands[2] != 'j') return;
    while (in.c > i && code.instructions[in.c].op == Op::jump) in.c = code.instructions[in.c].c;
}

void Writing::note_use(const Instruction& in) {
    const std::string_view operands = info(in.op).operands;
    const Slot slots[] = {in.a, in.b, static_cast<Slot>(in.c), in.d};
    for (std::size_t i = 0; i < operands.size(); ++i)
        if (operands[i] == 'r' && unwritten.contains(slots[i]))
            throw std::logic_error("a fused instruction's temporary is read again");
    for (std::size_t i = 0; i < operands.size(); ++i)
        if (operands[i] == 'w') unwritten.erase(slots[i]);
}

void Writing::fuse() {
    Instruction &first = code.instructions[next() - 2], &second = code.instructions.back();
    const auto replace = [&](Instruction by) {
        join_statement();
        first = by;
        code.instructions.pop_back();
        code.places.pop_back();
    };
    if (first.op == Op::move && second.op == Op::jump)
        return replace({Op::move_and_jump, first.a, first.b, 0, second.c});
    if (first.op == Op::move && second.op == Op::move)
        return replace({Op::move_twice, first.a, first.b, second.b, second.a});
    if (const Op op = count_of(first, second); op != Op::leave)
        return replace({op, first.a, Slot(first.c), second.b, second.c});
    if ((first.a & region_mask) != Region::temporary) return;
    const auto join = [&](Instruction by) {
        if (second.a != first.a) unwritten.insert(first.a);
        replace(by);
    };
    if (first.op == Op::index && second.c == first.a) {
        if (second.op == Op::load_at)
            join({Op::load_element, second.a, second.b, Slot(first.c), first.b});
        else if (second.op == Op::store_at && second.a != first.a)
            join({Op::store_element, second.a, second.b, Slot(first.c), first.b});
        return;
    }
    if ((second.b == first.a) == (second.c == first.a)) return;
    const Op op = pair_of(first.op, second.op, second.c == first.a);
    if (op != Op::leave)
        join({op, second.a, first.b, second.b == first.a ? Slot(second.c) : second.b, first.c});
}

void Writing::fuse_guarded_move(Jumps& skip) {
    const std::uint32_t at = next() - 2;
    if (!fuses || skip.empty() || skip.back() != at || landed > at) return;
    Instruction& test = code.instructions[at];
    const Instruction& move = code.instructions.back();
    const Op op = after(test.op, 2);
    if (move.op != Op::move || !info(op).name.starts_with("move_if")) return;
    test = {op, test.a, test.b, move.b, move.a};
    skip.pop_back();
    join_statement();
    code.instructions.pop_back();
    code.places.pop_back();
}

}  // namespace lineshaft::st
