#pragma once

#include <string>

#include "runtime/model/catalog.hpp"
#include "tests/fuzz/random_program.hpp"

namespace lineshaft::test {

/// Loads and runs `program` twice. What does not hold, empty if all does: it loads; every real
/// output is finite; the bounds; as many scans as the tasks' intervals make; pulses seen by the
/// sink are those that the channels counted; the second run's values are the first's, bit by bit.
std::string broken_invariant(const RandomProgram& program, const Catalog& catalog);

}  // namespace lineshaft::test
