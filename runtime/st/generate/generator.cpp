#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>

#include "runtime/st/generate/generator_class.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using S = Statement::Kind;

constexpr std::uint32_t region_mask = 3U << 30;

constexpr Op after(Op op, int by) {
    return static_cast<Op>(static_cast<int>(op) + by);
}

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
    fuses_ = !options_.counted && !options_.covered && !has_tests_;
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
    link();
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
    landed_ = next();
    Routine* block = routine.owner ? routine.owner : &routine;
    image_ = routine.is_function() ? &function_images_[&routine] : &images_[block->type];
    temporaries_ = most_temporaries_ = windows_ = 0;
    unwritten_.clear();
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
    const auto place = [&](auto& operand) {
        const Slot slot = static_cast<Slot>(operand);
        const Slot region = slot & region_mask, at = slot & ~region_mask;
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
        if (is_slot(3)) place(in.d);
        if (fuses_) thread(i);
    }
    std::uint32_t end = windows + windows_;
    if (is_function) end = std::max(end, code_.instructions[code.entry].a + 1);
    if (!is_function) image_->resize(end, 0);
    code.frame = end;
    frame_of.frame = std::max(frame_of.frame, end);
}

/// A jump to a jump goes where that does.
void Generator::thread(std::uint32_t i) {
    Instruction& in = code_.instructions[i];
    if (info(in.op).operands[2] != 'j') return;
    while (in.c > i && code_.instructions[in.c].op == Op::jump) in.c = code_.instructions[in.c].c;
}

/// Jumps go to addresses, which stay as the code is moved on as a whole.
void Generator::link() {
    const auto address = [&](std::uint64_t place) {
        return reinterpret_cast<std::uint64_t>(&code_.instructions[place]);
    };
    for (Instruction& in : code_.instructions) {
        if (info(in.op).operands[2] == 'j') in.c = address(in.c);
        if (in.op != Op::choose) continue;
        const IndexTable& table = code_.tables[in.c];
        for (std::uint64_t k = table.first; k < table.first + table.count; ++k)
            code_.numbers[k] =
                static_cast<std::int64_t>(address(static_cast<std::uint64_t>(code_.numbers[k])));
    }
}

void Generator::put(Op op, Slot a, Slot b, Slot c, Slot d) {
    note_use({op, a, b, d, c});
    code_.instructions.push_back({op, a, b, d, c});
    code_.places.push_back(place_);
    if (fuses_ && next() - 1 > landed_) fuse();
}

/// What was fused has left its temporary unwritten: nothing may read that before it is written
/// again.
void Generator::note_use(const Instruction& in) {
    const std::string_view operands = info(in.op).operands;
    const Slot slots[] = {in.a, in.b, static_cast<Slot>(in.c), in.d};
    for (std::size_t i = 0; i < operands.size(); ++i)
        if (operands[i] == 'r' && unwritten_.contains(slots[i]))
            throw std::logic_error("a fused instruction's temporary is read again");
    for (std::size_t i = 0; i < operands.size(); ++i)
        if (operands[i] == 'w') unwritten_.erase(slots[i]);
}

