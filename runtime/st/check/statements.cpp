#include <algorithm>

#include "runtime/st/check/checker_class.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

using E = Expression::Kind;
using S = Statement::Kind;

bool leaves(const Statement& statement) {
    return statement.kind == Statement::Kind::return_ || statement.kind == Statement::Kind::exit ||
           statement.kind == Statement::Kind::continue_;
}

}  // namespace

void Checker::check_body(Routine& routine) {
    routine_ = &routine;
    loops_ = 0;
    call_edges(routine);
    check(const_cast<Pou*>(routine.pou)->body);
    routine_ = nullptr;
}

void Checker::check(Block& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
        check(*block[i]);
        if (leaves(*block[i]) && i + 1 < block.size()) {
            out_.warn("L0922", block[i + 1]->place.mark(), "this is never reached",
                      "the statement before it leaves");
        }
    }
}

/// The value of a standard function may be left, as that of any other.
void Checker::check_call(Statement& s) {
    if (s.value->type) return;
    const Type* type = check_call(*s.value, true, nullptr);
    if (!type || !s.value->standard) return;
    s.value->type = type;
    make_concrete(s.value, *type);
}

void Checker::check(Statement& s) {
    if (rewrite(s)) return;
    switch (s.kind) {
        case S::assign:
            return check_assignment(s);
        case S::call:
            return check_call(s);
        case S::if_:
            for (Branch& branch : s.branches) {
                check_condition(branch.condition, "IF");
                check(branch.body);
            }
            return check(s.body);
        case S::case_:
            return check_case(s);
        case S::for_:
            return check_for(s);
        case S::while_:
        case S::repeat:
            check_condition(s.value, s.kind == S::while_ ? "WHILE" : "UNTIL");
            ++loops_;
            check(s.body);
            --loops_;
            return;
        case S::exit:
        case S::continue_:
            if (loops_ == 0)
                fail("L0914", s.place, fmt::format("{} stands outside of a loop", s.place.text()),
                     "RETURN leaves the block");
            return;
        case S::return_:
            return;
    }
}

void Checker::check_condition(Expression*& condition, std::string_view of) {
    const Type* type = check(*condition, &bool_type);
    if (!type || type->kind == Type::Kind::boolean) return;
    fail("L0905", condition->place,
         fmt::format("the condition of {} is a BOOL, not {}", of, describe(*type)),
         type->is_number() || type->is_bits() ? "compare it, as in 'x <> 0'" : "");
}

void Checker::check_assignment(Statement& s) {
    const Type* type = check(*s.target);
    if (s.op != Word::assign && type) {
        Expression* sum = make(Expression::Kind::binary, *s.target);
        sum->op = s.op == Word::plus_assign    ? Word::plus
                  : s.op == Word::minus_assign ? Word::minus
                  : s.op == Word::times_assign ? Word::times
                                               : Word::divided;
        sum->place = s.place;
        sum->token.place = s.place;
        sum->operands[0] = s.target;
        sum->operands[1] = s.value;
        s.value = sum;
    }
    if (s.value->kind == Expression::Kind::list) {
        check(*s.value);
        return;
    }
    check(*s.value, type);
    if (!type || !check_target(*s.target) || !s.value->type) return;
    if (type->is_instance()) {
        fail("L0910", s.place, "an instance is not assigned as a whole",
             "assign its inputs one by one");
        return;
    }
    coerce(s.value, *type);
}

bool Checker::check_target(Expression& target, std::string_view how) {
    const auto refuse = [&](std::string what, std::string help) {
        fail("L0910", target.place, fmt::format("{} cannot be {}", what, how), std::move(help));
        return false;
    };
    if (target.kind == E::constant && target.variable)
        return refuse(fmt::format("the constant '{}'", target.variable->text),
                      "declare it in VAR, without CONSTANT");
    if (target.kind == E::bit && target.operands[0]->is_character())
        return refuse("a bit of a character", "assign the character");
    if (target.kind == E::index || target.kind == E::bit) {
        return !target.operands[0]->type || check_target(*target.operands[0], how);
    }
    if (target.kind != E::name && target.kind != E::member)
        return refuse("a value", "a variable, an element or a member stands left of ':='");
    const Variable* variable = target.variable;
    if (!variable) return false;
    const bool own = target.kind == E::name;
    const bool of_instance = target.kind == E::member && target.operands[0]->type &&
                             target.operands[0]->type->is_instance();
    if (variable->constant && !(is_in_test() && of_instance))
        return refuse(fmt::format("the constant '{}'", variable->text), "remove CONSTANT");
    const bool is_copy = variable->of && (variable->of->kind == PouKind::function ||
                                          variable->of->kind == PouKind::method);
    if (own && variable->section == Section::input && !is_copy)
        return refuse(fmt::format("the input '{}'", variable->text),
                      "copy it to a variable of VAR, or make it a VAR_IN_OUT");
    if (own) return true;
    const Type* of = target.operands[0]->type;
    const bool is_named = target.operands[0]->variable || target.operands[0]->kind == E::converted;
    const bool is_siemens_own =
        of && of->kind == Kind::block && is_scl(target) &&
        (variable->section == Section::local || variable->section == Section::output);
    if (of && of->is_instance() && variable->section != Section::input && !is_in_test() &&
        is_named && !is_siemens_own)
        return refuse(fmt::format("'{}' of {}", variable->text, of->name),
                      "only inputs of an instance are set from outside");
    return of && of->is_instance() ? true : check_target(*target.operands[0], how);
}

void Checker::check_case(Statement& s) {
    const Type* type = check(*s.value);
    const bool fits = type && (type->kind == Type::Kind::integer || type->is_bits() ||
                               type->kind == Type::Kind::enumeration);
    if (type && !fits)
        fail("L0905", s.value->place,
             fmt::format("CASE selects by a whole number or an enumeration, not {}",
                         describe(*type)),
             "write IF and ELSIF");
    std::vector<std::pair<Wide, Wide>> seen;
    for (Branch& branch : s.branches) {
        for (auto& [from, to] : branch.labels) {
            if (!fits) break;
            const auto lower = check_whole(from, *type);
            const auto upper = to ? check_whole(to, *type) : lower;
            if (!lower || !upper) continue;
            if (*lower > *upper)
                fail("L0908", from->place.to(to->place), "this range has no value",
                     "the smaller one stands first");
            const auto meets = [&, low = *lower, high = *upper](const auto& other) {
                return low <= other.second && other.first <= high;
            };
            if (std::ranges::any_of(seen, meets))
                fail("L0908", from->place,
                     fmt::format("'{}' stands twice in this CASE", from->place.text()),
                     "only the first one would count");
            seen.emplace_back(*lower, *upper);
        }
        check(branch.body);
    }
    check(s.body);
}

void Checker::check_for(Statement& s) {
    const Type* type = check(*s.target);
    if (type && type->kind != Type::Kind::integer && type->kind != Type::Kind::bits) {
        fail("L0905", s.target->place,
             fmt::format("FOR counts in an integer, not in {}", describe(*type)),
             type->is_real() ? "count in a DINT, and compute the value from it" : "");
        type = nullptr;
    }
    if (type && check_target(*s.target))
        for (Expression** part : {&s.value, &s.limit, &s.step})
            if (*part && check(**part, type))
                coerce(*part, part == &s.value ? *type : type->plain());
    if (s.step && s.step->type && s.step->kind == Expression::Kind::constant &&
        s.step->constant.integer == 0)
        fail("L0908", s.step->place, "a loop with step 0 does not end");
    ++loops_;
    check(s.body);
    --loops_;
}

}  // namespace lineshaft::st
