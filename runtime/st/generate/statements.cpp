#include "runtime/st/generate/statements.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

void write_character(Writing& w, const Statement& s) {
    const Expression& text = *s.target->operands[0];
    const Slot from = value_before(w, *s.value, *s.target);
    const Location at = locate(w, text);
    const Slot place = at.packed ? load_packed_text(w, at) : address_of(w, at);
    const Slot index = value(w, *s.target->arguments[0].value);
    const Dialect& dialect = s.target->place.dialect();
    Slot room = capacity_of(w, at, *text.type);
    const bool may_miss = dialect.characters_may_be_missing,
               grows = dialect.texts_grow_by_characters;
    if (may_miss || grows) {
        const TextRoom any(0, false), rule = grows ? any.that_grows() : any.that_may_miss();
        room = w.emit(Op::or_bits, none, room, w.constant_slot(rule.number()));
    }
    w.put(dialect.texts_are_bytes ? Op::set_text_byte : Op::set_character, from, place, index,
          room);
    if (at.packed) store_packed_text(w, at, place);
}

/// It stays what it is, whatever derives from its block is copied to it.
void assign_instance(Writing& w, const Statement& s) {
    const Location to = as_address(w, locate(w, *s.target));
    const Location kind = behind(to, w.code.kind_slot());
    const Slot kept = w.emit(Op::move, none, load(w, kind));
    assign(w, to, *s.target->type, *s.value);
    store(w, kind, kept);
}

/// In tests how often it was called, or that it is mocked, stays its own.
void assign_standard(Writing& w, const Statement& s) {
    const Location to = locate(w, *s.target);
    copy(w, to, locate(w, *s.value), s.target->type->slots - (w.has_tests ? 1 : 0));
}

/// Slots of a value that an axis or a group links, see BlockType::add_links.
struct LinkedSlots {
    std::uint32_t first = 0, count = 0;
};

void find_links(Writing& w, const Type& type, std::uint32_t at, std::vector<LinkedSlots>& found) {
    if (type.kind == Kind::array) {
        const std::size_t before = found.size();
        find_links(w, *type.element, at, found);
        if (found.size() == before) return;
        for (std::int64_t i = type.lower + 1; i <= type.upper; ++i) {
            at += slots_of(w, *type.element);
            find_links(w, *type.element, at, found);
        }
    }
    if (type.kind == Kind::standard && type.standard->add_links) {
        std::vector<LinkedPart> parts;
        type.standard->add_links(parts, *type.standard);
        for (const LinkedPart& part : parts)
            found.push_back({at + static_cast<std::uint32_t>(part.place / 8),
                             static_cast<std::uint32_t>(part.bytes / 8)});
    }
    const bool is_block = type.kind == Kind::block;
    if (!is_block && type.kind != Kind::structure) return;
    for (const Variable* member : is_block ? all_variables(*type.routine) : type.members)
        if (member->type && member->space == Space::frame)
            find_links(w, *member->type, at + member->slot, found);
}

void assign_value(Writing& w, const Statement& s) {
    const Type& type = *s.target->type;
    if (type.kind == Kind::block && w.code.has_kinds) return assign_instance(w, s);
    if (type.kind == Kind::standard) return assign_standard(w, s);
    assign(w, locate(w, *s.target), type, *s.value);
}

/// An instance that begins anew keeps the jobs of its commands, which are in lists of others: what
/// it has told them goes on, and each start of a command has a number of its own.
void assign_but_links(Writing& w, const Statement& s, std::span<const LinkedSlots> links) {
    const Location to = as_address(w, locate(w, *s.target));
    std::vector<Slot> kept;
    for (const LinkedSlots& link : links) {
        kept.push_back(w.new_temporary(link.count));
        copy(w, {Mode::slot, kept.back()}, behind(to, link.first), link.count);
    }
    assign_value(w, s);
    for (std::size_t i = 0; i < links.size(); ++i)
        copy(w, behind(to, links[i].first), {Mode::slot, kept[i]}, links[i].count);
}

