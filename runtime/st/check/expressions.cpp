#include "runtime/st/check/expressions.hpp"

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/literals.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/operators.hpp"
#include "runtime/st/check/places.hpp"
#include "runtime/st/check/references.hpp"

namespace lineshaft::st {

const Type* check(Checking& c, Expression*& e, const Type* expected) {
    if (e->type) return e->type;
    const Type* type = nullptr;
    switch (e->kind) {
        case E::constant:
            type = check_literal(c, e);
            break;
        case E::name:
            type = check_name(c, e, expected);
            break;
        case E::member:
            type = check_member(c, e);
            break;
        case E::index:
            type = check_index(c, e);
            break;
        case E::bit:
            type = check_bit(c, e);
            break;
        case E::call:
            type = check_call(c, e, false, expected);
            break;
        case E::unary:
            type = check_unary(c, e, expected);
            break;
        case E::binary:
            type = check_binary(c, e, expected);
            break;
        case E::typed:
            type = check_typed(c, e);
            break;
        case E::list:
        case E::repeated:
            return c.fail(
                code::type_does_not_fit, e->place, "a list of values stands in a declaration only",
                "declare a variable that begins with it, or assign the elements one by one");
        case E::deref:
            type = check_target_of(c, *e);
            break;
        case E::refer:
        case E::self:
        case E::converted:
            type = e->type;
    }
    e->type = type;
    return type && type->is_alias() ? take_target(c, e) : type;
}

}  // namespace lineshaft::st
