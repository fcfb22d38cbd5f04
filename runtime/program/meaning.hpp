#pragma once

#include <string>

#include "runtime/program/program.hpp"

namespace lineshaft {

/// Hashes (see text_hash) of what a program means: comments, the order of keys (but of tasks and
/// blocks, whose order is that of work), the title, and how a quantity is spelled (10 mm/s, 1 cm/s)
/// do not count. What a replayed file holds is not in them.
struct Meaning {
    std::string in_force;  ///< with the parameters in force, the controller and the forces
    std::string form;      ///< of the file alone, whatever its parameters, seed, controller, forces
    std::string controller;  ///< of the controller's file; empty: there is none
};

Meaning meaning_of(const Program& program);

}  // namespace lineshaft
