#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

bool is_alike(const Type& a, const Type& b) {
    if (same_type(a, b)) return true;
    if (a.kind != b.kind) return false;
    if (a.kind == Kind::array)
        return a.element && b.element && a.count() == b.count() && is_alike(*a.element, *b.element);
    const bool are_structures = a.kind == Kind::structure && (a.is_unnamed || b.is_unnamed);
    return are_structures &&
           std::ranges::equal(a.members, b.members, [](const Variable* x, const Variable* y) {
               return x->type && y->type && is_alike(*x->type, *y->type);
           });
}

}  // namespace

bool has_same_form(Checking& c, const Place& at, const Type& from, const Type& to) {
    const bool may_be = at.source && at.dialect().assigns_same_forms;
    if (!may_be || !is_alike(from, to)) return false;
    if (from.kind == Kind::array && from.lower != to.lower)
        c.warn(code::type_does_not_fit, at,
               fmt::format("{} goes to {}, element by element from the first on", describe(from),
                           describe(to)),
               "declare both with the same bounds");
    return true;
}

}  // namespace lineshaft::st
