#pragma once

#include "runtime/program/form.hpp"

namespace lineshaft {

inline constexpr const char* task_help = "add tasks such as tasks: {servo: {every: 2 ms}}";

/// Both are read into a Program: tasks of a program change those of its controller.
const Form& program_form();
const Form& controller_form();

/// What all blocks have in common.
const Form& block_form();
const Form& use_form();  ///< of a UsePlan

/// `slow: true`, of whatever `lineshaft test` runs.
Key slow_key();

}  // namespace lineshaft
