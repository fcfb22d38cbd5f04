#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

bool is_number_or_bits(const Type& type) {
    return (type.kind == Kind::integer || type.kind == Kind::bits) && !type.is_character;
}

/// A number, a bit string, or what counts ms, ns or days as one. A DT has digits.
bool is_count(const Type& type) {
    return is_number_or_bits(type) ||
           (type.is_time() && (type.kind != Kind::moment || type.counts_ns));
}

bool has_clock_and_date(const Type& a, const Type& b) {
    return a.kind == Kind::clock && b.kind == Kind::moment;
}

int width_of(const Type& type, const Dialect& dialect) {
    return static_cast<int>(packed_bits(type, dialect));
}

/// The lowest bits of `e` become one of `to`, those that it does not have 0.
void move_bits(Checking& c, Expression*& e, const Type& to) {
    if (!is_count(to) || to.is_subrange) return;
    if (e->type->is_any()) {
        if (!to.is_time() || e->type->is_real() || !coerce(c, e, lint_type)) return;
    }
    const Type& from = e->type->plain();
    const Dialect& dialect = e->place.dialect();
    if (!is_count(from) || same_type(from, to) || (from.is_time() && to.is_time())) return;
    const int given = width_of(from, dialect), wanted = width_of(to, dialect);
    const bool is_extended = from.kind == Kind::integer && from.is_signed && given < wanted;
    const bool is_assigned =
        is_number_or_bits(from) && is_number_or_bits(to) && !is_constant(*e) && !is_extended;
    if (is_assigned) return;
    convert(c, e, integer_type(given, false));
    if (to.is_time()) convert(c, e, integer_type(wanted, to.kind == Kind::time));
    convert(c, e, to);
}

}  // namespace

bool is_pattern_of_time(const Type& from, const Type& to, const Dialect& dialect) {
    return (from.is_time() || to.is_time()) && is_count(from) && is_count(to) &&
           width_of(from, dialect) == width_of(to, dialect) && !has_clock_and_date(from, to) &&
           !has_clock_and_date(to, from);
}

std::optional<const Type*> check_move(Checking& c, Expression*& e, const Type* expected) {
    const bool is_move = e->place.dialect().has_s7_instructions && e->arguments.size() == 1 &&
                         same_name(e->operands[0]->token.text, "move");
    if (!is_move) return {};
    e = e->arguments[0].value;
    if (check(c, e, expected) && expected) move_bits(c, e, *expected);
    return e->type;
}

}  // namespace lineshaft::st
