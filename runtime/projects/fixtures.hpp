#pragma once

#include <memory>
#include <vector>

#include "runtime/source/diagnostic.hpp"

/// Tests as SIMATIC AX has them, and as TEST_PROGRAM.
namespace lineshaft::projects {

/// `{Test}`, `{Test(x := 1)}`, `{TestFixture}`, TEST_PROGRAM or TEST_FUNCTION_BLOCK stands in it.
bool has_fixtures(const SourceFile& file);

/// A file of TESTs for each class with `{TestFixture}`, and one for the functions with `{Test}`:
/// they call these methods and functions, with what the pragma gives. `{FixtureSetup}`,
/// `{TestSetup}`, `{TestTearDown}` and `{FixtureTearDown}` are SETUP and TEARDOWN, so each runs
/// once a test: on fresh memory, as all tests do. Places are those of the methods.
/// A file with TEST_PROGRAM is one of TESTs with other words.
std::vector<std::shared_ptr<const SourceFile>> tests_of_fixtures(
    const std::shared_ptr<const SourceFile>& file);

}  // namespace lineshaft::projects