/// The last two instructions to one, where the second is the only one that reads what the first
/// writes.
void Generator::fuse() {
    Instruction &first = code_.instructions[next() - 2], &second = code_.instructions.back();
    const auto replace = [&](Instruction by) {
        first = by;
        code_.instructions.pop_back();
        code_.places.pop_back();
    };
    if (first.op == Op::move && second.op == Op::jump)
        return replace({Op::move_and_jump, first.a, first.b, 0, second.c});
    if (first.op == Op::move && second.op == Op::move)
        return replace({Op::move_twice, first.a, first.b, second.b, second.a});
    if (const Op op = count_of(first, second); op != Op::leave)
        return replace({op, first.a, Slot(first.c), second.b, second.c});
    if ((first.a & region_mask) != Region::temporary) return;
    const auto join = [&](Instruction by) {
        if (second.a != first.a) unwritten_.insert(first.a);
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

/// `IF a < b THEN x := y; END_IF`, the last instructions, to one without a jump.
void Generator::fuse_guarded_move(std::vector<std::uint32_t>& skip) {
    const std::uint32_t at = next() - 2;
    if (!fuses_ || skip.empty() || skip.back() != at || landed_ > at) return;
    Instruction& test = code_.instructions[at];
    const Instruction& move = code_.instructions.back();
    const Op op = after(test.op, 2);
    if (move.op != Op::move || !info(op).name.starts_with("move_if")) return;
    test = {op, test.a, test.b, move.b, move.a};
    skip.pop_back();
    code_.instructions.pop_back();
    code_.places.pop_back();
}

void Generator::jump(Op op, Slot a, Slot b, std::vector<std::uint32_t>& to) {
    put(op, a, b, 0);
    to.push_back(next() - 1);
}

void Generator::land() {
    landed_ = next();
}

void Generator::land(std::vector<std::uint32_t>& jumps) {
    if (jumps.empty()) return;
    for (const std::uint32_t at : jumps) code_.instructions[at].c = next();
    jumps.clear();
    land();
}

Slot Generator::new_temporary(std::uint32_t slots) {
    const Slot slot = Region::temporary + temporaries_;
    temporaries_ += slots;
    most_temporaries_ = std::max(most_temporaries_, temporaries_);
    for (Slot used = slot; used < slot + slots && !unwritten_.empty(); ++used)
        unwritten_.erase(used);
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
    const auto [it, added] = tables_.emplace(made, static_cast<std::uint32_t>(code_.tables.size()));
    if (added) code_.tables.push_back(made);
    return it->second;
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
            if (s.value->kind == Expression::Kind::constant) return;
            if (s.value->test != TestCall::none)
                write_test_statement(*s.value);
            else if (s.value->routine && s.value->routine->has_instances())
                call_instance(*s.value);
            else if (s.value->operands[0]->type && s.value->operands[0]->type->is_instance())
                call_instance(*s.value);
            else if (s.value->routine)
                call_routine(*s.value);
            else if (s.value->type->kind == Type::Kind::text)
                text_address(*s.value);
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
    if (s.target->kind == Expression::Kind::bit)
        return store_bits(*s.target, value_before(*s.value, *s.target));
    if (s.target->is_character()) {
        const Slot from = value_before(*s.value, *s.target);
        const Slot text = text_address(*s.target->operands[0]);
        return put(Op::set_character, from, text, value(*s.target->arguments[0].value));
    }
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
        else
            fuse_guarded_move(skip);
        land(skip);
    }
    cover_branch(s, s.branches.size());
    write_block(s.body);
    land(ends);
}

void Generator::write_case(const Statement& s) {
    const Slot selector = value(*s.value);
    std::vector<std::uint32_t> ends;
    if (const auto table = jump_table(s)) return write_choice(s, selector, *table);
    for (const Branch& branch : s.branches) {
        std::vector<std::uint32_t> here, past;
        for (const auto& label : branch.labels)
            test_label(s, selector, label, &label == &branch.labels.back(), here, past);
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

/// Jumps `here` if the selector is one of the label; of the last one goes on, or jumps `past`.
void Generator::test_label(const Statement& s, Slot selector, const Branch::Label& label,
                           bool is_last, std::vector<std::uint32_t>& here,
                           std::vector<std::uint32_t>& past) {
    const Type& type = *s.value->type;
    const auto& [from, to] = label;
    const Slot lower = constant_slot(type, from->constant);
    if (!to)
        return is_last ? jump(Op::jump_unless_eq_word, selector, lower, past)
                       : jump(Op::jump_unless_ne_word, selector, lower, here);
    const bool is_unsigned = type.is_unsigned_64();
    const Op le = is_unsigned ? Op::jump_unless_le_unsigned : Op::jump_unless_le_signed;
    const Op lt = is_unsigned ? Op::jump_unless_lt_unsigned : Op::jump_unless_lt_signed;
    const Slot upper = constant_slot(type, to->constant);
    std::vector<std::uint32_t> beyond;
    jump(le, lower, selector, is_last ? past : beyond);
    if (is_last) return jump(le, selector, upper, past);
    jump(lt, upper, selector, here);
    land(beyond);
}

/// From the least to the greatest value of a CASE, if that is a table worth having.
std::optional<IndexTable> Generator::jump_table(const Statement& s) const {
    if (!fuses_ || s.value->type->is_unsigned_64()) return {};
    std::int64_t least = std::numeric_limits<std::int64_t>::max(), greatest = ~least;
    std::uint64_t labels = 0;
    for (const Branch& branch : s.branches) {
        for (const auto& [from, to] : branch.labels) {
            least = std::min(least, static_cast<std::int64_t>(from->constant.integer));
            greatest =
                std::max(greatest, static_cast<std::int64_t>((to ? to : from)->constant.integer));
            ++labels;
        }
    }
    const auto range = static_cast<std::uint64_t>(greatest) - static_cast<std::uint64_t>(least);
    if (labels < 8 || range >= 8 * labels) return {};
    return IndexTable{least, range + 1, 1, code_.numbers.size()};
}

void Generator::write_choice(const Statement& s, Slot selector, const IndexTable& table) {
    std::vector<std::uint32_t> ends, otherwise;
    put(Op::choose, 0, selector, this->table(table));
    jump(Op::jump, 0, 0, otherwise);
    const auto places = static_cast<std::ptrdiff_t>(table.first);
    code_.numbers.resize(table.first + table.count, -1);
    for (const Branch& branch : s.branches) {
        land();
        for (const auto& [from, to] : branch.labels)
            for (auto i = from->constant.integer; i <= (to ? to : from)->constant.integer; ++i)
                code_.numbers[table.place(static_cast<std::uint64_t>(i))] = next();
        write_block(branch.body);
        jump(Op::jump, 0, 0, ends);
    }
    land(otherwise);
    std::replace(code_.numbers.begin() + places,
                 code_.numbers.begin() + places + static_cast<std::ptrdiff_t>(table.count),
                 std::int64_t{-1}, std::int64_t{next()});
    write_block(s.body);
    land(ends);
}

void Generator::write_for(const Statement& s) {
    const Location target = locate(*s.target);
    const Type& type = *s.target->type;
    const bool direct = target.mode == Location::Mode::slot && !type.is_subrange;
    const Slot counter = direct ? target.slot : new_temporary();
    value_to(*s.value, counter);
    const Slot limit = new_temporary(2);
    value_to(*s.limit, limit);
    if (s.step)
        value_to(*s.step, limit + 1);
    else
        put(Op::move, limit + 1, constant_slot(1));
    if (type.is_subrange) store(target, counter);
    Loop loop;
    const bool is_long = type.is_unsigned_64();
    jump(is_long ? Op::skip_loop_unsigned : Op::skip_loop, counter, limit, loop.exits);
    loops_.push_back(std::move(loop));
    land();
    const std::uint32_t start = next();
    if (type.is_subrange) within(type, counter);
    if (!direct) store(target, counter);
    cover_branch(s, 0);
    write_block(s.body);
    land(loops_.back().nexts);
    place_ = s.place;
    if (!direct) put(Op::move, counter, load(target));
    put(is_long ? Op::repeat_next_unsigned : Op::repeat_next, counter, limit, start);
    land(loops_.back().exits);
    cover_branch(s, 1);
    loops_.pop_back();
    if (type.is_subrange) return;  // its last value
    if (type.bits < 64) put(of_type(Op::wrap_sint, type.plain()), counter, counter);
    if (!direct) store(target, counter);
}

void Generator::write_loop(const Statement& s) {
    loops_.emplace_back();
    land();
    const std::uint32_t start = next();
    const bool is_while = s.kind == S::while_;
    if (is_while) jump_unless(*s.value, loops_.back().exits);
    land();
    const std::uint32_t first = next();
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
    if (!is_while || !repeat_test(start, first)) put(Op::repeat, 0, 0, start);
    land(loops_.back().exits);
    cover_branch(s, 1);
    loops_.pop_back();
}

/// The test of a WHILE once more at its end, if it is short: saves a jump in each pass.
bool Generator::repeat_test(std::uint32_t start, std::uint32_t end) {
    constexpr std::uint32_t longest = 4;
    if (!fuses_ || end - start > longest || end == start) return false;
    for (std::uint32_t i = start; i + 1 < end; ++i) {
        const Op op = code_.instructions[i].op;
        const bool goes_on = info(op).operands.find('j') == std::string_view::npos &&
                             info(op).cost != OpClass::call && op != Op::initialise;
        if (!goes_on) return false;
    }
    Instruction test = code_.instructions[end - 1];
    const Op op = test.op == Op::jump_unless ? Op::repeat_if : after(test.op, 4);
    if (!info(op).name.starts_with("repeat_if")) return false;
    for (std::uint32_t i = start; i + 1 < end; ++i) {
        const Instruction in = code_.instructions[i];
        put(in.op, in.a, in.b, Slot(in.c), in.d);
    }
    put(op, test.a, test.b, end);
    return true;
}

}  // namespace lineshaft::st
