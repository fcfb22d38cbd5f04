#pragma once

#include <memory>
#include <string>

#include "runtime/machine/machine.hpp"
#include "runtime/source/diagnostic.hpp"

namespace lineshaft {

/// Writes what the machine retains as JSON: names and values of signals, the bytes of blocks, and a
/// check of it all. Whole or not at all; what was there before, if its check fits, is then beside
/// it as PATH.bak. `now` is the end of the run [ns]: moments that blocks remember are kept as
/// distances from it. Empty when all is well, else what went wrong.
std::string write_retained(const std::string& path, const Machine& machine, std::int64_t now);

/// Puts what a file holds, or, with a warning, the copy before it where that is damaged, into a
/// machine that has not run; names that the file does not have keep their initial values. Returns
/// how many signals and blocks were set. L0507 for what is no such file or is damaged, a value that
/// the signal cannot have, a block of another kind, with other parameters or written by another
/// version or an earlier layout. A file that is not there is an empty one: nothing has been
/// retained yet.
int read_retained(const std::string& path, Machine& machine, Diagnostics& out);

/// The same of a text, as retained_line() has made it, that stands in `file`.
int take_retained(const std::string& text, const std::shared_ptr<const SourceFile>& file,
                  Machine& machine, Diagnostics& out);

/// What read_retained() would take, in one line; empty where there is nothing whole.
std::string retained_line(const std::string& path);

}  // namespace lineshaft
