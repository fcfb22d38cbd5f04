#include "runtime/st/check/expressions.hpp"

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

const Type* check_kind(Checking& c, Expression*& e, const Type* expected) {
    switch (e->kind) {
        case E::constant:
            return check_literal(c, e);
        case E::name:
            return check_name(c, e, expected);
        case E::member:
            return check_member(c, e);
        case E::index:
            return check_index(c, e);
        case E::bit:
            return check_bit(c, e);
        case E::call:
            return check_call(c, e, false, expected);
        case E::unary:
            return check_unary(c, e, expected);
        case E::binary:
            return check_binary(c, e, expected);
        case E::typed:
            return check_typed(c, e);
        case E::deref:
            return check_target_of(c, e);
        case E::list:
        case E::repeated:
            return c.fail(
                code::type_does_not_fit, e->place, "a list of values stands in a declaration only",
                "declare a variable that begins with it, or assign the elements one by one");
        default:  // what the checker has put in has its type
            return nullptr;
    }
}

}  // namespace

const Type* check(Checking& c, Expression*& e, const Type* expected) {
    const bool is_known = e->type;
    const Type* type = is_known ? e->type : check_kind(c, e, expected);
    e->type = type;
    if (!type && c.out.count() == 0 && c.foreign.empty())
        c.fail(code::type_does_not_fit, e->place, "what this is was not found out",
               "write it in another way, and report it: this is no mistake of the program");
    if (!type || !type->is_alias()) return type;
    // What is known is what a reference is made of, or a variable that hangs in two places.
    return is_known && !is_place(*e) ? type : take_target(c, e);
}

}  // namespace lineshaft::st
