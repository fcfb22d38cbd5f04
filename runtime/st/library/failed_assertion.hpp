#pragma once

#include "runtime/st/library/compiled.hpp"
#include "runtime/st/library/test_suite.hpp"

namespace lineshaft::st {

/// What the assertion says that a scan of `root` is at, or ended with, and that does not hold. Of
/// one in a library the place is where the user calls what it stands in.
TestResult failed_assertion(const Compiled& made, const std::byte* root, const Context& context,
                            const EndOfScan& end);

/// The same of a scan that ended with one in a run without tests, with the name of TcUnit's test.
std::string text_of_failure(const Compiled& made, const std::byte* root, const Context& context);

}  // namespace lineshaft::st
