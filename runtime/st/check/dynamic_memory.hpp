#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `__NEW` or `__DELETE`, as users write it.
bool is_of_dynamic_memory(std::string_view function);
/// A call of `__NEW`.
bool is_new(const Expression& value);
/// `p := __NEW(Type, count);` of CODESYS becomes statements: what it makes are elements of a
/// global array of the type, of which `pool_size` are had.
bool rewrite_new(Checking& c, Statement*& s);
/// `__DELETE(p);`
bool rewrite_delete(Checking& c, Statement*& s);
/// `b.FB_init(TRUE, FALSE);` of a block that declares none: it begins anew, as its type says.
bool rewrite_init(Checking& c, Statement*& s);
/// When all that is made is known.
void write_deletions(Checking& c);

}  // namespace lineshaft::st
