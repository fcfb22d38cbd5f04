#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

/// A call, and what its ENO is made of.
class EnableOutput {
  public:
    EnableOutput(Checking& c, const Expression& call, const std::vector<Argument>& given)
        : c_(c), call_(call), given_(given), name_(upper(call.operands[0]->token.text)) {}

    /// Null: nothing that the function does can fail.
    Expression* condition(const Type* expected) {
        if (name_ == "LIMIT") return is(at("MN", 0), Word::less_or_equal, at("MX", 2));
        if (name_ == "MUX" || name_ == "DEMUX") return is_chosen();
        Expression* value = result();
        const Type* type = check(c_, value, expected);
        if (!type) return nullptr;
        if (name_ == "NORM_X" || name_ == "SCALE_X") return scaled(*type);
        if (is_arithmetic()) return calculated(*type);
        if (type->is_real()) return is_valid(result());
        return type->is_integer() && given_.size() == 1 ? converted(*type) : nullptr;
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

    bool is_arithmetic() const {
        return name_ == "ADD" || name_ == "SUB" || name_ == "MUL" || name_ == "DIV";
    }

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
            const Word sign = name_ == "ADD"   ? Word::plus
                              : name_ == "SUB" ? Word::minus
                              : name_ == "MUL" ? Word::times
                                               : Word::divided;
            Expression* exact = real(at("IN1", 0));
            for (std::size_t i = 1; i < given_.size(); ++i)
                exact = is(exact, sign, real(given_.size() == 2 ? at("IN2", 1) : given_[i].value));
            Expression* away = of("ABS", is(exact, Word::minus, real(result())));
            whole = is(away, Word::less, number(std::ldexp(1.0, type.bits - 1)));
        }
        if (name_ != "DIV" || !whole) return whole;
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

    /// A whole number of another, or of a real one.
    Expression* converted(const Type& type) const {
        Expression* given = given_[0].value;
        const Type* from = given->type;
        if (!from || name_ == "ABS" || from->is_any()) return nullptr;
        const double low = least(type), high = greatest(type);
        const bool is_long = type.bits == 64;
        if (from->is_integer()) {
            if (low <= least(*from) && greatest(*from) <= high) return nullptr;
            return is_within(real(given), low, is_long ? high : high + 1.0);
        }
        if (!from->is_real()) return nullptr;
        if (is_long) return is_within(real(given), low, high);
        if (name_ == "FLOOR") return is_within(real(given), low, high + 1.0);
        Expression* above = is(number(low - 1.0), Word::less, real(given));
        if (name_ == "CEIL") return both(above, is(real(given), Word::less_or_equal, number(high)));
        if (name_ == "TRUNC") return both(above, is(real(given), Word::less, number(high + 1.0)));
        return is_within(real(given), low - 0.5, high + 0.5);
    }

    Checking& c_;
    const Expression& call_;
    const std::vector<Argument>& given_;
    std::string name_;
};

bool can_fail(std::string_view name) {
    static constexpr std::string_view all[] = {
        "LIMIT",    "MUX",       "DEMUX",    "NORM_X",    "SCALE_X",     "ADD",       "SUB",
        "MUL",      "DIV",       "EXPT",     "SQR",       "SQRT",        "LN",        "EXP",
        "SIN",      "COS",       "TAN",      "ASIN",      "ACOS",        "ATAN",      "FRAC",
        "ROUND",    "CEIL",      "FLOOR",    "TRUNC",     "ABS",         "MIN",       "MAX",
        "MOVE_BLK", "UMOVE_BLK", "FILL_BLK", "UFILL_BLK", "SCATTER_BLK", "GATHER_BLK"};
    const auto has_name = [&](std::string_view one) { return same_name(one, name); };
    return std::ranges::any_of(all, has_name) || upper(name).find("_TO_") != name.npos;
}

}  // namespace

Expression* enable_output(Checking& c, const Statement& s, std::vector<Argument>& given,
                          Block& before) {
    const Expression& call = *s.value;
    const Expression& callee = *call.operands[0];
    const bool is_one = s.place.dialect().vendor == Vendor::siemens && callee.kind == E::name &&
                        can_fail(callee.token.text);
    if (!is_one) return nullptr;
    for (Argument& each : given) {
        if (each.is_output || callee.token.text.ends_with("_BLK")) continue;
        const bool is_call = has_call(*each.value);
        const Type* type = check(c, each.value);
        if (!is_call || !type || type->is_any()) continue;
        Variable& kept = c.make_variable(*c.routine, c.routine->pou->name, "%given", type);
        kept.section = Section::temp;
        before.push_back(make_assignment(c, s.place, make_use(c, call, kept), each.value));
        each.value = make_use(c, call, kept);
    }
    const std::string name = upper(callee.token.text);
    if (name == "SCATTER_BLK" || name == "GATHER_BLK")
        return has_bit_block(c, *make_with(c, call, given));
    if (name.ends_with("_BLK")) {
        const Expression& moved = *make_with(c, call, given);
        return stays_within(c, call, name, argument_of(moved, "IN"), argument_of(moved, "COUNT"),
                            argument_of(moved, "OUT"));
    }
    Expression* target = s.kind == S::assign ? s.target : nullptr;
    const Type* expected = target ? check(c, target) : nullptr;
    return EnableOutput(c, call, given).condition(expected);
}

}  // namespace lineshaft::st
