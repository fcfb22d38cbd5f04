#include <algorithm>
#include <bit>

#include "runtime/st/generator_class.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using S = Statement::Kind;

constexpr std::uint32_t region_mask = 3U << 30;

}  // namespace

Generated generate(Checked& checked, Diagnostics& out, const CodeOptions& options) {
    return Generator(checked, out, options).generate();
}

Generated Generator::generate() {
    code_.globals = static_cast<std::uint32_t>(checked_.globals.size());
    for (Routine* routine : checked_.order)
        for (const Routine* called : routine->calls)
            routine->depth = std::max(routine->depth, called->depth + 1);
    for (const Routine& routine : checked_.routines) {
        if (!routine.is_test()) continue;
        has_tests_ = true;
        test_file_ = routine.pou->place.file->get();
        routine.owner->depth = std::max(routine.owner->depth, routine.depth);
    }
    for (const Global& global : checked_.globals)
        if (global.type->kind != Kind::block) slots_of(*global.type);
    for (Routine* routine : checked_.order) {
        if (!out_.empty()) return {};
        write(*routine);
    }
    for (const Global& global : checked_.globals) {
        Image image(slots_of(*global.type), 0);
        fill_default(image, 0, *global.type);
        fill_data_block(image, global);
        images_[global.type] = std::move(image);
    }
    finish_images();
    return {std::move(code_), std::move(images_), std::move(assertions_)};
}

std::uint32_t Generator::routine_number(const Routine& routine) {
    return numbers_.at(&routine);
}

void Generator::write(Routine& routine) {
    begin(routine);
    begin_mockable(routine);
    cover(CoverPoint::Kind::function, routine.pou->place);
    write_block(routine.pou->body);
    put(Op::leave);
    finish(routine);
}

void Generator::begin(Routine& routine) {
    routine_ = &routine;
    if (routine.owner)
        lay_out_method(routine);
    else if (routine.is_function())
        lay_out_function(routine);
    else
        lay_out(routine);
    Routine* block = routine.owner ? routine.owner : &routine;
    image_ = routine.is_function() ? &function_images_[&routine] : &images_[block->type];
    temporaries_ = most_temporaries_ = windows_ = 0;
    constants_.clear();
    constant_slots_.clear();
    loops_.clear();
    numbers_[&routine] = static_cast<std::uint32_t>(code_.routines.size());
    code_.routines.push_back({routine.name, next(), 0, 0, routine.depth});
    place_ = routine.pou->place;
    const bool in_function = routine.is_function();
    if (in_function || routine.temps_begin < routine.variables_end) {
        image_uses_.push_back({next(), in_function ? nullptr : block->type, &routine});
        put(Op::initialise, routine.temps_begin, routine.temps_begin,
            routine.variables_end - routine.temps_begin);
    }
}

/// A block's frame grows by what its body and its methods need; `variables_end` is then behind it.
void Generator::finish(Routine& routine) {
    Routine& frame_of = routine.owner ? *routine.owner : routine;
    const bool is_function = routine.is_function();
    const std::uint32_t constants =
        is_function ? routine.variables_end : static_cast<std::uint32_t>(image_->size());
    const auto temporaries = constants + static_cast<std::uint32_t>(constants_.size());
    const std::uint32_t windows = temporaries + most_temporaries_;
    image_->insert(image_->end(), constants_.begin(), constants_.end());
    CodeRoutine& code = code_.routines.back();
    code.end = next();
    if (is_function) {
        Instruction& first = code_.instructions[code.entry];
        first.c = temporaries - first.a;
    }
    const auto place = [&](std::uint32_t& operand) {
        const std::uint32_t region = operand & region_mask, at = operand & ~region_mask;
        if (region == Region::temporary) operand = temporaries + at;
        if (region == Region::constant) operand = constants + at;
        if (region == Region::window) operand = windows + at;
    };
    for (std::uint32_t i = code.entry; i < code.end; ++i) {
        Instruction& in = code_.instructions[i];
        const std::string_view operands = info(in.op).operands;
        const auto is_slot = [&](int k) {
            return operands[static_cast<std::size_t>(k)] == 'w' ||
                   operands[static_cast<std::size_t>(k)] == 'r' ||
                   operands[static_cast<std::size_t>(k)] == 's';
        };
        if (is_slot(0)) place(in.a);
        if (is_slot(1)) place(in.b);
        if (is_slot(2)) place(in.c);
    }
    std::uint32_t end = windows + windows_;
    if (is_function) end = std::max(end, code_.instructions[code.entry].a + 1);
    if (!is_function) image_->resize(end, 0);
    code.frame = end;
    frame_of.frame = std::max(frame_of.frame, end);
}

