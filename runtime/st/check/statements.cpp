#include "runtime/st/check/statements.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/configuration.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/s5.hpp"
#include "runtime/st/check/variants.hpp"
#include "runtime/st/syntax/words.hpp"

namespace lineshaft::st {

namespace {

bool leaves(const Statement& statement) {
    return statement.kind == S::return_ || statement.kind == S::exit ||
           statement.kind == S::continue_ || statement.kind == S::goto_;
}

NameSet labels_of(Checking& c, const Block& block) {
    NameSet labels;
    for (const Statement* s : block)
        if (s->kind == S::label && !labels.emplace(s->value->token.text).second)
            c.fail(code::declared_twice, s->place,
                   fmt::format("the label '{}' stands twice", s->value->token.text),
                   "take another name");
    return labels;
}

void check_goto(Checking& c, const Statement& s) {
    const auto has = [&](const NameSet& labels) { return labels.contains(s.value->token.text); };
    if (std::ranges::any_of(c.labels, has)) return;
    c.fail(code::not_declared, s.place,
           fmt::format("there is no label '{}' here", s.value->token.text),
           "it stands in the statements around the GOTO, not within another one");
}

void check(Checking& c, Block& block) {
    c.labels.push_back(labels_of(c, block));
    for (std::size_t i = 0; i < block.size(); ++i) {
        check(c, block[i]);
        if (leaves(*block[i]) && i + 1 < block.size() && block[i + 1]->kind != S::label) {
            c.warn(code::statement_never_reached, block[i + 1]->place, "this is never reached",
                   "the statement before it leaves");
        }
    }
    c.labels.pop_back();
}

/// The value of a standard function may be left, as that of any other.
void check_call(Checking& c, Statement& s) {
    if (s.value->type) return;
    const Type* type = check_call(c, s.value, true, nullptr);
    if (!type || !s.value->standard) return;
    s.value->type = type;
    make_concrete(c, s.value, *type);
}

void check_condition(Checking& c, Expression*& condition, std::string_view of) {
    const Type* type = check(c, condition, &bool_type);
    if (!type || type->kind == Kind::boolean) return;
    c.fail(code::type_does_not_fit, condition->place,
           fmt::format("the condition of {} is a BOOL, not {}", of, describe(*type)),
           type->is_number() || type->is_bits() ? "compare it, as in 'x <> 0'" : "");
}

/// The first range or text that stands twice is told.
bool check_labels_of_texts(Checking& c, const std::vector<Branch>& branches) {
    std::set<std::string_view> seen;
    for (const Branch& branch : branches) {
        for (const auto& [value, last] : branch.labels) {
            if (last)
                return c.fail(code::type_does_not_fit, value->place.to(last->place),
                              "texts have no range", "name each of them"),
                       false;
            if (value->kind == E::constant && !seen.insert(value->token.text).second)
                return c.fail(code::value_out_of_range, value->place,
                              fmt::format("{} stands twice in this CASE", value->place.text()),
                              "only the first one would count"),
                       false;
        }
    }
    return true;
}

/// `selector = 'a' OR selector = 'b'`, balanced, as there may be many.
Expression* is_one_of(Checking& c, const Expression& selector,
                      std::span<const Branch::Label> labels) {
    Expression* first = labels.front().first;
    if (labels.size() == 1)
        return make_binary(c, first->place, first->place, Word::equal, make_copy(c, selector),
                           first);
    const std::size_t half = labels.size() / 2;
    return make_binary(c, first->place, first->place, Word::or_,
                       is_one_of(c, selector, labels.first(half)),
                       is_one_of(c, selector, labels.subspan(half)));
}

/// It may be read again, and is the same.
bool is_read_freely(const Expression& e) {
    return e.kind == E::name || (e.kind == E::member && is_read_freely(*e.operands[0]));
}

/// SIMATIC AX has a CASE of texts: `IF text = 'a' OR text = 'b' THEN ... ELSIF`.
void rewrite_case_of_texts(Checking& c, Statement*& s) {
    if (!check_labels_of_texts(c, s->branches)) return;
    const Expression* selector = s->value;
    Block made;
    if (!is_read_freely(*selector)) {
        Variable& once = c.make_variable(*c.routine, s->value->token, "CASE", s->value->type);
        made.push_back(make_assignment(c, s->place, make_use(c, *s->value, once), s->value));
        selector = make_use(c, *s->value, once);
    }
    Statement* chosen = make_if(c, s->place, nullptr, {}, std::move(s->body));
    chosen->branches = std::move(s->branches);
    for (Branch& branch : chosen->branches) {
        if (!branch.labels.empty()) branch.condition = is_one_of(c, *selector, branch.labels);
        branch.labels.clear();
    }
    made.push_back(chosen);
    s = make_sequence(c, s->place, std::move(made));
    check(c, s);
}

/// A number that no value of the enumeration has; CODESYS refuses it of one that is strict alone.
bool is_of_no_value(Checking& c, Expression*& label, const Type& type) {
    const bool is_literal = label && label->kind == E::constant && !label->type;
    const Type* given = is_literal ? check(c, label, &type) : nullptr;
    return given && given->kind == Kind::any_integer && !type.name_of(label->constant.integer);
}

/// Where a label is such a number, all of them are numbers.
const Type* select_by_numbers(Checking& c, Statement& s, const Type& type) {
    const bool are_numbers = s.place.dialect().enumerations_are_numbers && !type.is_strict;
    if (!type.has_numbers || !are_numbers) return &type;
    const auto is_there = [&](Branch& branch) {
        return std::ranges::any_of(branch.labels, [&](auto& label) {
            return is_of_no_value(c, label.first, type) || is_of_no_value(c, label.second, type);
        });
    };
    if (std::ranges::none_of(s.branches, is_there)) return &type;
    for (Branch& branch : s.branches)
        for (auto& [from, to] : branch.labels)
            for (Expression** label : {&from, &to})
                if (*label && check(c, *label, &type)) enumeration_becomes_number(c, *label);
    enumeration_becomes_number(c, s.value);
    return s.value->type;
}

/// Siemens compares one label behind the other, until one agrees.
void tell_of_second(Checking& c, const Expression& label) {
    const std::string message = fmt::format("'{}' stands twice in this CASE", label.place.text());
    if (label.place.dialect().has_s7_instructions)
        c.warn(code::value_out_of_range, label.place, message, "only the first one counts");
    else
        c.fail(code::value_out_of_range, label.place, message, "only the first one would count");
}

void check_case(Checking& c, Statement*& slot) {
    take_type_names(c, *slot);
    const Type* type = check(c, slot->value);
    if (type && type->kind == Kind::text && slot->value->place.dialect().selects_by_texts)
        return rewrite_case_of_texts(c, slot);
    Statement& s = *slot;
    if (type) type = select_by_numbers(c, s, *type);
    if (type) {
        look_in_register(c, s.value);
        type = s.value->type;
    }
    if (type && type->kind == Kind::any_integer)
        type = coerce(c, s.value, lint_type) ? &lint_type : nullptr;
    const bool fits =
        type && (type->kind == Kind::integer || type->is_bits() || type->kind == Kind::enumeration);
    if (type && !fits)
        c.fail(code::type_does_not_fit, s.value->place,
               fmt::format("CASE selects by a whole number or an enumeration, not {}",
                           describe(*type)),
               "write IF and ELSIF");
    std::vector<std::pair<Wide, Wide>> seen;
    for (Branch& branch : s.branches) {
        for (auto& [from, to] : branch.labels) {
            if (!fits) break;
            const auto lower = check_whole(c, from, *type);
            const auto upper = to ? check_whole(c, to, *type) : lower;
            if (!lower || !upper) continue;
            if (*lower > *upper)
                c.fail(code::value_out_of_range, from->place.to(to->place),
                       "this range has no value", "the smaller one stands first");
            const auto meets = [&, low = *lower, high = *upper](const auto& other) {
                return low <= other.second && other.first <= high;
            };
            if (std::ranges::any_of(seen, meets)) tell_of_second(c, *from);
            seen.emplace_back(*lower, *upper);
        }
        check(c, branch.body);
    }
    check(c, s.body);
}

/// SIMATIC AX lets an INT begin with a DINT.
bool narrows(Checking& c, Expression*& first, const Type& type) {
    const Type& from = first->type->plain();
    const bool is_wider = from.kind == Kind::integer && type.kind == Kind::integer &&
                          !type.is_subrange && from.bits > type.bits && !is_constant(*first);
    if (!is_wider || !first->place.dialect().loops_begin_narrowed) return false;
    warn_of_loss(c, *first, type);
    return convert(c, first, type);
}

/// Over the values of an enumeration: `FOR number := first TO last DO target := number; ...`. What
/// no value of one that is strict has is the fault of that assignment. Gives what is left to do
/// behind the loop: of one that is not strict its variable is then beyond the last value.
Statement* rewrite_for_of_values(Checking& c, Statement*& slot, const Type& type) {
    Variable& number = c.make_variable(*c.routine, slot->target->token, "FOR", &lint_type);
    Statement* loop = make_with(c, *slot, slot->value);
    loop->limit = slot->limit;
    loop->step = slot->step;
    for (Expression** bound : {&loop->value, &loop->limit})
        if (check(c, *bound, &type)) enumeration_becomes_number(c, *bound);
    loop->target = make_use(c, *slot->target, number);
    const auto take_number = [&, target = slot->target] {
        Expression* value = make_use(c, *target, number);
        convert(c, value, type);
        return make_assignment(c, target->place, target, value);
    };
    loop->body = {take_number()};
    loop->body.insert(loop->body.end(), slot->body.begin(), slot->body.end());
    slot = loop;
    return type.is_unchecked ? take_number() : nullptr;
}

/// A counter of CODESYS that ends at a limit of its type is never beyond it.
void note_endless(Checking& c, const Statement& s, const Type& type) {
    const Expression& limit = *s.limit;
    if (!limit.place.dialect().loops_look_again || !limit.type || !is_constant(limit)) return;
    const bool is_down = s.step && is_constant(*s.step) && s.step->constant.integer < 0;
    if (limit.constant.integer != (is_down ? smallest(type.plain()) : largest(type.plain())))
        return;
    c.warn(code::value_out_of_range, limit.place,
           fmt::format("on the controller this loop never ends: {} is the {} {}, and the counter "
                       "begins again behind it",
                       limit.place.text(), is_down ? "least" : "largest", type.plain().name),
           "count in a wider type; it ends here");
}

void check_for(Checking& c, Statement*& slot) {
    const Type* type = check(c, slot->target);
    Statement* behind = nullptr;
    if (type && type->has_numbers && slot->place.dialect().enumerations_are_numbers) {
        behind = rewrite_for_of_values(c, slot, *type);
        type = check(c, slot->target);
    }
    Statement& s = *slot;
    if (type && type->kind != Kind::integer && type->kind != Kind::bits) {
        c.fail(code::type_does_not_fit, s.target->place,
               fmt::format("FOR counts in an integer, not in {}", describe(*type)),
               type->is_real() ? "count in a DINT, and compute the value from it" : "");
        type = nullptr;
    }
    if (type && check_target(c, *s.target)) {
        if (check(c, s.value, type) && !narrows(c, s.value, *type)) coerce(c, s.value, *type);
        if (check(c, s.limit, type)) coerce(c, s.limit, type->plain());
        const Type& step = type->bits < 64 ? lint_type : type->plain();  // downwards, too
        if (s.step && check(c, s.step, &step)) coerce(c, s.step, step);
        note_endless(c, s, *type);
    }
    if (s.step && s.step->type && s.step->kind == E::constant && s.step->constant.integer == 0)
        c.fail(code::value_out_of_range, s.step->place, "a loop with step 0 does not end");
    ++c.loops;
    check(c, s.body);
    --c.loops;
    if (!behind) return;
    check(c, behind);
    slot = make_sequence(c, slot->place, {slot, behind});
}

}  // namespace

void check_body(Checking& c, Routine& routine) {
    c.routine = &routine;
    c.loops = 0;
    routine.body = beginnings(c, routine);
    const Block edges = edge_calls(c, routine);
    routine.body.insert(routine.body.end(), edges.begin(), edges.end());
    const Block chart = chart_statements(c, routine);
    routine.body.insert(routine.body.end(), chart.begin(), chart.end());
    routine.body.insert(routine.body.end(), routine.pou->body.begin(), routine.pou->body.end());
    check(c, routine.body);
    connect(c, routine);
    bring_up_to_date(c, routine);
    c.routine = nullptr;
}

/// What leaves a __TRY would leave its __FINALLY out.
void refuse_leaving(Checking& c, const Statement& s) {
    if (c.is_before_finally && (s.kind == S::return_ || s.kind == S::goto_ || c.loops == 0))
        c.fail(
            code::not_supported, s.place,
            fmt::format("{} out of a __TRY that has a __FINALLY is not supported", s.place.text()),
            "note it in a variable, and leave behind __ENDTRY");
}

/// __CATCH fills in a variable of `__SYSTEM.ExceptionCode`, or a number.
void check_caught(Checking& c, Expression*& variable) {
    const Type* type = check(c, variable);
    if (!type || !check_target(c, *variable)) return;
    const bool fits =
        type->kind == Kind::enumeration ||
        ((type->kind == Kind::integer || type->kind == Kind::bits) && type->bits >= 16);
    if (!fits)
        c.fail(code::type_does_not_fit, variable->place,
               fmt::format("__CATCH gives an exception's number, and not {}", describe(*type)),
               "declare 'exception : __SYSTEM.ExceptionCode;'");
}

void check_try(Checking& c, Statement& s) {
    const bool has_finally = !s.branches[1].body.empty();
    const int loops = c.loops;
    const bool was_before = c.is_before_finally;
    if (has_finally) {
        c.loops = 0;
        c.is_before_finally = true;
    }
    check(c, s.body);
    if (s.target) check_caught(c, s.target);
    check(c, s.branches[0].body);
    c.loops = loops;
    c.is_before_finally = was_before;
    check(c, s.branches[1].body);
}

void check(Checking& c, Statement*& slot) {
    if (rewrite(c, slot)) return;
    Statement& s = *slot;
    switch (s.kind) {
        case S::assign:
            return check_assignment(c, slot);
        case S::call:
            if (!runs_with_pins(c, slot)) check_call(c, s);
            return;
        case S::action:
            return check_action(c, slot);
        case S::if_:
            for (Branch& branch : s.branches) {
                check_condition(c, branch.condition, "IF");
                check(c, branch.body);
            }
            return check(c, s.body);
        case S::case_:
            return check_case(c, slot);
        case S::for_:
            return check_for(c, slot);
        case S::while_:
        case S::repeat:
            check_condition(c, s.value, s.kind == S::while_ ? "WHILE" : "UNTIL");
            ++c.loops;
            check(c, s.body);
            --c.loops;
            return;
        case S::try_:
            return check_try(c, s);
        case S::exit:
        case S::continue_:
            refuse_leaving(c, s);
            if (c.loops == 0 && !c.is_before_finally)
                c.fail(code::wrong_place, s.place,
                       fmt::format("{} stands outside of a loop", s.place.text()),
                       "RETURN leaves the block");
            return;
        case S::goto_:
            refuse_leaving(c, s);
            return check_goto(c, s);
        case S::return_:
            return refuse_leaving(c, s);
        case S::label:
            return;
        case S::sequence:
            return check(c, s.body);
    }
}

/// `gAxis := gAxis;`, with which programs of B&R name what they only hand over.
static bool is_same_object(const Expression& target, const Expression& value) {
    return target.kind == E::name && value.kind == E::name && target.variable &&
           target.variable == value.variable;
}

/// The axis links what a command of it has told it, so no other is that command: what has one is
/// not copied.
static bool has_command(Checking& c, const Type& type) {
    if (type.kind == Kind::array) return has_command(c, *type.element);
    if (type.kind == Kind::standard) return !type.is_object() && type.standard->add_links;
    if (type.kind != Kind::structure && type.kind != Kind::block) return false;
    const auto [known, is_new] = c.types_with_commands.try_emplace(&type, false);
    if (!is_new) return known->second;
    const auto has = [&](const Variable* part) {
        return part->space == Space::frame && part->type && has_command(c, *part->type);
    };
    const bool found = type.kind == Kind::block
                           ? std::ranges::any_of(all_variables(*type.routine), has)
                           : std::ranges::any_of(type.members, has);
    return c.types_with_commands[&type] = found;
}

bool refuse_copy_of_command(Checking& c, Place place, const Type& type) {
    if (!has_command(c, type)) return false;
    c.fail(code::cannot_be_assigned, place, "a command of an axis is not copied",
           "give what has it by VAR_IN_OUT, or assign its inputs one by one");
    return true;
}

/// An instance takes another one of its block; of one that derives from it what the block has. In
/// CODESYS that may be one of the standard's blocks.
static bool is_given_whole(Checking& c, Expression*& given, const Type& block) {
    const Type& type = *given->type;
    if (block.kind == Kind::standard)
        return same_type(block, type) && is_place(*given) && given->place.dialect().is_loose &&
               !block.is_object();
    if (same_type(block, type))
        return is_place(*given) || given->kind == E::call || given->kind == E::self;
    const bool derives = type.kind == Kind::block && is_a(*type.routine, *block.routine);
    return derives && become_base(c, given, block);
}

/// What the attributes 'no_assign' and 'no_assign_warning' say of its block.
static bool may_be_assigned(Checking& c, const Statement& s) {
    const Routine* block = s.target->type->routine;
    const Copying copying = block ? block->pou->copying : Copying::allowed;
    if (copying == Copying::allowed) return true;
    const std::string said = fmt::format("an instance of {} is assigned as a whole", block->name);
    const char* const help = "what it refers to would be that of both";
    if (copying == Copying::refused)
        return c.fail(code::cannot_be_assigned, s.place,
                      said + ", which the attribute 'no_assign' refuses", help);
    c.warn(code::cannot_be_assigned, s.place,
           said + ", of which the attribute 'no_assign_warning' warns", help);
    return true;
}

/// What an instance begins with is there before it is copied, and is not made anew in the copy.
static void begin_both(Checking& c, Statement*& s) {
    Block all;
    for (const Expression* instance : {s->target, s->value})
        if (instance->type->routine && is_place(*instance) && instance->kind != E::self)
            if (Statement* begin = begin_to_copy(c, *instance)) all.push_back(begin);
    if (all.empty()) return;
    all.push_back(s);
    s = make_sequence(c, s->place, std::move(all));
}

void check_assignment(Checking& c, Statement*& s) {
    if (s->op == Word::attempt_assign) return check_attempt(c, *s);
    if (rewrite_property(c, s) || rewrite_s5_reset(c, s)) return;
    if (s->op == Word::reference_assign) return check_reference_assignment(c, *s);
    const bool is_of_target = s->target->kind == E::deref, begins = c.beginnings.contains(s);
    const bool renews = c.renewals.contains(s);
    const Type* type = check(c, s->target);
    if (type && s->op != Word::reference_assign && rewrite_axis_interface(c, s)) return;
    s->target = keeper_of_pointer(s->target);
    if (type) type = s->target->type;
    if (type && type->is_open_array() && is_of_target)
        return void(c.fail(code::cannot_be_assigned, s->place,
                           "an array of any length is not assigned as a whole",
                           "assign its elements one by one"));
    const Variable* target = s->target->variable;
    if (type && type->is_open_array() && target && !target->is_parameter())
        return assign_open_array(c, s);
    if (s->op != Word::assign && type)
        s = make_assignment(
            c, s->place, s->target,
            make_binary(c, s->place, s->place, operator_of(s->op), s->target, s->value));
    check(c, s->value, type);
    const bool is_told = s->value->kind == E::list || !type;
    if (is_told || (!begins && !check_target(c, *s->target)) || !s->value->type) return;
    if (means_address(*s->target, *s->value)) return assign_address(c, *s);
    if (type->is_instance() && s->op == Word::assign && is_same_object(*s->target, *s->value))
        return void(s = make_sequence(c, s->place, {}));
    if (!renews && refuse_copy_of_command(c, s->place, *type)) return;
    if (type->is_instance() && s->op == Word::assign && is_given_whole(c, s->value, *type))
        return renews || may_be_assigned(c, *s) ? begin_both(c, s) : void();
    if (type->is_instance())
        return void(c.fail(code::cannot_be_assigned, s->place,
                           "an instance is not assigned as a whole",
                           "assign its inputs one by one"));
    if (coerce(c, s->value, *type) && is_cut_to_ms(*s->target, *s->value->type))
        convert(c, s->value, *type);
}

}  // namespace lineshaft::st
