#pragma once

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// On an S7 a call copies what is elementary, and back when it has run.
inline bool is_copied_in_out(const Variable& variable) {
    return variable.section == Section::in_out && variable.space == Space::frame && variable.type &&
           !variable.type->is_handle();
}

/// Whether an FB's instance keeps that copy from call to call.
inline bool is_kept_in_out(const Variable& variable) {
    return is_copied_in_out(variable) && variable.of->kind == PouKind::function_block;
}

}  // namespace lineshaft::st