void write_assignment(Writing& w, const Statement& s) {
    if (s.target->kind == Expression::Kind::bit)
        return store_bits(w, *s.target, value_before(w, *s.value, *s.target));
    if (s.target->is_character()) return write_character(w, s);
    std::vector<LinkedSlots> links;
    if (!s.target->type->is_scalar()) find_links(w, *s.target->type, 0, links);
    if (links.empty()) return assign_value(w, s);
    assign_but_links(w, s, links);
}

void jump_unless(Writing& w, const Expression& condition, Jumps& to) {
    const Expression& e = condition;
    const bool binary = e.kind == Expression::Kind::binary;
    if (binary && (e.op == Word::and_then_)) {
        jump_unless(w, *e.operands[0], to);
        return jump_unless(w, *e.operands[1], to);
    }
    if (e.kind == Expression::Kind::unary && e.op == Word::not_)
        return w.jump(Op::jump_if, 0, value(w, *e.operands[0]), to);
    if (!compares_numbers(e)) return w.jump(Op::jump_unless, 0, value(w, e), to);
    auto [a, b, type] = sides_of(w, e);
    if (is_exchanged(e.op)) std::swap(a, b);
    w.jump(after(comparison_op(e.op, type), 2), a, b, to);
}

void write_if(Writing& w, const Statement& s) {
    Jumps ends, skip;
    for (const Branch& branch : s.branches) {
        const std::uint32_t kept = w.temporaries;
        w.place = branch.condition->place;
        if (&branch != &s.branches.front()) w.begin_statement(w.place);
        jump_unless(w, *branch.condition, skip);
        w.temporaries = kept;
        w.cover_branch(s, static_cast<std::size_t>(&branch - s.branches.data()));
        write_block(w, branch.body);
        if (&branch != &s.branches.back() || !s.body.empty() || w.options.covered)
            w.jump(Op::jump, 0, 0, ends);
        else
            w.fuse_guarded_move(skip);
        w.land(skip);
    }
    w.cover_branch(s, s.branches.size());
    write_block(w, s.body);
    w.land(ends);
}

/// From the least to the greatest value of a CASE, if that is a table worth having.
std::optional<IndexTable> jump_table(Writing& w, const Statement& s) {
    if (!w.fuses || s.value->type->is_unsigned_64()) return {};
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
    return IndexTable{least, range + 1, 1, w.code.numbers.size()};
}

void write_choice(Writing& w, const Statement& s, Slot selector, const IndexTable& table) {
    Jumps ends, otherwise;
    w.put(Op::choose, 0, selector, w.table(table));
    w.jump(Op::jump, 0, 0, otherwise);
    const auto places = static_cast<std::ptrdiff_t>(table.first);
    w.code.numbers.resize(table.first + table.count, -1);
    for (const Branch& branch : s.branches) {
        w.land();
        for (const auto& [from, to] : branch.labels)
            for (auto i = from->constant.integer; i <= (to ? to : from)->constant.integer; ++i) {
                std::int64_t& number = w.code.numbers[table.place(static_cast<std::uint64_t>(i))];
                if (number < 0) number = w.next();
            }
        write_block(w, branch.body);
        w.jump(Op::jump, 0, 0, ends);
    }
    w.land(otherwise);
    std::replace(w.code.numbers.begin() + places,
                 w.code.numbers.begin() + places + static_cast<std::ptrdiff_t>(table.count),
                 std::int64_t{-1}, std::int64_t{w.next()});
    write_block(w, s.body);
    w.land(ends);
}

/// Jumps `here` if the selector is one of the label; of the last one goes on, or jumps `past`.
void test_label(Writing& w, const Statement& s, Slot selector, const Branch::Label& label,
                bool is_last, Jumps& here, Jumps& past) {
    const Type& type = *s.value->type;
    const auto& [from, to] = label;
    const Slot lower = w.constant_slot(type, from->constant);
    if (!to)
        return is_last ? w.jump(Op::jump_unless_eq_word, selector, lower, past)
                       : w.jump(Op::jump_unless_ne_word, selector, lower, here);
    const bool is_unsigned = type.is_unsigned_64();
    const Op le = is_unsigned ? Op::jump_unless_le_unsigned : Op::jump_unless_le_signed;
    const Op lt = is_unsigned ? Op::jump_unless_lt_unsigned : Op::jump_unless_lt_signed;
    const Slot upper = w.constant_slot(type, to->constant);
    Jumps beyond;
    w.jump(le, lower, selector, is_last ? past : beyond);
    if (is_last) return w.jump(le, selector, upper, past);
    w.jump(lt, upper, selector, here);
    w.land(beyond);
}

