#include "runtime/st/check/check.hpp"

#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/initial_values.hpp"
#include "runtime/st/check/order.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

Checked check(Tree& tree, const Catalog& catalog, Evaluate evaluate, Diagnostics& out,
              std::vector<NameUse>* uses) {
    Checking c{tree, catalog, evaluate, out};
    c.uses = uses;
    collect_names(c);
    resolve_bases(c);
    declare_globals(c);
    declare_routines(c);
    check_classes(c);
    check_initial_values(c);
    for (Routine& routine : c.checked.routines) check_body(c, routine);
    finish_image(c);
    order_routines(c);
    if (out.empty()) warn_of_unused(c);
    return std::move(c.checked);
}

}  // namespace lineshaft::st
