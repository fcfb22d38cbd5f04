#include <algorithm>
#include <iterator>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

Expression* argument_of(const Expression& call, std::string_view name) {
    const Argument* found = find_called(call.arguments, name, &Argument::name);
    return found ? found->value : nullptr;
}

namespace {

/// SRC or DEST: an array, or one value.
struct Side {
    Expression* whole = nullptr;
    Variable* index = nullptr;  ///< from 0 on, of the first element
    Expression* lower = nullptr;
    Expression* count = nullptr;
    bool is_array = false;
};

/// A call of MOVE_BLK_VARIANT, and the variables that its numbers are kept in.
class VariantMove {
  public:
    VariantMove(Checking& c, const Expression& call) : c_(c), call_(call) {}

    bool read() {
        for (const std::string_view name : {"SRC", "COUNT", "SRC_INDEX", "DEST_INDEX", "DEST"})
            if (!argument_of(call_, name))
                return c_.fail(code::wrong_arguments, call_.place,
                               fmt::format("there is nothing at {} of MOVE_BLK_VARIANT", name));
        const auto from = side("SRC", "SRC_INDEX", "%moved_from"),
                   to = side("DEST", "DEST_INDEX", "%moved_to");
        count_ = keep("COUNT", "%moved_count");
        if (!from || !to || !count_) return false;
        from_ = *from, to_ = *to;
        return true;
    }

    /// `count := COUNT; from := SRC_INDEX; to := DEST_INDEX;`
    Block begin() const { return kept_; }

    /// With what it gives then, in the order in which a controller finds them.
    std::vector<std::pair<Expression*, std::int64_t>> refusals() const {
        Expression* zero = number(0);
        return {{is(use(*count_), Word::less, zero), 0x8281},
                {is_outside(from_), 0x8382},
                {ends_outside(from_), 0x8383},
                {is_outside(to_), 0x8482},
                {ends_outside(to_), 0x8483}};
    }

    Statement* move() const {
        Expression *from = element(from_), *to = element(to_);
        if (!from_.is_array || !to_.is_array) return make_assignment(c_, call_.place, to, from);
        return make_call_statement(
            c_, make_call(c_, call_, make_name(c_, call_, "MOVE_BLK"),
                          {{.value = from}, {.value = use(*count_)}, {.value = to}}));
    }

  private:
    Expression* number(Wide value) const {
        return make_constant(c_, call_, lint_type, {.integer = value});
    }
    Expression* use(Variable& variable) const { return make_use(c_, call_, variable); }
    Expression* is(Expression* a, Word op, Expression* b) const {
        return make_binary(c_, call_.place, call_.place, op, a, b);
    }
    Expression* is_outside(const Side& of) const {
        return is(is(use(*of.index), Word::less, number(0)), Word::or_,
                  is(use(*of.index), Word::greater_or_equal, of.count));
    }
    Expression* ends_outside(const Side& of) const {
        return is(is(use(*of.index), Word::plus, use(*count_)), Word::greater, of.count);
    }
    Expression* element(const Side& of) const {
        if (!of.is_array) return of.whole;
        Expression* made = make(c_, E::index, call_);
        made->operands[0] = of.whole;
        made->arguments.push_back({.value = is(of.lower, Word::plus, use(*of.index))});
        return made;
    }

    /// Null: it is no whole number, which was told.
    Variable* keep(std::string_view name, std::string_view variable) {
        Expression* value = argument_of(call_, name);
        if (!check(c_, value)) return nullptr;
        if (!value->type->is_integer() && !value->type->is_bits())
            return c_.fail(code::type_does_not_fit, value->place,
                           fmt::format("{} is a whole number", name));
        become_lint(c_, value);
        Variable& kept = counter(c_, variable);
        kept_.push_back(make_assignment(c_, call_.place, use(kept), value));
        return &kept;
    }

    std::optional<Side> side(std::string_view name, std::string_view index,
                             std::string_view variable) {
        Side made{.whole = argument_of(call_, name)};
        Expression* array = made.whole;
        const Type* type = check(c_, array);
        made.index = type ? keep(index, variable) : nullptr;
        if (!made.index) return {};
        if (const auto bounds = bounds_of_array(c_, made.whole)) {
            made.lower = bounds->lower;
            made.count = is(is(bounds->upper, Word::minus, bounds->lower), Word::plus, number(1));
            made.is_array = true;
        } else if (type->kind == Kind::array || type->is_open_array()) {
            c_.fail(code::type_does_not_fit, array->place,
                    fmt::format("MOVE_BLK_VARIANT takes arrays of one dimension, not {}",
                                describe(*type)));
            return {};
        } else {
            made.count = number(1);
        }
        return made;
    }

    Checking& c_;
    const Expression& call_;
    Side from_ = {}, to_ = {};
    Variable* count_ = nullptr;
    Block kept_ = {};
};

/// The number of an error for what it is assigned to: RET_VAL is an INT.
Expression* make_code(Checking& c, const Expression& like, const Type& to, std::int64_t code) {
    const bool is_pattern = to.is_bits() || !to.is_signed;
    const std::int64_t sign = code == 0 || is_pattern ? 0 : 0x10000;
    return make_constant(c, like, is_pattern ? any_bits_type : any_integer_type,
                         {.integer = code - sign});
}

}  // namespace

void rewrite_variant_move(Checking& c, Statement*& s) {
    const Expression call = *s->value;
    VariantMove variant(c, call);
    Expression* target = s->kind == S::assign ? s->target : nullptr;
    const Type* type = target ? check(c, target) : nullptr;
    if (!variant.read() || (target && !type)) return;
    const auto give = [&](std::int64_t code) {
        Block made;
        if (target)
            made.push_back(
                make_assignment(c, call.place, s->target, make_code(c, call, *type, code)));
        return made;
    };
    Block rest{variant.move()};
    std::ranges::move(give(0), std::back_inserter(rest));
    const auto refusals = variant.refusals();
    for (auto refusal = refusals.rbegin(); refusal != refusals.rend(); ++refusal)
        rest = {make_if(c, call.place, refusal->first, give(refusal->second), std::move(rest))};
    Block made = variant.begin();
    std::ranges::move(rest, std::back_inserter(made));
    s = make_sequence(c, s->place, std::move(made));
    check(c, s);
}

Expression* moves_variant(Checking& c, const Expression& call, Block& before) {
    VariantMove variant(c, call);
    if (!variant.read()) return nullptr;
    Expression* refused = nullptr;
    for (const auto& [condition, code] : variant.refusals())
        refused = refused ? make_binary(c, call.place, call.place, Word::or_, refused, condition)
                          : condition;
    std::ranges::move(variant.begin(), std::back_inserter(before));
    return make_not(c, refused);
}

}  // namespace lineshaft::st