void Generator::put(Op op, Slot a, Slot b, Slot c) {
    code_.instructions.push_back({op, a, b, c});
    code_.places.push_back(place_);
}

void Generator::jump(Op op, Slot a, Slot b, std::vector<std::uint32_t>& to) {
    to.push_back(next());
    put(op, a, b, 0);
}

void Generator::land(std::vector<std::uint32_t>& jumps) {
    for (const std::uint32_t at : jumps) code_.instructions[at].c = next();
    jumps.clear();
}

Slot Generator::new_temporary(std::uint32_t slots) {
    const Slot slot = Region::temporary + temporaries_;
    temporaries_ += slots;
    most_temporaries_ = std::max(most_temporaries_, temporaries_);
    return slot;
}

Slot Generator::constant_slot(std::uint64_t bits) {
    const auto [it, added] =
        constant_slots_.emplace(bits, Region::constant + static_cast<Slot>(constants_.size()));
    if (added) constants_.push_back(bits);
    return it->second;
}

Slot Generator::constant_slot(const Type& type, const Constant& value) {
    if (type.is_real()) return constant_slot(std::bit_cast<std::uint64_t>(value.real));
    return constant_slot(static_cast<std::uint64_t>(value.integer));
}

std::uint32_t Generator::table(IndexTable made) {
    const auto it = std::ranges::find_if(code_.tables, [&](const IndexTable& t) {
        return t.lower == made.lower && t.count == made.count && t.stride == made.stride;
    });
    if (it != code_.tables.end()) return static_cast<std::uint32_t>(it - code_.tables.begin());
    code_.tables.push_back(made);
    return static_cast<std::uint32_t>(code_.tables.size() - 1);
}

// Statements.

void Generator::write_block(const Block& block) {
    for (const Statement* statement : block) {
        const std::uint32_t kept = temporaries_;
        cover(CoverPoint::Kind::statement, statement->place);
        write_statement(*statement);
        temporaries_ = kept;
    }
}

void Generator::write_statement(const Statement& s) {
    place_ = s.place;
    switch (s.kind) {
        case S::assign:
            return write_assignment(s);
        case S::call:
            if (s.value->test != TestCall::none)
                write_test_statement(*s.value);
            else if (s.value->routine && s.value->routine->has_instances())
                call_instance(*s.value);
            else if (s.value->operands[0]->type && s.value->operands[0]->type->is_instance())
                call_instance(*s.value);
            else if (s.value->routine)
                call_routine(*s.value);
            else
                value(*s.value);
            return;
        case S::if_:
            return write_if(s);
        case S::case_:
            return write_case(s);
        case S::for_:
            return write_for(s);
        case S::while_:
        case S::repeat:
            return write_loop(s);
        case S::exit:
            return jump(Op::jump, 0, 0, loops_.back().exits);
        case S::continue_:
            return jump(Op::jump, 0, 0, loops_.back().nexts);
        case S::return_:
            return put(Op::leave);
    }
}

void Generator::write_assignment(const Statement& s) {
    if (s.target->kind == Expression::Kind::bit) return store_bits(*s.target, *s.value);
    assign(locate(*s.target), *s.target->type, *s.value);
}

void Generator::jump_unless(const Expression& condition, std::vector<std::uint32_t>& to) {
    const Expression& e = condition;
    const bool binary = e.kind == Expression::Kind::binary;
    if (binary && (e.op == Word::and_then_)) {
        jump_unless(*e.operands[0], to);
        return jump_unless(*e.operands[1], to);
    }
    if (e.kind == Expression::Kind::unary && e.op == Word::not_)
        return jump(Op::jump_if, 0, value(*e.operands[0]), to);
    const bool compares = binary && e.op >= Word::less && e.op <= Word::unequal &&
                          e.operands[0]->type->kind != Kind::text;
    if (!compares) return jump(Op::jump_unless, 0, value(e), to);
    const Type& type = *e.operands[0]->type;
    Slot a = value_before(*e.operands[0], *e.operands[1]), b = value(*e.operands[1]);
    const bool swapped = e.op == Word::greater || e.op == Word::greater_or_equal;
    if (swapped) std::swap(a, b);
    const bool equal = e.op == Word::equal || e.op == Word::unequal;
    if (equal) {
        const bool is_equal = e.op == Word::equal;
        if (type.is_real())
            return jump(is_equal ? Op::jump_unless_eq_float : Op::jump_unless_ne_float, a, b, to);
        return jump(is_equal ? Op::jump_unless_eq_word : Op::jump_unless_ne_word, a, b, to);
    }
    const bool less = e.op == Word::less || e.op == Word::greater;
    const Op op = type.is_real() ? (less ? Op::jump_unless_lt_float : Op::jump_unless_le_float)
                  : type.is_unsigned_64()
                      ? (less ? Op::jump_unless_lt_unsigned : Op::jump_unless_le_unsigned)
                      : (less ? Op::jump_unless_lt_signed : Op::jump_unless_le_signed);
    jump(op, a, b, to);
}

