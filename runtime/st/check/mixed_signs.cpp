#include "runtime/st/check/mixed_signs.hpp"

#include <algorithm>

#include "runtime/st/check/checking.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// Integers of which something is reckoned.
struct Reckoned {
    int width = 0;  ///< of the widest variable
    bool has_signed = false, has_unsigned = false;
};

/// MIN, SEL and their like, which give one of what they are given.
bool is_of_its_arguments(const Expression& e) {
    return e.kind == E::call && e.standard &&
           (e.standard->typing == Typing::common || e.standard->typing == Typing::chosen);
}

bool is_integer(const Expression& e) {
    return e.type->kind == Kind::integer || e.type->kind == Kind::any_integer;
}

/// False: there is something else in it. What was no integer counts as what it became.
bool add_reckoned(Reckoned& to, const Expression& e) {
    if (is_constant(e)) return true;
    if (e.kind == E::converted && is_integer(*e.operands[0]))
        return add_reckoned(to, *e.operands[0]);
    if (is_of_its_arguments(e)) {
        const auto first = e.arguments.begin() + (e.standard->typing == Typing::chosen);
        return std::all_of(first, e.arguments.end(),
                           [&](const Argument& a) { return add_reckoned(to, *a.value); });
    }
    if (e.kind == E::binary || (e.kind == E::unary && e.op != Word::not_))
        return add_reckoned(to, *e.operands[0]) &&
               (e.kind == E::unary || add_reckoned(to, *e.operands[1]));
    to.width = std::max<int>(to.width, e.type->bits);
    (e.type->is_signed ? to.has_signed : to.has_unsigned) = true;
    return e.type->kind == Kind::integer;
}

}  // namespace

bool narrows_mixed_signs(const Expression& e, const Type& from, const Type& to) {
    const bool are_integers = from.kind == Kind::integer && to.kind == Kind::integer;
    Reckoned all;
    const bool is_reckoned = e.kind == E::binary || is_of_its_arguments(e);
    return are_integers && !to.is_subrange && is_reckoned && add_reckoned(all, e) &&
           all.has_signed && all.has_unsigned && all.width <= to.bits;
}

const Type* met_type(const Type& given_a, const Type& given_b, const Place& place) {
    const Type &a = given_a.plain(), &b = given_b.plain();
    const int bits = std::max(a.bits, b.bits);
    const bool mixes_signs = a.kind == Kind::integer && b.kind == Kind::integer &&
                             a.is_signed != b.is_signed && bits >= 32;
    return mixes_signs && place.dialect().reckons_in_registers ? &integer_type(bits, true)
                                                               : common_type(a, b);
}

}  // namespace lineshaft::st
