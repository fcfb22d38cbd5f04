#pragma once

#include "runtime/names/net.hpp"

namespace lineshaft {

/// Refuses a part of a variable of Structured Text of which not all parts are known, see
/// st::shortened_variables. False: it is none.
bool refuse_left_out(const Reader& read, const Node& node, const Instance& block,
                     std::string_view port);

}  // namespace lineshaft