void Generator::write_if(const Statement& s) {
    std::vector<std::uint32_t> ends, skip;
    for (const Branch& branch : s.branches) {
        const std::uint32_t kept = temporaries_;
        place_ = branch.condition->place;
        if (&branch != &s.branches.front()) cover(CoverPoint::Kind::statement, place_);
        jump_unless(*branch.condition, skip);
        temporaries_ = kept;
        cover_branch(s, static_cast<std::size_t>(&branch - s.branches.data()));
        write_block(branch.body);
        if (&branch != &s.branches.back() || !s.body.empty() || options_.covered)
            jump(Op::jump, 0, 0, ends);
        land(skip);
    }
    cover_branch(s, s.branches.size());
    write_block(s.body);
    land(ends);
}

void Generator::write_case(const Statement& s) {
    const Type& type = *s.value->type;
    const bool is_unsigned = type.is_unsigned_64();
    const Slot selector = value(*s.value);
    std::vector<std::uint32_t> ends;
    for (const Branch& branch : s.branches) {
        std::vector<std::uint32_t> here, past;
        for (const auto& [from, to] : branch.labels) {
            const Slot lower = constant_slot(type, from->constant);
            if (!to) {
                jump(Op::jump_unless_ne_word, selector, lower, here);
                continue;
            }
            const Slot upper = constant_slot(type, to->constant);
            jump(is_unsigned ? Op::jump_unless_le_unsigned : Op::jump_unless_le_signed, lower,
                 selector, past);
            jump(is_unsigned ? Op::jump_unless_lt_unsigned : Op::jump_unless_lt_signed, upper,
                 selector, here);
            land(past);
        }
        jump(Op::jump, 0, 0, past);
        land(here);
        cover_branch(s, static_cast<std::size_t>(&branch - s.branches.data()));
        write_block(branch.body);
        jump(Op::jump, 0, 0, ends);
        land(past);
    }
    cover_branch(s, s.branches.size());
    write_block(s.body);
    land(ends);
}

void Generator::write_for(const Statement& s) {
    const Location target = locate(*s.target);
    const bool direct = target.mode == Location::Mode::slot;
    const Slot counter = direct ? target.slot : new_temporary();
    value_to(*s.value, counter);
    const Slot limit = new_temporary(2);
    value_to(*s.limit, limit);
    if (s.step)
        value_to(*s.step, limit + 1);
    else
        put(Op::move, limit + 1, constant_slot(1));
    Loop loop;
    jump(Op::skip_loop, counter, limit, loop.exits);
    loops_.push_back(std::move(loop));
    const std::uint32_t start = next();
    if (!direct) store(target, counter);
    cover_branch(s, 0);
    write_block(s.body);
    land(loops_.back().nexts);
    place_ = s.place;
    put(Op::repeat_next, counter, limit, start);
    land(loops_.back().exits);
    cover_branch(s, 1);
    loops_.pop_back();
    const Type& type = s.target->type->plain();
    if (type.bits < 64) put(of_type(Op::wrap_sint, type), counter, counter);
    if (!direct) store(target, counter);
}

void Generator::write_loop(const Statement& s) {
    loops_.emplace_back();
    const std::uint32_t start = next();
    const bool is_while = s.kind == S::while_;
    if (is_while) jump_unless(*s.value, loops_.back().exits);
    cover_branch(s, 0);
    write_block(s.body);
    land(loops_.back().nexts);
    std::vector<std::uint32_t> again;
    place_ = s.value->place;
    if (!is_while) {
        jump_unless(*s.value, again);
        jump(Op::jump, 0, 0, loops_.back().exits);
        land(again);
    }
    put(Op::repeat, 0, 0, start);
    land(loops_.back().exits);
    cover_branch(s, 1);
    loops_.pop_back();
}

}  // namespace lineshaft::st
