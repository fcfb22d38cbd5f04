#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// What the row of that name says; a conversion has none.
Eno eno_of(std::string_view name) {
    if (const StandardFunction* standard = find_standard_function(name)) return standard->eno;
    return upper(name).find("_TO_") != name.npos ? Eno::converted : Eno::always;
}

/// A call, and what its ENO is made of.
class EnableOutput {
  public:
    EnableOutput(Checking& c, const Expression& call, const std::vector<Argument>& given)
        : c_(c),
          call_(call),
          given_(given),
          function_(find_standard_function(call.operands[0]->token.text)),
          eno_(eno_of(call.operands[0]->token.text)) {}

    /// Null: nothing that the function does can fail.
    Expression* condition(const Type* expected) {
        if (eno_ == Eno::limit) return is(at("MN", 0), Word::less_or_equal, at("MX", 2));
        if (eno_ == Eno::chosen) return is_chosen();
        Expression* value = result();
        const Type* type = check(c_, value, expected);
        if (!type) return nullptr;
        if (eno_ == Eno::scaled) return scaled(*type);
        if (eno_ == Eno::arithmetic) return calculated(*type);
        if (type->is_real()) return is_valid(result());
        const bool is_converted = eno_ == Eno::converted && given_.size() == 1;
        return type->is_integer() && is_converted ? converted(*type) : nullptr;
    }

  private:
    /// Also of one argument, which may have any name.
    Expression* at(std::string_view name, std::size_t place) const {
        const Argument* found = find_called(given_, name, &Argument::name);
        if (!found && place < given_.size()) found = &given_[place];
        return found ? found->value : nullptr;
    }
    Expression* result() const { return make_with(c_, call_, given_); }
    Expression* number(double value) const {
        return make_constant(c_, call_, lreal_type, {.real = value});
    }
    Expression* of(std::string_view function, Expression* value) const {
        const Expression& name = *call_.operands[0];
        return make_call(c_, call_, make_name(c_, name, function), {{.value = value}});
    }
    /// A literal stays as it is: it takes its type from the call.
    Expression* real(Expression* value) const {
        if (!value) return nullptr;
        const Type* type = value->type;
        const bool is_number = type && is_constant(*value) &&
                               (type->is_any() || type->is_integer() || type->is_real());
        return is_number ? number(as_real(*value)) : of("TO_LREAL", value);
    }
    Expression* is(Expression* a, Word sign, Expression* b) const {
        return a && b ? make_binary(c_, call_.place, call_.place, sign, a, b) : nullptr;
    }
    Expression* both(Expression* a, Expression* b) const { return is(a, Word::and_, b); }
    Expression* is_valid(Expression* value) const { return of("IS_VALID", value); }

    /// K names one of the inputs, or outputs, and not the one beside them.
    Expression* is_chosen() const {
        const auto is_other = [&](const Argument& a) {
            return same_name(a.name.text, "k") || same_name(a.name.text, "in") ||
                   same_name(a.name.text, "inelse") || same_name(a.name.text, "outelse");
        };
        const auto others = std::ranges::count_if(given_, is_other);
        const bool is_named = find_called(given_, "k", &Argument::name) != nullptr;
        const auto count = static_cast<double>(given_.size()) -
                           static_cast<double>(is_named ? others : others + 1);
        Expression* k = real(at("K", 0));
        return both(is(number(0), Word::less_or_equal, k), is(k, Word::less, number(count)));
    }

    static double least(const Type& type) {
        return type.is_signed ? -std::ldexp(1.0, type.bits - 1) : 0.0;
    }
    static double greatest(const Type& type) {  // of 64 bits the number behind it
        return std::ldexp(1.0, type.is_signed ? type.bits - 1 : type.bits) -
               (type.bits < 64 ? 1.0 : 0.0);
    }