void write_case(Writing& w, const Statement& s) {
    const Slot selector = value(w, *s.value);
    Jumps ends;
    if (const auto table = jump_table(w, s)) return write_choice(w, s, selector, *table);
    for (const Branch& branch : s.branches) {
        Jumps here, past;
        for (const auto& label : branch.labels)
            test_label(w, s, selector, label, &label == &branch.labels.back(), here, past);
        w.land(here);
        w.cover_branch(s, static_cast<std::size_t>(&branch - s.branches.data()));
        write_block(w, branch.body);
        w.jump(Op::jump, 0, 0, ends);
        w.land(past);
    }
    w.cover_branch(s, s.branches.size());
    write_block(w, s.body);
    w.land(ends);
}

void write_for(Writing& w, const Statement& s) {
    const Location target = locate(w, *s.target);
    const Type& type = *s.target->type;
    const bool direct = target.mode == Location::Mode::slot && !type.in_a_run().is_subrange;
    const Slot counter = direct ? target.slot : w.new_temporary();
    value_to(w, *s.value, counter);
    const Slot limit = w.new_temporary(2);
    value_to(w, *s.limit, limit);
    if (s.step)
        value_to(w, *s.step, limit + 1);
    else
        w.put(Op::move, limit + 1, w.constant_slot(1));
    const auto look_again = [&](const Expression* part, Slot to) {
        const bool varies = part && part->kind != E::constant;
        if (varies && s.place.dialect().loops_look_again) value_to(w, *part, to);
    };
    if (type.in_a_run().is_subrange) store(w, target, counter);
    Writing::Loop loop;
    const bool is_long = type.is_unsigned_64();
    w.jump(is_long ? Op::skip_loop_unsigned : Op::skip_loop, counter, limit, loop.exits);
    w.loops.push_back(std::move(loop));
    w.land();
    const std::uint32_t start = w.next();
    if (type.in_a_run().is_subrange) within(w, type, counter);
    if (!direct) store(w, target, counter);
    w.cover_branch(s, 0);
    write_block(w, s.body);
    w.land(w.loops.back().nexts);
    w.place = s.place;
    look_again(s.limit, limit);
    look_again(s.step, limit + 1);
    if (!direct) w.put(Op::move, counter, load(w, target));
    w.put(is_long ? Op::repeat_next_unsigned : Op::repeat_next, counter, limit, start);
    w.land(w.loops.back().exits);
    w.cover_branch(s, 1);
    w.loops.pop_back();
    if (type.in_a_run().is_subrange) return;  // its last value
    if (type.bits < 64) w.put(of_type(Op::wrap_sint, type.plain()), counter, counter);
    if (!direct) store(w, target, counter);
}

/// The test of a WHILE once more at its end, if it is short: saves a jump in each pass.
bool repeat_test(Writing& w, std::uint32_t start, std::uint32_t end) {
    constexpr std::uint32_t longest = 4;
    if (!w.fuses || end - start > longest || end == start) return false;
    for (std::uint32_t i = start; i + 1 < end; ++i) {
        const Op op = w.code.instructions[i].op;
        const bool goes_on = info(op).operands.find('j') == std::string_view::npos &&
                             info(op).cost != OpClass::call && op != Op::initialise;
        if (!goes_on) return false;
    }
    Instruction test = w.code.instructions[end - 1];
    const Op op = test.op == Op::jump_unless ? Op::repeat_if : after(test.op, 4);
    if (!info(op).name.starts_with("repeat_if")) return false;
    for (std::uint32_t i = start; i + 1 < end; ++i) w.put(w.code.instructions[i]);
    w.put(op, test.a, test.b, end);
    return true;
}

