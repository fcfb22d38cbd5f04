#pragma once

#include <optional>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// That a name of a user's source, at a place, means what is declared at another, or the same. One
/// of these three is said, of a variable its type too.
struct NameUse {
    Place at = {};        ///< the name as it is written
    Place declared = {};  ///< likewise; of the catalogue nowhere
    const Variable* variable = nullptr;
    const Routine* routine = nullptr;
    const Type* type = nullptr;
    std::optional<std::size_t> value = {};  ///< which of the type's, if that is meant
};

}  // namespace lineshaft::st