    /// A number of the type is near the one that is calculated without its bounds: what is beyond
    /// them comes out by a multiple of their distance away. Division by 0 is none.
    Expression* calculated(const Type& type) const {
        Expression* whole = nullptr;
        if (type.is_real()) {
            whole = is_valid(result());
        } else if (type.is_integer()) {
            Expression* exact = real(at("IN1", 0));
            for (std::size_t i = 1; i < given_.size(); ++i)
                exact = is(exact, function_->word,
                           real(given_.size() == 2 ? at("IN2", 1) : given_[i].value));
            Expression* away = of("ABS", is(exact, Word::minus, real(result())));
            whole = is(away, Word::less, number(std::ldexp(1.0, type.bits - 1)));
        }
        if (function_->word != Word::divided || !whole) return whole;
        return is(is(at("IN2", 1), Word::equal, make_constant(c_, call_, any_integer_type, {})),
                  Word::or_, whole);
    }

    Expression* scaled(const Type& type) const {
        Expression *min = at("MIN", 0), *value = at("VALUE", 1), *max = at("MAX", 2);
        if (!min || !value || !max) return nullptr;
        Expression* made = is(min, Word::less, max);
        if (type.is_real()) return both(made, is_valid(result()));
        Expression* range = is(real(max), Word::minus, real(min));
        Expression* exact = is(is(real(value), Word::times, range), Word::plus, real(min));
        return both(made, is_within(exact, least(type) - 0.5, greatest(type) + 0.5));
    }

    Expression* is_within(Expression* value, double from, double to) const {
        return both(is(number(from), Word::less_or_equal, value),
                    is(value, Word::less, number(to)));
    }

    bool rounds_by(Op op) const { return function_ && function_->op == op; }

    /// A whole number of another, or of a real one.
    Expression* converted(const Type& type) const {
        Expression* given = given_[0].value;
        const Type* from = given->type;
        if (!from || from->is_any()) return nullptr;
        const double low = least(type), high = greatest(type);
        const bool is_long = type.bits == 64;
        if (from->is_integer()) {
            if (low <= least(*from) && greatest(*from) <= high) return nullptr;
            return is_within(real(given), low, is_long ? high : high + 1.0);
        }
        if (!from->is_real()) return nullptr;
        if (is_long) return is_within(real(given), low, high);
        if (rounds_by(Op::floor)) return is_within(real(given), low, high + 1.0);
        Expression* above = is(number(low - 1.0), Word::less, real(given));
        if (rounds_by(Op::ceil))
            return both(above, is(real(given), Word::less_or_equal, number(high)));
        if (rounds_by(Op::truncate))
            return both(above, is(real(given), Word::less, number(high + 1.0)));
        return is_within(real(given), low - 0.5, high + 0.5);
    }

    Checking& c_;
    const Expression& call_;
    const std::vector<Argument>& given_;
    const StandardFunction* function_;  ///< null of a conversion
    Eno eno_;
};

}  // namespace

Expression* enable_output(Checking& c, const Statement& s, std::vector<Argument>& given,
                          Block& before) {
    const Expression& call = *s.value;
    const Expression& callee = *call.operands[0];
    const bool is_one = s.place.dialect().has_s7_instructions && callee.kind == E::name;
    const Eno eno = is_one ? eno_of(callee.token.text) : Eno::always;
    if (eno == Eno::always) return nullptr;
    const bool moves = eno == Eno::elements || eno == Eno::bits;
    for (Argument& each : given) {
        if (each.is_output || moves) continue;
        const bool is_call = has_call(*each.value);
        const Type* type = check(c, each.value);
        if (!is_call || !type || type->is_any()) continue;
        Variable& kept = c.make_variable(*c.routine, c.routine->pou->name, "%given", type);
        kept.section = Section::temp;
        before.push_back(make_assignment(c, s.place, make_use(c, call, kept), each.value));
        each.value = make_use(c, call, kept);
    }
    if (eno == Eno::bits) return has_bit_block(c, *make_with(c, call, given));
    if (eno == Eno::elements) {
        const Expression& moved = *make_with(c, call, given);
        const auto becomes = find_standard_function(callee.token.text)->rewriting;
        return stays_within(c, call, becomes == Rewriting::fill_block, argument_of(moved, "IN"),
                            argument_of(moved, "COUNT"), argument_of(moved, "OUT"));
    }
    Expression* target = s.kind == S::assign ? s.target : nullptr;
    const Type* expected = target ? check(c, target) : nullptr;
    return EnableOutput(c, call, given).condition(expected);
}

}  // namespace lineshaft::st
