#pragma once

#include <string>

#include "runtime/net/machine.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// Writes the machine's retained values as JSON, names and values: whole or not at all. Empty when
/// all is well, else what went wrong.
std::string write_retained(const std::string& path, const Machine& machine);

/// Puts the values of a file into a machine that has not run; names that the file does not have
/// keep their initial values. Returns how many were set. L0507 for what is no such file, or has a
/// value of another type. A file that is not there is an empty one: nothing has been retained yet.
int read_retained(const std::string& path, Machine& machine, Diagnostics& out);

}  // namespace lineshaft