void write_loop(Writing& w, const Statement& s) {
    w.loops.emplace_back();
    w.land();
    const std::uint32_t start = w.next();
    const bool is_while = s.kind == S::while_;
    if (is_while) jump_unless(w, *s.value, w.loops.back().exits);
    w.land();
    const std::uint32_t first = w.next();
    w.cover_branch(s, 0);
    write_block(w, s.body);
    w.land(w.loops.back().nexts);
    Jumps again;
    w.place = s.value->place;
    if (!is_while) {
        jump_unless(w, *s.value, again);
        w.jump(Op::jump, 0, 0, w.loops.back().exits);
        w.land(again);
    }
    if (is_while && repeat_test(w, start, first))
        w.put(Op::repeat, 0, 0, w.next() + 1);  // the last pass counts as those before it do
    else
        w.put(Op::repeat, 0, 0, start);
    w.land(w.loops.back().exits);
    w.cover_branch(s, 1);
    w.loops.pop_back();
}

void write_try(Writing& w, const Statement& s) {
    Jumps ends;
    w.land();
    const std::uint32_t first = w.next();
    write_block(w, s.body);
    const std::uint32_t end = w.next();
    w.jump(Op::jump, 0, 0, ends);
    w.land();
    if (first < end) w.code.handlers.push_back({first, end, w.next()});
    if (s.target) {
        const Slot number = w.emit(Op::exception, none, 0);
        store(w, locate(w, *s.target),
              convert(w, number, integer_type(32, false), *s.target->type, false, none));
    }
    write_block(w, s.branches[0].body);
    w.land(ends);
    write_block(w, s.branches[1].body);
}

void write_call(Writing& w, const Expression& e) {
    if (e.kind == Expression::Kind::constant) return;
    if (e.kind != Expression::Kind::call) return void(value(w, e));  // ROL of a BOOL is that
    if (e.test != TestCall::none) return write_test_statement(w, e);
    const Type* callee = e.operands[0]->type;
    if ((e.routine && e.routine->has_instances()) || (callee && callee->is_instance()))
        return call_instance(w, e);
    if (e.routine)
        call_routine(w, e);
    else
        value(w, e);
}

void write_label(Writing& w, const Statement& s) {
    Writing::Label& label = w.labels[s.value->token.text];
    w.land(label.jumps);
    w.land();
    label.at = w.next();
}

void write_goto(Writing& w, const Statement& s) {
    Writing::Label& label = w.labels[s.value->token.text];
    if (label.at)
        w.put(Op::repeat, 0, 0, *label.at);
    else
        w.jump(Op::jump, 0, 0, label.jumps);
}

void write_statement(Writing& w, const Statement& s) {
    w.place = s.place;
    switch (s.kind) {
        case S::assign:
            return write_assignment(w, s);
        case S::call:
            return write_call(w, *s.value);
        case S::if_:
            return write_if(w, s);
        case S::case_:
            return write_case(w, s);
        case S::for_:
            return write_for(w, s);
        case S::while_:
        case S::repeat:
            return write_loop(w, s);
        case S::try_:
            return write_try(w, s);
        case S::exit:
            return w.jump(Op::jump, 0, 0, w.loops.back().exits);
        case S::continue_:
            return w.jump(Op::jump, 0, 0, w.loops.back().nexts);
        case S::return_:
            return w.leave();
        case S::label:
            return write_label(w, s);
        case S::goto_:
            return write_goto(w, s);
        case S::action:  // a call by now
        case S::sequence:
            w.cover_branch(s, 0);
            return write_block(w, s.body);
    }
}

}  // namespace

void write_block(Writing& w, const Block& block) {
    for (const Statement* statement : block) {
        const std::uint32_t kept = w.temporaries;
        w.begin_statement(statement->place);
        write_statement(w, *statement);
        w.temporaries = kept;
    }
}

}  // namespace lineshaft::st
