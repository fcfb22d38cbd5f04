#pragma once

#include "runtime/program/substitution.hpp"

namespace lineshaft {

/// `left: {use: station, set: {speed: 10 mm/s}}` in `blocks:`.
struct UsePlan {
    Node use;
    std::vector<std::pair<Node, Node>> set = {};
};

/// Puts in place of each such entry the blocks of its template, named `left_gate`: where they name
/// each other they get these names, and `$speed` is what `set`, else the template, else the program
/// says.
void expand_templates(Node& root, Substitution& substitution, const Reader& read);

}  // namespace lineshaft
