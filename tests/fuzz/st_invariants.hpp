#pragma once

#include <string>

#include "runtime/model/catalog.hpp"

namespace lineshaft::test {

/// Compiles Structured Text that must be right, and scans its programs `scans` times with inputs
/// drawn from `seed`; then again without native code, and from a random scan on on a copy of the
/// memory, as a checkpoint goes on. What does not hold, empty if all does: it compiles, a scan that
/// ends without a fault says so, and both leave the same bytes.
std::string broken_invariant(const std::string& source, int scans, std::uint64_t seed,
                             const Catalog& catalog);

}  // namespace lineshaft::test
